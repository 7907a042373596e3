#include "freepath/base/distributions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "freepath/base/random.h"
#include "tests/statistics.h"

namespace freepath {
namespace {

/// The probability of each index that a table stands for.
std::vector<double> probabilities(const std::vector<AliasEntry>& table) {
  std::vector<double> result(table.size(), 0.0);
  for (std::size_t i = 0; i < table.size(); ++i) {
    result[i] += table[i].threshold;
    result[table[i].alias] += 1.0 - table[i].threshold;
  }
  for (double& p : result) p /= static_cast<double>(table.size());
  return result;
}

TEST(FastAtan2, AgreesWithTheLibraryEverywhere) {
  for (int i = 0; i < 100'000; ++i) {
    const double angle = (i / 50'000.0 - 1) * std::numbers::pi;
    const auto y = static_cast<float>(0.7 * std::sin(angle));
    const auto x = static_cast<float>(0.7 * std::cos(angle));
    ASSERT_NEAR(fast_atan2(y, x), std::atan2(y, x), 5e-7) << angle;
  }
  EXPECT_EQ(fast_atan2(0, 0), 0);
  EXPECT_EQ(fast_atan2(0, 1), 0);
}

TEST(AliasTable, StandsForTheDistribution) {
  const std::vector<std::vector<double>> cases = {
      {1}, {1, 1}, {0, 3}, {5, 0, 0, 0, 0}, {1e-20, 1, 1e20}, {0.1, 0.2, 0.3, 0.05, 0.35, 0}};
  for (const std::vector<double>& weights : cases) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    const std::vector<double> found = probabilities(make_alias_table(weights));
    for (std::size_t i = 0; i < weights.size(); ++i) {
      EXPECT_NEAR(found[i], weights[i] / sum, 1e-7);
      if (weights[i] == 0) {
        EXPECT_EQ(found[i], 0);
      }
    }
  }
}

TEST(AliasTable, LeavesAUniformRemainder) {
  const std::vector<double> weights = {1, 5, 2, 0, 4};
  const std::vector<AliasEntry> table = make_alias_table(weights);
  constexpr int kParts = 4;
  constexpr int kSamples = 200'000;
  std::vector<uint64_t> counts(weights.size() * kParts, 0);
  std::vector<double> expected;
  for (const double weight : weights) {
    expected.insert(expected.end(), kParts, kSamples * weight / 12 / kParts);
  }
  RandomStream random(3, 1, 4, 1);
  for (int i = 0; i < kSamples; ++i) {
    const AliasChoice choice = choose(table, random.uniform());
    ++counts[choice.index * kParts + static_cast<int>(choice.remainder * kParts)];
  }
  EXPECT_TRUE(
      testing::check_chi_square("index and remainder", testing::chi_square_test(counts, expected)));
}

TEST(AliasTable, NeverLeavesItsRange) {
  constexpr float kLast = 1.0F - 0x1p-24F;
  for (const std::size_t size : {1, 3, 7, 1000, 8191}) {
    const std::vector<AliasEntry> table = make_alias_table(std::vector<double>(size, 1.0));
    EXPECT_LT(choose(table, kLast).index, size);
    EXPECT_LT(choose(table, kLast).remainder, 1);
  }
}

TEST(SampleSphere, IsUniform) {
  constexpr int kBands = 10;
  constexpr int kSectors = 12;
  constexpr int kSamples = 200'000;
  std::vector<uint64_t> counts(kBands * kSectors, 0);
  RandomStream random(9, 8, 7, 6);
  for (int i = 0; i < kSamples; ++i) {
    const float u0 = random.uniform();
    const Vec3f d = sample_sphere(u0, random.uniform());
    ASSERT_NEAR(d.length(), 1, 1e-6);
    const int band = std::min(kBands - 1, static_cast<int>((d.z + 1) / 2 * kBands));
    const int sector = std::min(
        kSectors - 1,
        static_cast<int>((std::atan2(d.x, d.y) / (2 * std::numbers::pi) + 0.5) * kSectors));
    ++counts[band * kSectors + sector];
  }
  const std::vector<double> expected(counts.size(), 1.0 * kSamples / counts.size());
  EXPECT_TRUE(testing::check_chi_square("direction", testing::chi_square_test(counts, expected)));
}

}  // namespace
}  // namespace freepath
