#include "freepath/base/random.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "tests/statistics.h"

namespace freepath {
namespace {

using testing::check_chi_square;
using testing::check_mean;
using testing::chi_square_test;
using testing::RunningStatistics;

using Words = std::array<uint32_t, 4>;
using Key = std::array<uint32_t, 2>;

// The known answers that the authors of [Salmon11] publish with their library Random123.
TEST(Philox, GivesThePublishedAnswersForTenRounds) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}, 10),
            (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(philox({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}, 10),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  // Digits of pi, "nothing up my sleeve".
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}, 10),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Philox, GivesThePublishedAnswerForSevenRounds) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}, 7),
            (Words{0x5f6fb709, 0x0d893f64, 0x4f121f81, 0x4f730a48}));
  static_assert(kPhiloxRounds == 7, "the default is the variant tested here");
}

TEST(Philox, EveryBitOfCounterAndKeyFlipsHalfOfTheOutput) {
  const Words counter{1, 2, 3, 4};
  const Key key{5, 6};
  for (int bit = 0; bit < 192; ++bit) {
    RunningStatistics flipped;
    for (uint32_t block = 0; block < 64; ++block) {
      Words other_counter{block, counter[1], counter[2], counter[3]};
      const Words before = philox(other_counter, key);
      Key other_key = key;
      uint32_t& word = bit < 128 ? other_counter[bit / 32] : other_key[bit / 32 - 4];
      word ^= 1U << (bit % 32);
      const Words after = philox(other_counter, other_key);
      for (int i = 0; i < 4; ++i) flipped.add(std::popcount(before[i] ^ after[i]));
    }
    // 32 fair bits: mean 16, standard deviation sqrt(8); 192 tests at a family-wise level of 1e-4.
    EXPECT_TRUE(check_mean("flipped bits", flipped.mean(),
                           std::sqrt(8.0 / static_cast<double>(flipped.count())), flipped.count(),
                           16, {.z = testing::family_wise_threshold(1e-4, 192)}))
        << "bit " << bit;
  }
}

/// The number that the 63 bits of a pair of words stand for.
double uniform_exactly(uint32_t bits, uint32_t second) {
  return (double(bits >> 1) + (double(second >> 1) + 0.5) * 0x1p-31) * 0x1p-31;
}

/// The first bit of the words chooses the side of log 2, the rest the place on it.
double exponential_exactly(uint32_t bits, uint32_t second) {
  const double fraction =
      (double(bits & 0x7FFFFFFFU) + (double(second >> 1) + 0.5) * 0x1p-31) * 0x1p-32;
  return bits >> 31 != 0 ? -std::log(fraction) : -std::log1p(-fraction);
}

/// Words of every size, from 0 and from both ends of each half.
std::vector<Words> words_of_every_size() {
  std::vector<Words> words;
  for (uint32_t i = 0; i < 200'000; ++i) {
    const Words random = philox({i, 0, 0, 0}, {0, 0});
    const uint32_t size = i < 4096 ? i : random[0] >> (i % 32);
    for (const uint32_t bits : {size, ~size, 0x7FFFFFFFU - (size >> 1), 0x80000000U | size >> 1}) {
      words.push_back({bits, i < 8 ? 0U - (i & 1U) : random[1], 0, 0});
    }
  }
  return words;
}

TEST(UniformFromWords, HasAllItsDigitsNearZeroAndStaysBetweenZeroAndOne) {
  for (const auto& [bits, second, c, d] : words_of_every_size()) {
    const float value = uniform_from_words(bits, second);
    const double exact = uniform_exactly(bits, second);
    ASSERT_TRUE(value > 0 && value < 1) << bits;
    // Where no second word is read it could move the number by half a unit of 2^-31.
    const double unread = bits >> 1 < kFewDigits ? 0 : 0x1p-32;
    ASSERT_NEAR(value, exact, 0x1p-23 * std::max(exact, 0x1p-62) + unread) << bits;
  }
  EXPECT_EQ(uniform_from_words(0, 0), 0x1p-63F);
  EXPECT_EQ(uniform_from_words(0xFFFFFFFF, 0), 1 - 0x1p-24F);
}

TEST(ExponentialFromWords, HasAllItsDigitsFromOneEndToTheOther) {
  for (const auto& [bits, second, c, d] : words_of_every_size()) {
    const double exact = exponential_exactly(bits, second);
    const bool read = (bits & 0x7FFFFFFFU) < kFewDigits;
    ASSERT_NEAR(exponential_from_words(bits, second), exact, (read ? 3.2e-7 : 4e-7) * exact)
        << bits;
  }
  // What a float can't have: 24 bits of 1 end at 22.18 one way and at 6e-8 the other.
  EXPECT_NEAR(exponential_from_words(0x80000000U, 0), 64 * std::numbers::ln2, 1e-5);
  EXPECT_FLOAT_EQ(exponential_from_words(0, 0), 0x1p-64F);
}

// 2^21 numbers: of the events of probability p, what a second word has to say shows from 2^-8 down.
TEST(RandomStream, RareEventsHappenAsOftenAsTheyShould) {
  constexpr int kNumbers = 1 << 21;
  constexpr int kOctaves = 24;
  uint64_t uniform[kOctaves] = {};
  uint64_t near[kOctaves] = {};
  uint64_t far[kOctaves] = {};
  RandomStream stream(11, 0, 0, 0);
  for (int i = 0; i < kNumbers; ++i) {
    const float u = stream.uniform();
    const float tau = stream.exponential();
    for (int k = 0; k < kOctaves && u < std::ldexp(0.7F, -k); ++k) ++uniform[k];
    for (int k = 0; k < kOctaves && tau < std::ldexp(0.7F, -k); ++k) ++near[k];
    for (int k = 0; k < kOctaves && tau > 0.7F * static_cast<float>(k); ++k) ++far[k];
  }
  for (int k = 0; k < kOctaves; ++k) {
    const double p = std::ldexp(double{0.7F}, -k);
    EXPECT_GT(testing::binomial_two_sided_p(uniform[k], kNumbers, p), 1e-4 / kOctaves) << k;
    EXPECT_GT(testing::binomial_two_sided_p(near[k], kNumbers, -std::expm1(-p)), 1e-4 / kOctaves)
        << k;
    EXPECT_GT(testing::binomial_two_sided_p(far[k], kNumbers, std::exp(-double{0.7F} * k)),
              1e-4 / kOctaves)
        << k;
  }
}

TEST(UniformFromBits, ReachesZeroButNotOne) {
  EXPECT_EQ(uniform_from_bits(0), 0.0F);
  EXPECT_LT(uniform_from_bits(0xffffffff), 1.0F);
  EXPECT_EQ(uniform_from_bits(0xffffffff), 1 - 0x1p-24F);
}

TEST(RandomStream, UniformNumbersFillEveryBinAlike) {
  constexpr int kBins = 1024;
  constexpr int kNumbers = 1 << 20;
  for (const uint64_t seed : {uint64_t{0}, uint64_t{1}, uint64_t{1} << 40}) {
    RandomStream stream(seed, 17, 3, 0);
    std::vector<uint64_t> counts(kBins);
    for (int i = 0; i < kNumbers; ++i) {
      ++counts[static_cast<std::size_t>(stream.uniform() * kBins)];
    }
    const std::vector<double> expected(kBins, double{kNumbers} / kBins);
    EXPECT_TRUE(check_chi_square("uniform", chi_square_test(counts, expected))) << "seed " << seed;
  }
}

TEST(RandomStream, FirstNumbersOfManyPathsFillPairsOfBinsAlike) {
  // The first two numbers of each of 2^20 paths: what decides the picture is how paths differ.
  constexpr std::size_t kSide = 32;
  std::vector<uint64_t> counts(kSide * kSide);
  for (uint32_t pixel = 0; pixel < 1024; ++pixel) {
    for (uint32_t sample = 0; sample < 1024; ++sample) {
      RandomStream stream(0, pixel, sample, 0);
      const auto first = static_cast<std::size_t>(stream.uniform() * float{kSide});
      ++counts[first * kSide + static_cast<std::size_t>(stream.uniform() * float{kSide})];
    }
  }
  const std::vector<double> expected(kSide * kSide, 1024.0);
  EXPECT_TRUE(check_chi_square("pairs", chi_square_test(counts, expected)));
}

TEST(RandomStream, ExponentialNumbersFollowTheirLaw) {
  // Bins of width 1/8 up to 8 and one beyond; P(bin) = exp(-a) - exp(-b).
  constexpr int kBins = 65;
  constexpr int kNumbers = 1 << 20;
  RandomStream stream(5, 0, 0, 0);
  std::vector<uint64_t> counts(kBins);
  RunningStatistics statistics;
  for (int i = 0; i < kNumbers; ++i) {
    const float value = stream.exponential();
    ASSERT_TRUE(std::isfinite(value) && value >= 0) << value;
    statistics.add(value);
    ++counts[std::min<std::size_t>(static_cast<std::size_t>(value * 8), kBins - 1)];
  }
  std::vector<double> expected(kBins);
  for (int bin = 0; bin < kBins; ++bin) {
    const double end = bin + 1 < kBins ? std::exp(-(bin + 1) / 8.0) : 0;
    expected[bin] = kNumbers * (std::exp(-bin / 8.0) - end);
  }
  EXPECT_TRUE(check_chi_square("exponential", chi_square_test(counts, expected)));
  EXPECT_TRUE(check_mean("mean", statistics, 1));
}

TEST(RandomStream, IsAFunctionOfItsPlace) {
  RandomStream first(9, 8, 7, 6);
  RandomStream second(9, 8, 7, 6);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(first.bits(), second.bits());
}

TEST(RandomStream, StreamsThatDifferInOneWordAreUncorrelated) {
  constexpr int kNumbers = 100'000;
  const std::array<RandomStream, 6> streams{
      RandomStream(0, 0, 0, 0), RandomStream(1, 0, 0, 0), RandomStream(uint64_t{1} << 32, 0, 0, 0),
      RandomStream(0, 1, 0, 0), RandomStream(0, 0, 1, 0), RandomStream(0, 0, 0, 1)};
  for (std::size_t a = 0; a < streams.size(); ++a) {
    for (std::size_t b = a + 1; b < streams.size(); ++b) {
      RandomStream left = streams[a];
      RandomStream right = streams[b];
      RunningStatistics product;  // of two independent uniforms around 0: mean 0
      for (int i = 0; i < kNumbers; ++i) {
        product.add((left.uniform() - 0.5) * (right.uniform() - 0.5));
      }
      EXPECT_TRUE(
          check_mean("covariance", product, 0, {.z = testing::family_wise_threshold(1e-4, 15)}))
          << a << " and " << b;
    }
  }
}

TEST(StreamNumber, DiffersForEveryPurposeAndBounce) {
  std::set<uint32_t> numbers;
  for (uint32_t bounce = 0; bounce < 100; ++bounce) {
    for (const StreamPurpose purpose : {StreamPurpose::kWalk, StreamPurpose::kShadowWalk,
                                        StreamPurpose::kScatter, StreamPurpose::kCamera}) {
      numbers.insert(stream_number(purpose, bounce));
    }
  }
  EXPECT_EQ(numbers.size(), 400U);
}

}  // namespace
}  // namespace freepath
