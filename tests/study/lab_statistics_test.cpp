// The laboratory's tests are right when nothing is wrong, and notice what is.

#include "freepath/study/lab_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "freepath/study/interval.h"
#include "tests/statistics.h"

namespace freepath::testing {
namespace {

TEST(LabStatistics, LevelsAgreeWithThoseOfTheTests) {
  EXPECT_NEAR(level_of_each(1e-3, 500), family_wise_level(1e-3, 500), 1e-18);
  EXPECT_NEAR(normal_two_sided_p(1.96), 0.05, 1e-4);
}

/// A path ends in one of four bins, or in none, with a weight drawn from two.
struct Lottery {
  std::vector<double> probability = {0.1, 0.3, 0.4, 0.15};
  double other_weight = 1;  ///< With probability 0.5; the mean weight stays 1.

  std::vector<double> exact() const { return probability; }
  std::vector<LabMoments> draw(std::mt19937_64& random, int paths) const {
    std::vector<LabMoments> bins(probability.size());
    std::discrete_distribution<int> bin({0.1, 0.3, 0.4, 0.15, 0.05});
    for (int i = 0; i < paths; ++i) {
      const int chosen = bin(random);
      if (chosen == 4) continue;
      bins[chosen].add((random() & 1) != 0 ? other_weight : 2 - other_weight);
    }
    return bins;
  }
};

// Against the distribution of p itself: uniform, by the largest distance of Kolmogorov's test.
TEST(LabStatistics, PIsUniformWhereNothingIsWrong) {
  constexpr int kTrials = 600;
  std::mt19937_64 random(20170720);
  for (const double other : {1.0, 1.9, 2.5}) {  // equal weights, wide ones, and of both signs
    Lottery lottery;
    lottery.other_weight = other;
    std::vector<double> p;
    for (int trial = 0; trial < kTrials; ++trial) {
      const LabCheck check =
          check_distribution(lottery.draw(random, 40'000), lottery.exact(), 40'000);
      ASSERT_EQ(check.standing, LabStanding::kTested);
      p.push_back(check.p);
    }
    std::sort(p.begin(), p.end());
    double distance = 0;
    for (int i = 0; i < kTrials; ++i) {
      distance = std::max(distance, std::abs(p[i] - (i + 0.5) / kTrials));
    }
    EXPECT_LT(distance, 1.95 / std::sqrt(double{kTrials})) << other;  // level 1e-3
  }
}

// Hardly any path ends outside of the bins: there a covariance by what was seen alone is off.
TEST(LabStatistics, PIsUniformWhereNearlyAllPathsScatter) {
  constexpr int kTrials = 600;
  constexpr int kPaths = 25'000;
  std::mt19937_64 random(7);
  std::vector<double> exact(31, (1 - 0.0025) / 31);
  std::vector<double> p;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<LabMoments> bins(31);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int i = 0; i < kPaths; ++i) {
      const double u = uniform(random) / (1 - 0.0025) * 31;
      if (u < 31) bins[static_cast<std::size_t>(u)].add(1);
    }
    p.push_back(check_distribution(bins, exact, kPaths).p);
  }
  std::sort(p.begin(), p.end());
  double distance = 0;
  for (int i = 0; i < kTrials; ++i) {
    distance = std::max(distance, std::abs(p[i] - (i + 0.5) / kTrials));
  }
  EXPECT_LT(distance, 1.95 / std::sqrt(double{kTrials}));
}

TEST(LabStatistics, AShiftedDistributionIsNoticed) {
  std::mt19937_64 random(3);
  const Lottery lottery;
  const std::vector<LabMoments> bins = lottery.draw(random, 40'000);
  EXPECT_LT(check_distribution(bins, std::vector{0.115, 0.285, 0.4, 0.15}, 40'000).p, 1e-6);
}

TEST(LabStatistics, MeansOfRareAndHeavyContributionsDoNotCount) {
  LabMoments few;
  for (int i = 0; i < 20; ++i) few.add(1);
  EXPECT_EQ(check_mean(few, 100'000, 2e-4).standing, LabStanding::kRare);
  LabMoments heavy;
  for (int i = 0; i < 1000; ++i) heavy.add(1);
  heavy.add(2000);
  EXPECT_EQ(check_mean(heavy, 2000, 1.5).standing, LabStanding::kHeavy);
  LabMoments broken;
  for (int i = 0; i < 1000; ++i) broken.add(std::nan(""));
  EXPECT_EQ(check_mean(broken, 1000, 1).p, 0);
  EXPECT_EQ(check_mean(broken, 1000, 1).standing, LabStanding::kTested);
  EXPECT_EQ(check_distribution(std::vector{broken, heavy}, std::vector{0.5, 0.5}, 1000).p, 0);
}

}  // namespace
}  // namespace freepath::testing
