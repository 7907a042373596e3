#pragma once
/// @file One case of the certifying suite: walk it, and compare with quadrature.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/certify/cases.h"

namespace freepath::testing {

/// How many paths a case may take.
struct CertifyBudget {
  double relative_error = 0.00096;  ///< Of the radiance or transmittance, if within reach.
  uint64_t most_paths = 7U << 18;   ///< Of cheap ones; costly ones are fewer.
};

/// Whether a comparison counts.
enum class Standing {
  kTested,
  kRare,   ///< Fewer than a thousand weighted contributions: no mean of theirs is normal.
  kHeavy,  ///< The spread of the weights is such that no mean is normal after that many paths.
};

/// An estimate against what is exact.
struct Check {
  std::string quantity;
  double estimate = 0;
  double standard_error = 0;
  double exact = 0;
  double z = 0;  ///< Of a distribution: that of a normal deviate as unlikely as it.
  Standing standing = Standing::kTested;
  bool principal = false;  ///< Radiance of a tracker, transmittance of an estimator.

  double relative_error() const { return standard_error / exact; }
};

struct CaseResult {
  CertifiedCase test;
  std::vector<Check> checks;
  uint64_t paths = 0;   ///< Of each channel that takes its own.
  double lookups = 0;   ///< A path.
  double variance = 0;  ///< Of the radiance or transmittance of one path, mean over channels.
  /// Of the sum of all channels' radiances or transmittances, with its sign, to be pooled with
  /// those of other cases; nothing where it doesn't count.
  std::optional<double> signed_z;
  WalkStatistics statistics;
};

/// Walks a case and compares, in each channel: collected radiance, escaping weight (transmittance)
/// and the distribution of the weight that scatters along the ray.
CaseResult measure(const CertifiedCase& test, const CertifyBudget& budget);

/// Largest |z| among the checks that count.
inline double largest_z(const CaseResult& result) {
  double largest = 0;
  for (const Check& check : result.checks) {
    if (check.standing == Standing::kTested) largest = std::max(largest, check.z);
  }
  return largest;
}

}  // namespace freepath::testing
