#include "freepath/sensors/sample_sequence.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "tests/statistics.h"

namespace freepath {
namespace {

using testing::check_chi_square;
using testing::check_mean;
using testing::chi_square_test;
using testing::family_wise_level;
using testing::family_wise_threshold;
using testing::RunningStatistics;

constexpr double kLevel = 1e-4;

std::array<float, 2> sobol_pair(uint64_t seed, uint32_t pixel, uint32_t sample,
                                uint32_t dimension) {
  return SampleSequence(SampleKind::kSobol, seed, pixel, sample).pair(dimension);
}

/// Counts in equal bins of [0, 1).
int bin_of(double u, int bins) { return static_cast<int>(u * bins); }

TEST(SobolPoints, AreThoseOfTheSequence) {
  // The first points of Sobol's sequence: (0, 0), (1/2, 1/2), (1/4, 3/4), (3/4, 1/4), (1/8, 5/8).
  EXPECT_EQ(sobol_second_reversed(0), 0U);
  EXPECT_EQ(sobol_second_reversed(1), 0b1U);
  EXPECT_EQ(sobol_second_reversed(2), 0b11U);
  EXPECT_EQ(sobol_second_reversed(3), 0b10U);
  EXPECT_EQ(sobol_second_reversed(4), 0b101U);
  // Against the recurrence of the direction numbers, v' = v xor v / 2.
  for (const uint32_t index : {5U, 77U, 1234567U, 0xDEADBEEFU, 0xFFFFFFFFU}) {
    uint32_t fraction = 0;
    uint32_t direction = 0x80000000U;
    for (int bit = 0; bit < 32; ++bit) {
      if ((index >> bit & 1U) != 0) fraction ^= direction;
      direction ^= direction >> 1;
    }
    uint32_t reversed = 0;
    for (int bit = 0; bit < 32; ++bit) reversed |= (fraction >> (31 - bit) & 1U) << bit;
    EXPECT_EQ(sobol_second_reversed(index), reversed);
  }
}

TEST(SobolSamples, FillEachElementaryIntervalOnce) {
  for (uint32_t key = 0; key < 40; ++key) {
    const uint64_t seed = 7 + key * 0x123456789ABULL;
    const uint32_t pixel = key * key;
    const uint32_t dimension = key % 7;
    for (int m = 0; m <= 10; ++m) {
      const uint32_t count = 1U << m;
      // Any aligned block of a power of two will do; the first of them are the prefixes.
      const uint32_t first = key % 4 * count;
      for (int a = 0; a <= m; ++a) {
        std::vector<int> boxes(count);
        for (uint32_t sample = first; sample < first + count; ++sample) {
          const auto [x, y] = sobol_pair(seed, pixel, sample, dimension);
          const auto column = static_cast<uint32_t>(x * static_cast<float>(1U << a));
          const auto row = static_cast<uint32_t>(y * static_cast<float>(1U << (m - a)));
          ++boxes[(row << a) + column];
        }
        for (const int points : boxes) ASSERT_EQ(points, 1) << "m = " << m << ", a = " << a;
      }
    }
  }
}

/// Root of the mean squared error of a smooth function's mean over the first n samples.
double error_of_mean(SampleKind kind, uint32_t n) {
  constexpr uint32_t kPixels = 200;
  const double exact = (std::numbers::e - 1) * (2 / std::numbers::pi);
  double sum = 0;
  for (uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    double mean = 0;
    for (uint32_t sample = 0; sample < n; ++sample) {
      const auto [x, y] = SampleSequence(kind, 5, pixel, sample).pair(3);
      mean += std::exp(x) * std::sin(std::numbers::pi * y) / n;
    }
    sum += (mean - exact) * (mean - exact);
  }
  return std::sqrt(sum / kPixels);
}

TEST(SobolSamples, IntegrateSmoothFunctionsFasterThanIndependentOnes) {
  // Independent samples fall by sqrt(4096 / 16) = 16, scrambled ones of a (0,2)-sequence by nearly
  // 256^1.5 = 4096 [Owen95]; the constants leave room for the logarithm and the function.
  const double independent_16 = error_of_mean(SampleKind::kIndependent, 16);
  const double independent_4096 = error_of_mean(SampleKind::kIndependent, 4096);
  const double sobol_16 = error_of_mean(SampleKind::kSobol, 16);
  const double sobol_4096 = error_of_mean(SampleKind::kSobol, 4096);
  RecordProperty("independent_16", std::to_string(independent_16));
  EXPECT_NEAR(independent_16 / independent_4096, 16, 4);
  EXPECT_GT(independent_16 / sobol_16, 5);
  EXPECT_GT(independent_4096 / sobol_4096, 400);
  EXPECT_GT(sobol_16 / sobol_4096, 1000);
}

/// Chi-square tests of a sample's numbers over seeds: each coordinate in fine bins, and both.
void expect_uniform_over_seeds(SampleKind kind) {
  constexpr int kSeeds = 100'000;
  constexpr int kBins = 64;
  constexpr int kSide = 16;
  const uint32_t samples[] = {0, 1, 2, 3, 17, 4095, 0x80000000U};
  for (const uint32_t sample : samples) {
    std::vector<uint64_t> first(kBins);
    std::vector<uint64_t> second(kBins);
    std::vector<uint64_t> both(kSide * kSide);
    for (int seed = 0; seed < kSeeds; ++seed) {
      const auto [x, y] = SampleSequence(kind, seed, 12, sample).pair(2);
      ASSERT_TRUE(x >= 0 && x < 1 && y >= 0 && y < 1);
      ++first[bin_of(x, kBins)];
      ++second[bin_of(y, kBins)];
      ++both[bin_of(y, kSide) * kSide + bin_of(x, kSide)];
    }
    const double level = family_wise_level(kLevel, 3 * std::size(samples));
    for (const auto* counts : {&first, &second, &both}) {
      const std::vector<double> expected(counts->size(),
                                         static_cast<double>(kSeeds) / counts->size());
      EXPECT_TRUE(check_chi_square("sample " + std::to_string(sample),
                                   chi_square_test(*counts, expected), level));
    }
  }
}

TEST(SobolSamples, AreEachUniformOverSeeds) { expect_uniform_over_seeds(SampleKind::kSobol); }

TEST(IndependentSamples, AreEachUniformOverSeeds) {
  expect_uniform_over_seeds(SampleKind::kIndependent);
}

TEST(SobolSamples, ScrambleTheTwoHalvesOfAnIntervalIndependently) {
  // The first two samples lie in opposite halves; where in them must not be related.
  constexpr int kSeeds = 200'000;
  constexpr int kSide = 16;
  std::vector<uint64_t> counts(kSide * kSide);
  const auto within_half = [](double u) { return 2 * u - std::floor(2 * u); };
  for (int seed = 0; seed < kSeeds; ++seed) {
    const double a = within_half(sobol_pair(seed, 3, 0, 1)[0]);
    const double b = within_half(sobol_pair(seed, 3, 1, 1)[0]);
    ++counts[bin_of(a, kSide) * kSide + bin_of(b, kSide)];
  }
  const std::vector<double> expected(counts.size(), static_cast<double>(kSeeds) / counts.size());
  EXPECT_TRUE(check_chi_square("samples 0 and 1", chi_square_test(counts, expected)));
}

/// Product of two numbers less their means, over the standard deviation of a uniform number
/// squared.
double correlation(double a, double b) { return 12 * (a - 0.5) * (b - 0.5); }

TEST(SobolSamples, OfOtherPixelsAndDimensionsAreUncorrelated) {
  struct Pair {
    std::string name;
    RunningStatistics alone;  // of one sample
    RunningStatistics means;  // of the errors of the means of 8 samples
  };
  Pair pairs[] = {{"the next pixel", {}, {}},         {"the pixel below", {}, {}},
                  {"the next dimension", {}, {}},     {"the next dimension's second", {}, {}},
                  {"the second of the pair", {}, {}}, {"the next seed", {}, {}}};
  constexpr uint32_t kWidth = 256;
  constexpr uint32_t kSamples = 8;
  for (uint32_t pixel = 0; pixel < 50'000; ++pixel) {
    double own_sum = 0;
    std::array<double, std::size(pairs)> sums{};
    for (uint32_t sample = 0; sample < kSamples; ++sample) {
      const auto here = sobol_pair(1, pixel, sample, 4);
      const auto next = sobol_pair(1, pixel, sample, 5);
      const double others[] = {sobol_pair(1, pixel + 1, sample, 4)[0],
                               sobol_pair(1, pixel + kWidth, sample, 4)[0],
                               next[0],
                               next[1],
                               here[1],
                               sobol_pair(2, pixel, sample, 4)[0]};
      own_sum += here[0] - 0.5;
      for (std::size_t i = 0; i < std::size(pairs); ++i) {
        if (sample == 0) pairs[i].alone.add(correlation(here[0], others[i]));
        sums[i] += others[i] - 0.5;
      }
    }
    for (std::size_t i = 0; i < std::size(pairs); ++i) pairs[i].means.add(own_sum * sums[i]);
  }
  const double threshold = family_wise_threshold(kLevel, 2 * std::size(pairs));
  for (const Pair& pair : pairs) {
    EXPECT_TRUE(check_mean(pair.name, pair.alone, 0, {.z = threshold}));
    EXPECT_TRUE(check_mean(pair.name + ", means", pair.means, 0, {.z = threshold}));
  }
}

TEST(SobolSamples, PadDimensionsInAnOrderOfTheirOwn) {
  // Were the order of the samples the same, the numbers of two dimensions would fall into few of
  // the cells of their product.
  constexpr uint32_t kPixels = 400;
  constexpr uint32_t kSamples = 256;
  constexpr int kSide = 16;
  std::vector<uint64_t> counts(kSide * kSide);
  for (uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    for (uint32_t sample = 0; sample < kSamples; ++sample) {
      const double x = sobol_pair(9, pixel, sample, 0)[0];
      const double y = sobol_pair(9, pixel, sample, 1)[0];
      ++counts[bin_of(x, kSide) * kSide + bin_of(y, kSide)];
    }
  }
  const std::vector<double> expected(counts.size(),
                                     static_cast<double>(kPixels) * kSamples / counts.size());
  EXPECT_TRUE(check_chi_square("two dimensions", chi_square_test(counts, expected)));
}

TEST(SampleSequence, IsAFunctionOfItsKey) {
  for (const SampleKind kind : {SampleKind::kIndependent, SampleKind::kSobol}) {
    const SampleSequence sequence(kind, 1, 2, 3);
    EXPECT_EQ(sequence.pair(4), SampleSequence(kind, 1, 2, 3).pair(4));
    EXPECT_EQ(sequence.single(4), sequence.pair(4)[0]);
    EXPECT_NE(sequence.pair(4), sequence.pair(5));
    EXPECT_NE(sequence.pair(4), SampleSequence(kind, 1, 2, 4).pair(4));
    EXPECT_NE(sequence.pair(4), SampleSequence(kind, 1, 3, 3).pair(4));
    EXPECT_NE(sequence.pair(4), SampleSequence(kind, 2, 2, 3).pair(4));
    EXPECT_NE(sequence.pair(4), SampleSequence(kind, 1ULL << 32 | 1, 2, 3).pair(4));
  }
  RandomStream stream(1, 3, 3, kSampleStreams + 4);
  const std::array<float, 2> expected{stream.uniform(), stream.uniform()};
  EXPECT_EQ(SampleSequence(SampleKind::kIndependent, 1, 3, 3).pair(4), expected);
}

}  // namespace
}  // namespace freepath
