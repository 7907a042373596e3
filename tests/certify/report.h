#pragma once
/// @file The certifying suite's report.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/certify/measure.h"

namespace freepath::testing {

/// What the cases of a method come to together.
struct MethodVerdict {
  std::string method;  ///< Without its options.
  bool free_paths = true;
  std::size_t cases = 0;
  std::size_t principal = 0;         ///< Radiances of trackers, transmittances of estimators.
  std::size_t principal_tested = 0;  ///< Those of them that count.
  std::size_t pooled = 0;            ///< Cases whose sign counts.
  double pooled_z = 0;      ///< Σz/√n over those: shows a bias too small for each of them.
  double median_error = 0;  ///< Relative standard error of those that count.

  double counted() const {
    return static_cast<double>(principal_tested) /
           static_cast<double>(std::max<std::size_t>(1, principal));
  }
};

/// What a family of cases comes to.
struct Verdict {
  std::size_t tested = 0;  ///< Comparisons that count.
  std::size_t rare = 0;
  std::size_t heavy = 0;
  std::size_t principal = 0;         ///< Radiances of trackers, transmittances of estimators.
  std::size_t principal_tested = 0;  ///< Those of them that count.
  double threshold = 0;              ///< Largest |z| that passes, for the family-wise level.
  std::vector<const CaseResult*> failed;
  std::vector<MethodVerdict> methods;
  MethodVerdict together;  ///< All methods.

  /// Whether a pooled deviation is within the family-wise level.
  bool passes(const MethodVerdict& method) const;
};

/// Family-wise level of the suite.
inline constexpr double kCertifyLevel = 1e-3;

Verdict judge(const std::vector<CaseResult>& results);

/// What falls short of what is pinned (pinned.h), one line each: a method of whose comparisons too
/// few count, a method that no case has, a median error that is too large. Of the whole pairwise
/// set.
std::vector<std::string> shortfalls(const Verdict& verdict);

/// Writes a table of all cases in Markdown, the smallest margins first within each method.
/// @param title what the set of cases is
void write_report(const std::filesystem::path& path, const std::string& title,
                  const std::vector<CaseResult>& results, const Verdict& verdict);

}  // namespace freepath::testing
