// The one place where trackers and media meet: instantiates every method for every SIMD target.

#include "freepath/transport/kernels.h"

// Machines with SSSE3 but no SSE4 are older than this kind of work. A build with sanitizers, which
// takes minutes for each target, names fewer (CMakeLists.txt).
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS HWY_SSSE3
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "freepath/transport/kernels.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first: it includes this file once for each target.
#include <hwy/highway.h>

#include "freepath/media/field_sum-inl.h"
#include "freepath/media/segments-inl.h"
#include "freepath/tracking/walk-inl.h"
#include "freepath/transport/entry-inl.h"
#include "freepath/transport/registry-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

template <int N, class Method>
void walk_stream(const MediumView& medium, std::span<const float> options, const WalkModes& modes,
                 uint64_t seed, const RayStream& rays, FlightStream& flights,
                 WalkStatistics& statistics) {
  MediumEntry entry(medium, rays);
  const Method method(options);
  const SuperVoxelSegments segments(medium);
  const FieldSum<N> fields(medium);
  Walk<N, Method, SuperVoxelSegments, FieldSum<N>, MediumEntry>(
      method, segments, fields, modes, seed, rays, entry, flights, statistics)
      .run();
}

template <class... Methods>
std::vector<Kernel> make_kernels(MethodList<Methods...> /*list*/) {
  return {Kernel{Methods::kInfo, &walk_stream<1, Methods>, &walk_stream<kChannels, Methods>}...};
}

KernelTable make_table() {
  return {make_kernels(TrackerList{}), make_kernels(TransmittanceList{})};
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>
#include <array>

#include "freepath/base/error.h"

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

const KernelTable& kernels(Simd simd) {
  static const std::array<KernelTable, std::size(kTargets)> kTables = [] {
    std::array<KernelTable, std::size(kTargets)> tables;
    for (std::size_t i = 0; i < tables.size(); ++i) tables[i] = kTargets[i].make();
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
