#pragma once
/// @file Walks whose methods have an error planted in their weights, to show that tests notice it.

#include <array>
#include <ostream>
#include <string_view>
#include <vector>

#include "freepath/transport/kernels.h"

namespace freepath::testing {

/// Factors on mu_a, mu_s and mu_n in the weight alone: probabilities stay as they are. 1 plants
/// nothing.
struct PlantedFactors {
  float absorption = 1;  ///< On the tally of emission, and on the weight of an absorption.
  float scattering = 1;
  float null = 1;
  /// On the number that chooses the component of a scattering; below 1.
  float component = 1;
  float roulette = 1;  ///< On what survives the roulette of an estimator.
};

/// A null-collision method of the registry that takes PlantedFactors.
struct Mutant {
  std::string_view name;
  bool free_paths = true;
  int channels = 1;  ///< That it is compiled for.
  WalkFunction walk = nullptr;
  bool plays_roulette = false;
  Simd simd = Simd::kBest;  ///< That it is compiled for; kBest: the machine's own.

  /// What `walk` takes for options: the standard ones, and the factors.
  using Options = std::array<float, kMaxMethodOptions + 5>;
  Options options(const PlantedFactors& planted) const;
};

/// How GoogleTest names one, by the name that it looks for.
// NOLINTNEXTLINE(readability-identifier-naming)
inline void PrintTo(const Mutant& mutant, std::ostream* out) { *out << mutant.name; }

/// One of every null-collision method of the registry.
std::vector<Mutant> mutants();

/// One of `delta` for each SIMD target that this machine runs.
std::vector<Mutant> target_mutants();

}  // namespace freepath::testing
