// The pairwise set of the certifying suite, and what shows that it would notice an error.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/certify/pinned.h"
#include "tests/certify/report.h"

namespace freepath::testing {
namespace {

/// No |z| of an unbiased method comes near it.
constexpr double kCertainly = 7;

/// The pairs of values of a case that the set promises.
std::vector<std::string> pairs_of(const CertifiedCase& test) {
  const CertifiedMedium& medium = certified_media()[test.medium];
  const std::vector<std::string> values = {
      test.method,
      std::to_string(static_cast<int>(test.interpolation)),
      test.tight ? "tight" : "loose",
      test.one_lane ? "one lane" : "lanes",
      test.absorption == Absorption::kAnalog ? "analog a" : "weighted a",
      test.emission == EmissionTally::kAnalog ? "analog e" : "collision e",
      test.history ? "history" : "fresh"};
  std::vector<std::string> pairs = {test.method_name() + " in " + medium.name,
                                    test.method + " in " + kind_of(medium)};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) pairs.push_back(values[i] + " in " + medium.name);
    for (std::size_t j = i + 1; j < values.size(); ++j) {
      pairs.push_back(fmt::format("{} {} {} {}", i, values[i], j, values[j]));
    }
  }
  return pairs;
}

// The set is what it says: any two values that can meet do.
TEST(CertifyCases, CoverEveryPossiblePair) {
  const auto pairs = [](const std::vector<CertifiedCase>& cases) {
    std::set<std::string> seen;
    for (const CertifiedCase& test : cases) {
      for (std::string& pair : pairs_of(test)) seen.insert(std::move(pair));
    }
    return seen;
  };
  for (const bool free_paths : {true, false}) {
    EXPECT_EQ(pairs(pairwise_cases(free_paths)).size(), pairs(all_cases(free_paths)).size());
  }
}

// A case that is refused is none that passes: what is refused is a list, and stays it.
TEST(CertifyCases, AreRefusedAsTheListOfRefusalsSays) {
  std::vector<std::size_t> times(refusals().size(), 0);
  for (const bool free_paths : {true, false}) {
    for (const std::string& method : certified_variants(free_paths)) {
      for (std::size_t medium = 0; medium < certified_media().size(); ++medium) {
        for (const int interpolation : {0, 1, 2}) {
          for (const bool tight : {true, false}) {
            CertifiedCase test;
            test.method = method;
            test.free_paths = free_paths;
            test.medium = medium;
            test.interpolation = static_cast<Interpolation>(interpolation);
            test.tight = tight;
            const auto wrong = unexpected(test);
            EXPECT_FALSE(wrong) << *wrong;
            for (std::size_t i = 0; i < times.size(); ++i) times[i] += refusals()[i].applies(test);
          }
        }
      }
    }
  }
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_GT(times[i], 0U) << refusals()[i].what;
}

TEST(CertifyCases, PinAFloorForEveryMethod) {
  for (const bool free_paths : {true, false}) {
    for (const MethodInfo& info : free_paths ? tracker_infos() : transmittance_infos()) {
      const bool pinned = std::any_of(floors().begin(), floors().end(), [&](const Floor& floor) {
        return floor.method == info.name && floor.free_paths == free_paths;
      });
      EXPECT_EQ(pinned, !info.biased) << info.name;
    }
  }
}

// Where two seeds were the same, cases would share their luck.
TEST(CertifyCases, HaveSeedsOfTheirOwn) {
  std::set<uint64_t> seeds;
  std::size_t count = 0;
  for (const bool free_paths : {true, false}) {
    for (const CertifiedCase& test : pairwise_cases(free_paths)) {
      seeds.insert(test.settings().seed);
      ++count;
    }
  }
  EXPECT_EQ(seeds.size(), count);
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

/// Cases of `delta` in the first medium that are off by so many standard errors.
std::vector<CaseResult> results_off_by(const std::vector<double>& deviations) {
  std::vector<CaseResult> results;
  for (const double deviation : deviations) {
    CaseResult& result = results.emplace_back();
    result.test.method = "delta";
    result.checks = {{.quantity = "radiance",
                      .estimate = 1,
                      .standard_error = 0.0005,
                      .exact = 1,
                      .z = std::abs(deviation),
                      .principal = true}};
    result.signed_z = deviation;
  }
  return results;
}

// Half a standard error is none of a case's business, but all cases to one side are.
TEST(CertifyVerdict, PoolsSignsSoThatASmallCommonBiasShows) {
  std::vector<double> deviations(400, 0.5);
  const std::vector<CaseResult> biased = results_off_by(deviations);
  const Verdict verdict = judge(biased);
  EXPECT_TRUE(verdict.failed.empty());
  EXPECT_NEAR(verdict.together.pooled_z, 10, 1e-9);
  EXPECT_FALSE(verdict.passes(verdict.together));
  EXPECT_FALSE(verdict.passes(verdict.methods.at(0)));
  for (std::size_t i = 0; i < deviations.size(); i += 2) deviations[i] = -0.5;
  const std::vector<CaseResult> both_sides = results_off_by(deviations);
  const Verdict fair = judge(both_sides);
  EXPECT_NEAR(fair.together.pooled_z, 0, 1e-9);
  EXPECT_TRUE(fair.passes(fair.together));
}

TEST(CertifyVerdict, NamesWhatFallsShortOfThePins) {
  std::vector<CaseResult> results = results_off_by(std::vector<double>(100, 0));
  const auto complains = [&](const std::string& part) {
    const std::vector<std::string> lines = shortfalls(judge(results));
    return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
      return line.find(part) != std::string::npos;
    });
  };
  EXPECT_TRUE(complains("no case certifies 'spectral'"));
  EXPECT_FALSE(complains("tracker `delta`"));
  EXPECT_FALSE(complains("median"));
  for (CaseResult& result : results) result.checks[0].standard_error = 0.0011;
  EXPECT_TRUE(complains("median"));
  for (std::size_t i = 0; i < 50; ++i) results[i].checks[0].standing = Standing::kRare;
  EXPECT_TRUE(complains("`delta`: 50 comparisons count"));
  results.resize(10);
  EXPECT_TRUE(complains("`delta`: 0 comparisons count"));
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
