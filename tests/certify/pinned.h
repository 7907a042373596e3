#pragma once
/// @file What the certifying suite is known to leave out, so that it can't shrink unseen.

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "tests/certify/cases.h"

namespace freepath::testing {

/// A kind of cases that methods refuse, and have to.
struct Refusal {
  const char* what;    ///< For messages.
  const char* reason;  ///< Part of the walker's words.
  bool (*applies)(const CertifiedCase& test) = nullptr;
};

/// All there are, the first that applies being the one that a walker names.
std::span<const Refusal> refusals();

/// What is wrong with how a case is refused or not; nothing where it is as the list has it.
std::optional<std::string> unexpected(const CertifiedCase& test);

/// The least that the pairwise set has of a method.
struct Floor {
  const char* method;  ///< Without its options.
  bool free_paths;
  std::size_t count;  ///< Of radiances or transmittances that count.
  double share;       ///< Of those among all of the method.
};

/// Those of all unbiased methods in the pairwise set.
std::span<const Floor> floors();

/// The largest median relative standard error that the pairwise set may have.
inline constexpr double kLargestMedianError = 0.001;

}  // namespace freepath::testing
