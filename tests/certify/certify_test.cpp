// The pairwise set of the certifying suite, and what shows that it would notice an error.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "freepath/base/random.h"
#include "tests/certify/report.h"

namespace freepath::testing {
namespace {

/// The set is cut into parts, so that ctest can run them side by side.
constexpr std::size_t kParts = 6;
/// No |z| of an unbiased method comes near it.
constexpr double kCertainly = 7;

std::vector<CertifiedCase> both_pairwise_sets() {
  std::vector<CertifiedCase> cases = pairwise_cases(true);
  const std::vector<CertifiedCase> estimators = pairwise_cases(false);
  cases.insert(cases.end(), estimators.begin(), estimators.end());
  return cases;
}

std::vector<CaseResult> measure_all(const std::vector<CertifiedCase>& cases, std::size_t part,
                                    std::size_t parts) {
  // Dealt by a hash: neighbours in the list are alike.
  std::vector<CaseResult> results;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const uint32_t hash = philox({static_cast<uint32_t>(i), 0, 0, 0}, {0, 0})[0];
    if (hash % parts == part) results.push_back(measure(cases[i], {}));
  }
  return results;
}

std::string describe(const CaseResult& result) {
  std::string text = result.test.name();
  for (const Check& check : result.checks) {
    text += fmt::format("\n  {}: {:.6g} +- {:.2g}, exact {:.6g}, z = {:.2f}", check.quantity,
                        check.estimate, check.standard_error, check.exact, check.z);
  }
  return text;
}

class Certify : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Certify, PairwiseSetAgreesWithQuadrature) {
  const std::vector<CaseResult> results = measure_all(both_pairwise_sets(), GetParam(), kParts);
  const Verdict verdict = judge(results, kCertifyLevel / kParts);
  for (const CaseResult* failed : verdict.failed) ADD_FAILURE() << describe(*failed);
  EXPECT_GT(verdict.principal_tested, verdict.principal * 4 / 5)
      << "too few comparisons are sharp enough to count";
}

INSTANTIATE_TEST_SUITE_P(Part, Certify, ::testing::Range(std::size_t{0}, kParts));

// The set is what it says: any two values that can meet do.
TEST(CertifyCases, CoverEveryPossiblePair) {
  const auto pairs = [](const std::vector<CertifiedCase>& cases) {
    std::map<std::string, int> seen;
    for (const CertifiedCase& test : cases) {
      const std::vector<std::string> values = {
          test.method,
          certified_media()[test.medium].name,
          std::to_string(static_cast<int>(test.interpolation)),
          test.tight ? "tight" : "loose",
          test.one_lane ? "one lane" : "lanes",
          test.absorption == Absorption::kAnalog ? "analog a" : "weighted a",
          test.emission == EmissionTally::kAnalog ? "analog e" : "collision e"};
      for (std::size_t i = 0; i < values.size(); ++i) {
        for (std::size_t j = i + 1; j < values.size(); ++j) {
          ++seen[fmt::format("{} {} {} {}", i, values[i], j, values[j])];
        }
      }
    }
    return seen;
  };
  for (const bool free_paths : {true, false}) {
    EXPECT_EQ(pairs(pairwise_cases(free_paths)).size(), pairs(all_cases(free_paths)).size());
  }
}

TEST(CertifyCases, NameEveryUnbiasedMethodOfTheRegistry) {
  for (const bool free_paths : {true, false}) {
    const std::vector<std::string> variants = certified_variants(free_paths);
    for (const MethodInfo& info : free_paths ? tracker_infos() : transmittance_infos()) {
      const bool named = std::find(variants.begin(), variants.end(), info.name) != variants.end();
      EXPECT_EQ(named, !info.biased) << info.name;
    }
  }
}

/// A tracker in a medium, as cases have it.
CaseResult measure_biased(const std::string& method, std::size_t medium) {
  CertifiedCase test;
  test.method = method;
  test.medium = medium;
  test.interpolation = Interpolation::kTrilinear;
  return measure(test, {});
}

std::size_t medium_named(const std::string& name) {
  const std::vector<CertifiedMedium>& media = certified_media();
  return std::find_if(media.begin(), media.end(),
                      [&](const CertifiedMedium& medium) { return medium.name == name; }) -
         media.begin();
}

// What is known to be biased is caught.
TEST(CertifyPower, RayMarchingFails) {
  const std::size_t sparse = medium_named("sparse, chromatic");
  EXPECT_GT(largest_z(measure_biased("ray-marching:step=0.5", sparse)), kCertainly);
  EXPECT_LT(largest_z(measure_biased("regular", sparse)), kCertainly);
}
}  // namespace
}  // namespace freepath::testing
