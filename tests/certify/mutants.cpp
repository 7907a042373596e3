// One instruction set is enough here, and the build asks for the machine's own.
#define HWY_COMPILE_ONLY_STATIC
#include "tests/certify/mutants.h"

#include <hwy/highway.h>

#include <algorithm>

#include "freepath/transport/walk_stream-inl.h"
#include "freepath/transport/walker.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {
namespace {

/// A method with factors on its weights. Everything else of it is inherited.
template <class Method>
struct Planted : Method {
  explicit Planted(std::span<const float> options)
      : Method(options),
        absorption(options[kMaxMethodOptions]),
        scattering(options[kMaxMethodOptions + 1]),
        null(options[kMaxMethodOptions + 2]) {}

  template <int N, class Coefficients>
  HWY_INLINE void collide(const WalkModes& modes, const Coefficients& sigma,
                          Collision<N>& c) const {
    const Collision<N> before = c;
    Method::template collide<N>(modes, sigma, c);
    plant(before, c.lanes, c);
  }

  template <int N, class Coefficients>
  HWY_INLINE MaskF decide(const WalkModes& modes, const Coefficients& control,
                          Collision<N>& c) const {
    const Collision<N> before = c;
    const MaskF decided = Method::template decide<N>(modes, control, c);
    plant(before, decided, c);
    return decided;
  }

  template <int N>
  HWY_INLINE void plant(const Collision<N>& before, MaskF lanes, Collision<N>& c) const {
    const VecF factor = hn::IfThenElse(c.scatter, set(scattering),
                                       hn::IfThenElse(c.absorb, set(absorption), set(null)));
    for (int channel = 0; channel < N; ++channel) {
      assign(c.weight[channel], lanes, hn::Mul(c.weight[channel], factor));
      const VecF added = hn::Sub(c.emitted[channel], before.emitted[channel]);
      c.emitted[channel] = mul_add(added, set(absorption), before.emitted[channel]);
    }
  }

  float absorption;
  float scattering;
  float null;
};

template <int N, class... Methods>
void add_mutants(bool free_paths, MethodList<Methods...> /*list*/,
                 std::vector<freepath::testing::Mutant>& mutants) {
  (mutants.push_back({Methods::kInfo.name, free_paths, N, &walk_stream<N, Planted<Methods>>}), ...);
}

}  // namespace
}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace freepath::testing {

Mutant::Options Mutant::options(const PlantedFactors& planted) const {
  Options options{};
  const Method method = parse_method(name, free_paths ? tracker_infos() : transmittance_infos());
  std::copy(method.options.begin(), method.options.end(), options.begin());
  options[kMaxMethodOptions] = planted.absorption;
  options[kMaxMethodOptions + 1] = planted.scattering;
  options[kMaxMethodOptions + 2] = planted.null;
  return options;
}

std::vector<Mutant> mutants() {
  using namespace HWY_NAMESPACE;
  std::vector<Mutant> mutants;
  add_mutants<1>(true, DeltaTrackers{}, mutants);
  add_mutants<1>(true, DecompositionTrackers{}, mutants);
  add_mutants<kChannels>(true, SpectralTrackers{}, mutants);
  add_mutants<kChannels>(false, TransmittanceEstimators{}, mutants);
  return mutants;
}

}  // namespace freepath::testing
