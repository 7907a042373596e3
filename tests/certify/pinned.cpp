#include "tests/certify/pinned.h"

#include <fmt/format.h>

#include <algorithm>

namespace freepath::testing {
namespace {

bool is(const CertifiedCase& test, const char* method) { return test.method_name() == method; }

/// Whether every density is the same everywhere.
bool is_homogeneous(const CertifiedCase& test) {
  const std::string& name = certified_media()[test.medium].name;
  return name.rfind("homogeneous", 0) == 0 || name.rfind("thickness", 0) == 0;
}

/// Whether components have other voxels than each other: then there is no one place to look up.
bool is_one_grid(const CertifiedCase& test) {
  return certified_media()[test.medium].name != "two transforms";
}

constexpr Refusal kRefusals[] = {
    {"regular by stochastic interpolation", "'regular' puts the density inside an exponential",
     [](const CertifiedCase& test) {
       return is(test, "regular") && test.interpolation == Interpolation::kStochastic;
     }},
    {"closed-form by a filter, whose border falls to 0", "'closed-form' needs interpolation",
     [](const CertifiedCase& test) {
       return is(test, "closed-form") && test.interpolation != Interpolation::kNearest &&
              is_homogeneous(test) && test.tight;
     }},
    {"closed-form where grids differ in transform", "differ in transform or bounds",
     [](const CertifiedCase& test) { return is(test, "closed-form") && !is_one_grid(test); }},
    {"closed-form where densities vary", "'closed-form' needs a homogeneous medium: the density",
     [](const CertifiedCase& test) { return is(test, "closed-form") && !is_homogeneous(test); }},
    {"closed-form under loose bounds", "takes the density from its bounds",
     [](const CertifiedCase& test) { return is(test, "closed-form") && !test.tight; }},
};

}  // namespace

std::span<const Refusal> refusals() { return kRefusals; }

std::optional<std::string> unexpected(const CertifiedCase& test) {
  const auto expected = std::find_if(std::begin(kRefusals), std::end(kRefusals),
                                     [&](const Refusal& refusal) { return refusal.applies(test); });
  const std::optional<std::string> reason = reason_against(test);
  if (expected == std::end(kRefusals)) {
    if (!reason) return {};
    return fmt::format("{} is refused, and not in the list of refusals: {}", test.name(), *reason);
  }
  if (!reason) {
    return fmt::format("{} is walked, though the list has it refused: {}", test.name(),
                       expected->what);
  }
  if (reason->find(expected->reason) != std::string::npos) return {};
  return fmt::format("{} is refused for another reason than '{}': {}", test.name(),
                     expected->reason, *reason);
}

std::span<const Floor> floors() {
  static constexpr Floor kFloors[] = {
      {"closed-form", true, 23, 0.92},
      {"decomposition", true, 72, 0.97},
      {"delta", true, 69, 0.93},
      {"hero-wavelength", true, 72, 0.97},
      {"multi-volume", true, 71, 0.95},
      {"per-wavelength", true, 71, 0.95},
      {"regular", true, 69, 0.93},
      {"spectral", true, 98, 0.98},
      {"spectral-decomposition", true, 116, 0.96},
      {"weighted-decomposition", true, 88, 0.94},
      {"weighted-delta", true, 79, 0.94},
      {"closed-form", false, 13, 0.86},
      {"delta", false, 61, 0.95},
      {"next-flight", false, 66, 0.90},
      {"p-series", false, 75, 0.94},
      {"ratio", false, 65, 0.94},
      {"regular", false, 62, 0.96},
      {"residual-ratio", false, 65, 0.94},
      {"unbiased-ray-marching", false, 63, 0.87},
  };
  return kFloors;
}

}  // namespace freepath::testing
