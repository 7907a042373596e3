// A mutant for every SIMD target.

#include "tests/certify/mutants.h"

#include "freepath/transport/simd_targets.h"
// simd_targets.h comes first: it says which targets there are.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/certify/target_mutants.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes next: it includes this file once for each target.
#include <hwy/highway.h>

#include "tests/certify/planted-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

WalkFunction planted_delta() { return &planted_walk_stream<1, Delta>; }

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>

namespace freepath::testing {

std::vector<Mutant> target_mutants() {
  const std::vector<Simd> here = available_simd();
  std::vector<Mutant> mutants;
  const auto add = [&](Simd simd, WalkFunction (*walk)()) {
    if (std::find(here.begin(), here.end(), simd) == here.end()) return;
    Mutant mutant{.name = "delta", .walk = walk(), .simd = simd};
    mutants.push_back(mutant);
  };
#if HWY_TARGETS & HWY_AVX3
  add(Simd::kAvx512, &N_AVX3::planted_delta);
#endif
#if HWY_TARGETS & HWY_AVX2
  add(Simd::kAvx2, &N_AVX2::planted_delta);
#endif
#if HWY_TARGETS & HWY_SSE4
  add(Simd::kSse4, &N_SSE4::planted_delta);
#endif
  add(Simd::kOneLane, &HWY_STATIC_DISPATCH(planted_delta));
  return mutants;
}

}  // namespace freepath::testing
#endif  // HWY_ONCE
