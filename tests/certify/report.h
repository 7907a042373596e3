#pragma once
/// @file The certifying suite's report.

#include <filesystem>
#include <vector>

#include "tests/certify/measure.h"

namespace freepath::testing {

/// What a family of cases comes to.
struct Verdict {
  std::size_t tested = 0;  ///< Comparisons that count.
  std::size_t rare = 0;
  std::size_t heavy = 0;
  std::size_t principal = 0;         ///< Radiances of trackers, transmittances of estimators.
  std::size_t principal_tested = 0;  ///< Those of them that count.
  double threshold = 0;              ///< Largest |z| that passes, for the family-wise level.
  std::vector<const CaseResult*> failed;
};

/// Family-wise level of the suite.
inline constexpr double kCertifyLevel = 1e-3;

/// @param level share of the family-wise level that these cases may spend
Verdict judge(const std::vector<CaseResult>& results, double level = kCertifyLevel);

/// Writes a table of all cases in Markdown, the smallest margins first within each method.
/// @param title what the set of cases is
void write_report(const std::filesystem::path& path, const std::string& title,
                  const std::vector<CaseResult>& results, const Verdict& verdict);

}  // namespace freepath::testing
