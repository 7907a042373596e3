// One instruction set is enough here, and the build asks for the machine's own.
#define HWY_COMPILE_ONLY_STATIC
#include "tests/certify/mutants.h"

#include <hwy/highway.h>

#include <algorithm>

#include "freepath/transport/walker.h"
#include "tests/certify/planted-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {
namespace {

template <class Method>
constexpr bool kPlaysRoulette = requires(const Method& method) {
  method.roulette;
};

template <int N, class Method>
freepath::testing::Mutant mutant_of(bool free_paths) {
  return {.name = Method::kInfo.name,
          .free_paths = free_paths,
          .channels = N,
          .walk = &planted_walk_stream<N, Method>,
          .plays_roulette = kPlaysRoulette<Method>};
}

template <int N, class... Methods>
void add_mutants(bool free_paths, MethodList<Methods...> /*list*/,
                 std::vector<freepath::testing::Mutant>& mutants) {
  (mutants.push_back(mutant_of<N, Methods>(free_paths)), ...);
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
  options[kMaxMethodOptions + 3] = planted.component;
  options[kMaxMethodOptions + 4] = planted.roulette;
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
