#include "tests/statistics.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace freepath::testing {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(RunningStatistics, GivesMeanAndUnbiasedVariance) {
  RunningStatistics statistics;
  for (const double value : {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}) statistics.add(value);
  EXPECT_EQ(statistics.count(), 8U);
  EXPECT_DOUBLE_EQ(statistics.mean(), 5);
  EXPECT_DOUBLE_EQ(statistics.variance(), 32.0 / 7);  // squared distances sum to 32
  EXPECT_DOUBLE_EQ(statistics.standard_error(), std::sqrt(32.0 / 7 / 8));
}

TEST(RunningStatistics, KeepsASmallSpreadAroundALargeMean) {
  RunningStatistics statistics;
  for (const double value : {1e9 + 4, 1e9 + 7, 1e9 + 13, 1e9 + 16}) statistics.add(value);
  EXPECT_DOUBLE_EQ(statistics.variance(), 30);  // (36 + 9 + 9 + 36) / 3
}

TEST(RunningStatistics, MergingEqualsAddingAllToOne) {
  RunningStatistics all, left, right, nothing;
  for (int i = 0; i < 100; ++i) {
    const double value = std::sin(i) * i;
    all.add(value);
    (i < 37 ? left : right).add(value);
  }
  left.merge(right);
  left.merge(nothing);
  nothing.merge(left);
  for (const RunningStatistics& merged : {left, nothing}) {
    EXPECT_EQ(merged.count(), all.count());
    EXPECT_NEAR(merged.mean(), all.mean(), 1e-12);
    EXPECT_NEAR(merged.variance(), all.variance(), 1e-9);
  }
}

TEST(RunningStatistics, HasNoSpreadBelowTwoValues) {
  RunningStatistics statistics;
  EXPECT_EQ(statistics.standard_error(), 0);
  statistics.add(3);
  EXPECT_EQ(statistics.variance(), 0);
  EXPECT_EQ(statistics.mean(), 3);
}

TEST(Normal, QuantilesAndTailsMatchTables) {
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);  // the usual 95 % interval
  EXPECT_NEAR(normal_quantile(0.5), 0, 1e-12);
  EXPECT_NEAR(normal_quantile(1e-9), -5.997807015007687, 1e-10);
  EXPECT_NEAR(two_sided_p(1), 0.317310507862914, 1e-14);
  EXPECT_NEAR(two_sided_p(-4) / 6.334248366623996e-05, 1, 1e-12);
  for (const double z : {-6.0, -2.5, -0.1, 0.7, 3.0}) {
    EXPECT_NEAR(normal_quantile(normal_cdf(z)), z, 1e-10) << z;
  }
  EXPECT_THROW(normal_quantile(0), std::invalid_argument);
  EXPECT_THROW(normal_quantile(kNan), std::invalid_argument);
}

TEST(FamilyWiseLevel, AllTestsTogetherHaveTheLevelAskedFor) {
  for (const std::size_t tests : {std::size_t{1}, std::size_t{64}, std::size_t{10'000}}) {
    const double each = family_wise_level(0.01, tests);
    EXPECT_NEAR(1 - std::pow(1 - each, static_cast<double>(tests)), 0.01, 1e-12);
    EXPECT_NEAR(two_sided_p(family_wise_threshold(0.01, tests)) / each, 1, 1e-9);
  }
  EXPECT_NEAR(family_wise_threshold(0.05, 1), 1.959963984540054, 1e-10);
}

TEST(UpperGamma, MatchesClosedForms) {
  // Q(1, x) = exp(-x), Q(1/2, x) = erfc(sqrt x), Q(3, x) = exp(-x) (1 + x + x^2/2): either side of
  // where the series gives way to the continued fraction.
  for (const double x : {1e-8, 0.3, 0.99, 1.0, 1.7, 2.1, 3.9, 4.1, 12.0, 80.0}) {
    EXPECT_NEAR(upper_gamma(1, x), std::exp(-x), 1e-14) << x;
    EXPECT_NEAR(upper_gamma(0.5, x), std::erfc(std::sqrt(x)), 1e-14) << x;
    EXPECT_NEAR(upper_gamma(3, x), std::exp(-x) * (1 + x + x * x / 2), 1e-14) << x;
  }
  EXPECT_NEAR(upper_gamma(1, 80) / std::exp(-80), 1, 1e-12);  // a tail keeps its relative precision
  EXPECT_EQ(upper_gamma(2, 0), 1);
  EXPECT_EQ(upper_gamma(2, std::numeric_limits<double>::infinity()), 0);
  EXPECT_THROW(upper_gamma(0, 1), std::invalid_argument);
  EXPECT_THROW(upper_gamma(1, kNan), std::invalid_argument);
}

TEST(UpperGamma, MatchesCriticalValuesOfChiSquare) {
  // The 5 % points of 1, 10 and 100 degrees of freedom, and the 0.1 % point of 30.
  EXPECT_NEAR(upper_gamma(0.5, 3.841458820694124 / 2), 0.05, 1e-12);
  EXPECT_NEAR(upper_gamma(5, 18.307038053275146 / 2), 0.05, 1e-12);
  EXPECT_NEAR(upper_gamma(50, 124.34211340400407 / 2), 0.05, 1e-11);
  EXPECT_NEAR(upper_gamma(15, 59.70306430442993 / 2), 0.001, 1e-11);
}

TEST(ChiSquareTest, MatchesAWorkedExample) {
  // 60 throws of a die: 5, 8, 9, 8, 10, 20 against 10 each: (25 + 4 + 1 + 4 + 0 + 100) / 10 = 13.4,
  // and p for 5 degrees of freedom in closed form (below).
  const std::array<uint64_t, 6> observed{5, 8, 9, 8, 10, 20};
  const std::array<double, 6> expected{10, 10, 10, 10, 10, 10};
  const ChiSquare test = chi_square_test(observed, expected);
  EXPECT_DOUBLE_EQ(test.statistic, 13.4);
  EXPECT_EQ(test.degrees_of_freedom, 5U);
  const double x = 13.4;
  const double closed_form =
      std::erfc(std::sqrt(x / 2)) + std::sqrt(2 * x / std::numbers::pi) * std::exp(-x / 2) *
                                        (1 + x / 3);  // odd degrees, by recurrence
  EXPECT_NEAR(test.p_value, closed_form, 1e-13);
  EXPECT_EQ(chi_square_test(observed, expected, 2).degrees_of_freedom, 3U);
}

TEST(ChiSquareTest, PoolsBinsThatExpectTooFew) {
  // 1 + 1.5 + 2 + 3 = 7.5 make one bin.
  const std::array<uint64_t, 5> observed{40, 2, 1, 4, 3};
  const std::array<double, 5> expected{42.5, 1, 2, 3, 1.5};
  const ChiSquare test = chi_square_test(observed, expected);
  EXPECT_EQ(test.degrees_of_freedom, 1U);
  EXPECT_DOUBLE_EQ(test.statistic, 2.5 * 2.5 / 7.5 + 2.5 * 2.5 / 42.5);
}

TEST(ChiSquareTest, LeavesNoPoolTooSmall) {
  // Seven bins of 1 make one pool of 5, and the two left over join it; nothing is left to compare.
  const std::vector<uint64_t> observed(7, 1);
  const std::vector<double> expected(7, 1.0);
  const ChiSquare test = chi_square_test(observed, expected);
  EXPECT_EQ(test.degrees_of_freedom, 0U);
  EXPECT_EQ(test.p_value, 1);
}

TEST(ChiSquareTest, AHitWhereNoneCanBeIsImpossible) {
  const std::array<uint64_t, 3> observed{50, 50, 1};
  const std::array<double, 3> expected{50, 51, 0};
  EXPECT_EQ(chi_square_test(observed, expected).p_value, 0);
  EXPECT_FALSE(check_chi_square("impossible", chi_square_test(observed, expected)));
  EXPECT_THROW(chi_square_test(std::span(observed).first(2), expected), std::invalid_argument);
}

TEST(ChiSquareTest, RaisesFalseAlarmsAtItsLevel) {
  // 2000 tests of a true hypothesis at 5 %: 100 rejections expected, 9.7 standard deviation.
  std::mt19937_64 random(7);
  int rejections = 0;
  for (int repetition = 0; repetition < 2000; ++repetition) {
    std::array<uint64_t, 16> counts{};
    for (int i = 0; i < 800; ++i) ++counts[random() & 15];
    const std::array<double, 16> expected{50, 50, 50, 50, 50, 50, 50, 50,
                                          50, 50, 50, 50, 50, 50, 50, 50};
    rejections += chi_square_test(counts, expected).p_value < 0.05;
  }
  EXPECT_NEAR(rejections, 100, 4 * 9.7);
}

TEST(Binomial, TailsMatchClosedForms) {
  EXPECT_NEAR(binomial_two_sided_p(0, 20, 0.1), 2 * std::pow(0.9, 20), 1e-14);
  EXPECT_NEAR(binomial_two_sided_p(10, 10, 0.5), 2 * std::pow(0.5, 10), 1e-14);
  // P(X ≥ 9) = (10 + 1) / 1024 for ten coins.
  EXPECT_NEAR(binomial_two_sided_p(9, 10, 0.5), 2 * 11.0 / 1024, 1e-14);
  EXPECT_EQ(binomial_two_sided_p(5, 10, 0.5), 1);
  EXPECT_EQ(binomial_two_sided_p(1, 10, 0), 0);
  EXPECT_EQ(binomial_two_sided_p(10, 10, 1), 1);
  EXPECT_THROW(binomial_two_sided_p(2, 1, 0.5), std::invalid_argument);
}

TEST(Binomial, ApproachesPoissonForRareEvents) {
  // Nine hits where one is expected in 10^8 trials: twice the Poisson tail beyond eight.
  double below = 0;
  double term = std::exp(-1.0);
  for (int k = 0; k <= 8; ++k) {
    below += term;
    term /= k + 1;
  }
  EXPECT_NEAR(binomial_two_sided_p(9, 100'000'000, 1e-8) / (2 * (1 - below)), 1, 1e-5);
}

TEST(CheckMean, AcceptsWithinItsThresholdAndSaysWhy) {
  EXPECT_TRUE(check_mean("close", 1.03, 0.01, 100, 1.0));
  const auto far = check_mean("reflectance", 1.05, 0.01, 12345, 1.0);
  EXPECT_FALSE(far);
  const std::string text = far.message();
  for (const char* part : {"reflectance", "1.05", "0.01", "expected 1", "z = 5", "n = 12345"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
  }
}

TEST(CheckMean, RefusesNanAndWrongExactValuesAndBluntTests) {
  EXPECT_FALSE(check_mean("nan", kNan, 0.01, 100, 1.0));
  EXPECT_FALSE(check_mean("nan error", 1.0, kNan, 100, 1.0));
  EXPECT_FALSE(check_mean("exact", 1.1, 0, 100, 1.0));
  EXPECT_TRUE(check_mean("exact", 1.0, 0, 100, 1.0));
  EXPECT_TRUE(check_mean("rounding", 1.000001, 0, 100, 1.0, {.absolute = 1e-5}));
  EXPECT_FALSE(check_mean("blunt", 1.0, 0.1, 100, 1.0, {.largest_relative_error = 0.01}));
}

TEST(CheckMean, HasThePowerToSeeASmallBias) {
  // A bias of one percent of the spread, 10^6 values: ten standard errors.
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.01, 1);
  RunningStatistics statistics;
  for (int i = 0; i < 1'000'000; ++i) statistics.add(noise(random));
  EXPECT_FALSE(check_mean("biased", statistics, 0));
  EXPECT_TRUE(check_mean("as it is", statistics, 0.01));
}

}  // namespace
}  // namespace freepath::testing
