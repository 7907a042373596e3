#pragma once
/// @file The cases of the certifying suite: every method of the registry, in the spellings that
/// change its law, on every medium and in every mode; and a set of them in which the values of any
/// two properties meet.

#include <optional>
#include <string>
#include <vector>

#include "freepath/transport/walker.h"
#include "tests/certify/media.h"

namespace freepath::testing {

struct CertifiedCase {
  std::string method;      ///< With its options.
  bool free_paths = true;  ///< A tracker, else a transmittance estimator.
  std::size_t medium = 0;  ///< Place in certified_media().
  Interpolation interpolation = Interpolation::kNearest;
  bool tight = true;  ///< Bounds as super-voxels give them, else loose ones.
  Absorption absorption = Absorption::kWeighted;
  EmissionTally emission = EmissionTally::kCollision;
  bool one_lane = false;  ///< The scalar walk, else the widest lanes of the machine.
  /// Whether rays bring weights and densities of a path along (history_weight, history_density).
  bool history = false;

  const Medium& walked_medium() const { return certified_media()[medium].with_bounds(tight); }
  /// With a seed of the case's own: no two cases share random numbers.
  WalkSettings settings() const;
  /// The method without its options.
  std::string method_name() const { return method.substr(0, method.find(':')); }
  /// As the report writes it: everything that tells cases of one medium apart.
  std::string modes() const;
  std::string name() const;
};

/// Weight of a path that has flown before, in one of its channels: a power of two, of either sign,
/// so that dividing by it leaves no rounding.
float history_weight(int channel);
/// Relative density of that path if the channel had been its hero, a positive number.
float history_density(int channel);

/// What of a medium matters to the options of methods: "grey", "coloured", "overlapping" or
/// "wavelengths", where paths don't carry three channels.
const char* kind_of(const CertifiedMedium& medium);

/// Unbiased methods in the spellings to certify: the standard one, each other choice of an option
/// and the values of numbers that matter, one at a time and all at once.
/// @throws std::logic_error for an option that this suite has not heard of
std::vector<std::string> certified_variants(bool free_paths);

/// Why a method can't walk a medium, in the walker's own words; nothing if it can.
std::optional<std::string> reason_against(const CertifiedCase& test);

/// Every case that is possible.
std::vector<CertifiedCase> all_cases(bool free_paths);

/// Possible cases such that any two values of any two of their properties meet in one of them, if
/// they can meet at all; but a spelling of a method meets kinds of media, and the method itself
/// each medium.
std::vector<CertifiedCase> pairwise_cases(bool free_paths);

}  // namespace freepath::testing
