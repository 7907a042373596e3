#include "freepath/study/interval.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "freepath/base/random.h"
#include "tests/statistics.h"

namespace freepath {
namespace {

// Student's quantile for 4 degrees of freedom is 2.776 at 97.5 %; the values have mean 3 and
// variance 2.5.
TEST(MeanInterval, IsStudents) {
  const Interval interval = mean_interval(std::vector<double>{1, 2, 3, 4, 5});
  EXPECT_DOUBLE_EQ(interval.value, 3);
  EXPECT_NEAR(*interval.high - 3, 2.7764451 * std::sqrt(2.5 / 5), 1e-6);
  EXPECT_NEAR(3 - *interval.low, *interval.high - 3, 1e-12);
}

TEST(MeanInterval, HasNoEndsForOneValue) {
  const Interval interval = mean_interval(std::vector<double>{7});
  EXPECT_EQ(interval.value, 7);
  EXPECT_FALSE(interval.low || interval.high);
}

TEST(MeanInterval, HoldsTheTruthAsOftenAsItSays) {
  constexpr uint64_t kTrials = 4000;
  uint64_t held = 0;
  for (uint32_t trial = 0; trial < kTrials; ++trial) {
    RandomStream random(5, trial, 0, 0);
    std::vector<double> values;
    for (int i = 0; i < 5; ++i) {
      double sum = 0;  // nearly normal, with mean 6
      for (int j = 0; j < 12; ++j) sum += random.uniform();
      values.push_back(sum);
    }
    const Interval interval = mean_interval(values);
    if (*interval.low <= 6 && 6 <= *interval.high) ++held;
  }
  EXPECT_GT(testing::binomial_two_sided_p(held, kTrials, kConfidence), 1e-3) << held;
}

TEST(GeometricInterval, IsThatOfLogarithms) {
  const auto interval = geometric_interval(std::vector<double>{1, 4});
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->value, 2, 1e-12);
  EXPECT_NEAR(*interval->low * *interval->high, 4, 1e-9);
}

TEST(GeometricInterval, IsNothingWhereAValueHasNoLogarithm) {
  EXPECT_FALSE(geometric_interval(std::vector<double>{1, 0}));
  EXPECT_FALSE(geometric_interval(std::vector<double>{1, -2}));
  EXPECT_FALSE(geometric_interval(std::vector<double>{}));
}

TEST(FamilyWiseThreshold, AgreesWithTheTests) {
  EXPECT_NEAR(family_wise_threshold(1e-3, 3600), testing::family_wise_threshold(1e-3, 3600), 1e-9);
  EXPECT_NEAR(family_wise_threshold(0.05, 1), 1.959964, 1e-6);
}

}  // namespace
}  // namespace freepath
