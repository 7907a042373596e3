// The table of all compiled methods, by SIMD target.

#include "freepath/transport/kernels.h"

#include "freepath/transport/simd_targets.h"
// simd_targets.h comes first: it says which targets there are.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "freepath/transport/kernels.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes next: it includes this file once for each target.
#include <hwy/highway.h>

#include "freepath/base/lat_long-inl.h"
#include "freepath/transport/scattering-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

// Each compiled in a file of its own.
std::vector<Kernel> make_delta_kernels();
std::vector<Kernel> make_decomposition_kernels();
std::vector<Kernel> make_spectral_kernels();
std::vector<Kernel> make_transmittance_kernels();

KernelTable make_table() {
  KernelTable table;
  for (const auto make : {make_delta_kernels, make_decomposition_kernels, make_spectral_kernels}) {
    const std::vector<Kernel> kernels = make();
    table.trackers.insert(table.trackers.end(), kernels.begin(), kernels.end());
  }
  table.transmittance = make_transmittance_kernels();
  table.scattering = make_scattering_kernels();
  table.locate = &locate_directions;
  return table;
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>
#include <array>

#include "freepath/base/error.h"
#include "freepath/transport/reference_kernels.h"

namespace freepath {
namespace {

struct Target {
  Simd simd;
  std::string_view name;
  int64_t bit;
  KernelTable (*make)();
};

constexpr Target kTargets[] = {
#if HWY_TARGETS & HWY_AVX3
    {Simd::kAvx512, "avx512", HWY_AVX3, &N_AVX3::make_table},
#endif
#if HWY_TARGETS & HWY_AVX2
    {Simd::kAvx2, "avx2", HWY_AVX2, &N_AVX2::make_table},
#endif
#if HWY_TARGETS & HWY_SSE4
    {Simd::kSse4, "sse4", HWY_SSE4, &N_SSE4::make_table},
#endif
    {Simd::kOneLane, "one-lane", HWY_STATIC_TARGET, &HWY_STATIC_DISPATCH(make_table)},
};

/// The walks of a target, and after them the methods that are the same for all targets.
KernelTable full_table(const Target& target) {
  KernelTable table = target.make();
  const KernelTable reference = make_reference_kernels();
  table.trackers.insert(table.trackers.end(), reference.trackers.begin(), reference.trackers.end());
  table.transmittance.insert(table.transmittance.end(), reference.transmittance.begin(),
                             reference.transmittance.end());
  return table;
}

bool runs_here(const Target& target) { return (hwy::SupportedTargets() & target.bit) != 0; }

}  // namespace

Simd parse_simd(std::string_view name) {
  if (name == "best") return Simd::kBest;
  std::string names = "best";
  for (const Target& target : kTargets) {
    if (target.name == name) return target.simd;
    names += fmt::format(", {}", target.name);
  }
  fail("there are no instructions '{}'; known are: {}", name, names);
}

std::vector<Simd> available_simd() {
  std::vector<Simd> available;
  for (const Target& target : kTargets) {
    if (runs_here(target)) available.push_back(target.simd);
  }
  return available;
}

std::string_view to_string(Simd simd) {
  const Simd wanted = simd == Simd::kBest ? available_simd().front() : simd;
  for (const Target& target : kTargets) {
    if (target.simd == wanted) return target.name;
  }
  return "unknown";
}

int compiled_channels(const WalkTable& walks, int channels) {
  int compiled = channels;
  while (walks[compiled] == nullptr) ++compiled;
  return compiled;
}

const KernelTable& kernels(Simd simd) {
  static const std::array<KernelTable, std::size(kTargets)> kTables = [] {
    std::array<KernelTable, std::size(kTargets)> tables;
    for (std::size_t i = 0; i < tables.size(); ++i) {
      // Making a table already takes the target's instructions.
      if (runs_here(kTargets[i])) tables[i] = full_table(kTargets[i]);
    }
    return tables;
  }();
  const Simd wanted = simd == Simd::kBest ? available_simd().front() : simd;
  for (std::size_t i = 0; i < std::size(kTargets); ++i) {
    if (kTargets[i].simd == wanted && runs_here(kTargets[i])) return kTables[i];
  }
  fail("this machine has no {} instructions", to_string(wanted));
}

}  // namespace freepath
#endif  // HWY_ONCE
