#include "freepath/study/errors.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "freepath/study/heat_map.h"
#include "freepath/study/interval.h"
#include "freepath/study/pixel_estimates.h"
#include "tests/statistics.h"

namespace freepath {
namespace {

constexpr int kWidth = 80;
constexpr int kHeight = 50;

float truth(std::size_t i) { return 1 + 0.5F * std::sin(0.01F * static_cast<float>(i)); }

/// Pictures of the truth with noise of known standard deviation, nearly normal.
PixelEstimates noisy(uint64_t seed, double deviation, float samples = 4) {
  PixelEstimates estimates{.width = kWidth, .height = kHeight};
  for (std::size_t i = 0; i < 3 * estimates.pixel_count(); ++i) {
    RandomStream random(seed, static_cast<uint32_t>(i), 0, 0);
    double sum = -6;
    for (int j = 0; j < 12; ++j) sum += random.uniform();
    estimates.mean.push_back(truth(i) + static_cast<float>(deviation * sum));
    estimates.variance.push_back(static_cast<float>(deviation * deviation));
  }
  estimates.samples.assign(estimates.pixel_count(), samples);
  return estimates;
}

// E[(x - r)²] is the sum of both variances; what the reference adds is taken off.
TEST(SquaredError, IsThatOfThePictureAlone) {
  testing::RunningStatistics mse;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const SquaredError error = squared_error(noisy(seed, 0.1).mean, noisy(1000 + seed, 0.1));
    mse.add(error.mse);
    EXPECT_NEAR(error.mse, (error.channel_mse[0] + error.channel_mse[1] + error.channel_mse[2]) / 3,
                1e-12);
  }
  EXPECT_TRUE(testing::check_mean("MSE", mse, 0.01, {.largest_relative_error = 0.01}));
}

TEST(BiasTest, HasStandardNormalScores) {
  // Samples of both vary alike.
  const auto test_of = [](uint64_t seed) {
    return test_bias(noisy(2 * seed, 0.1, 16), noisy(2 * seed + 1, 0.2, 4));
  };
  const BiasTest test = test_of(0);
  EXPECT_EQ(test.blocks_across, 5);
  EXPECT_EQ(test.blocks_down, 3);  // the last row of blocks has 18 rows of pixels
  EXPECT_EQ(test.tests(), 3U + 3 * 15);
  testing::RunningStatistics squares;
  for (uint64_t seed = 0; seed < 30; ++seed) {
    for (const float z : test_of(seed).block_z) squares.add(z * z);
  }
  EXPECT_TRUE(testing::check_mean("z²", squares, 1, {.largest_relative_error = 0.05}));
}

/// A picture of 2 x 2 blocks with few bright samples among dim ones, each pixel's mean and variance
/// from its own samples.
PixelEstimates sparse(uint64_t seed, int samples, double factor) {
  constexpr int kSize = 2 * BiasTest::kBlock;
  PixelEstimates estimates{.width = kSize, .height = kSize};
  for (uint32_t pixel = 0; pixel < kSize * kSize; ++pixel) {
    RandomStream random(seed, pixel, 0, 0);
    double sum = 0;
    double squares = 0;
    for (int i = 0; i < samples; ++i) {
      double value = 0.1 * random.uniform();
      if (random.uniform() < 0.003F) value += random.exponential();
      value *= factor;
      sum += value;
      squares += value * value;
    }
    const double mean = sum / samples;
    const double variance = (squares / samples - mean * mean) / (samples - 1);
    for (int channel = 0; channel < 3; ++channel) {
      estimates.mean.push_back(static_cast<float>(mean));
      estimates.variance.push_back(static_cast<float>(variance));
    }
  }
  estimates.samples.assign(estimates.pixel_count(), static_cast<float>(samples));
  return estimates;
}

// Two equal methods at few samples, six of a block's two thousand bright. One report in a thousand
// may raise an alarm; with each picture's own variance alone, ten of these 600 do, by z up to 5.3.
TEST(BiasTest, RaisesNoFalseAlarmsAtFewSamples) {
  constexpr int kReports = 600;
  int alarms = 0;
  int naive = 0;
  for (uint64_t report = 0; report < kReports; ++report) {
    const PixelEstimates picture = sparse(2 * report, 8, 1);
    PixelEstimates reference = sparse(2 * report + 1, 64, 1);
    const auto fails = [&] {
      const BiasTest test = test_bias(picture, reference);
      return test.verdict(family_wise_threshold(1e-3, test.tests())) == BiasVerdict::kFails;
    };
    alarms += fails() ? 1 : 0;
    reference.knows_samples = false;  // so that each states its own
    naive += fails() ? 1 : 0;
  }
  EXPECT_LE(alarms, 3);
  EXPECT_GE(naive, 6);
}

// ... and still finds a bias of 2 % once there are samples enough, by means of 8 standard errors
// and more.
TEST(BiasTest, FindsTwoPercentAmongRareSamples) {
  for (uint64_t seed = 0; seed < 2; ++seed) {
    const BiasTest test = test_bias(sparse(2 * seed, 1000, 1.02), sparse(2 * seed + 1, 2000, 1));
    EXPECT_EQ(test.verdict(family_wise_threshold(1e-3, test.tests())), BiasVerdict::kFails);
  }
  for (uint64_t seed = 0; seed < 20; ++seed) {
    PixelEstimates picture = noisy(2 * seed, 0.05);
    for (float& value : picture.mean) value *= 1.01F;
    const BiasTest test = test_bias(picture, noisy(2 * seed + 1, 0.05));
    EXPECT_EQ(test.verdict(family_wise_threshold(1e-3, test.tests())), BiasVerdict::kFails) << seed;
  }
}

TEST(BiasTest, FindsABlockThatIsOff) {
  PixelEstimates picture = noisy(1, 0.1);
  for (int y = 16; y < 32; ++y) {
    for (int x = 32; x < 48; ++x) picture.mean[3 * (y * kWidth + x) + 1] += 0.06F;
  }
  const BiasTest test = test_bias(picture, noisy(2, 0.1));
  const std::size_t block = 1 * 5 + 2;
  EXPECT_EQ(test.worst(), std::abs(double{test.block_z[3 * block + 1]}));
  EXPECT_GT(test.worst(), 5);
}

// A last digit that is off everywhere is no bias; more than that is, where nothing varies.
TEST(BiasTest, KnowsRoundingFromBias) {
  PixelEstimates exact = noisy(1, 0);
  for (std::size_t i = 0; i < exact.mean.size(); ++i) exact.mean[i] = truth(i);
  PixelEstimates rounded = exact;
  for (float& value : rounded.mean) value = std::nextafter(value, 10.0F);
  EXPECT_EQ(test_bias(rounded, exact).worst(), 0);
  for (float& value : rounded.mean) value *= 1.00001F;
  EXPECT_GT(test_bias(rounded, exact).worst(), 1e6);
}

// A few samples that are rare and large: whatever z says, it is not to be believed.
TEST(BiasTest, LeavesHeavyTailsUndecided) {
  const PixelEstimates reference = noisy(2, 0.1);
  EXPECT_NEAR(effective_pixels(reference), kWidth * kHeight, 1e-6 * kWidth * kHeight);
  PixelEstimates picture = noisy(1, 0.1);
  EXPECT_EQ(test_bias(picture, reference).verdict(5), BiasVerdict::kPasses);
  picture.variance[300] = 1e4F;
  const BiasTest test = test_bias(picture, reference);
  EXPECT_TRUE(test.is_heavy_tailed);
  EXPECT_EQ(test.verdict(0), BiasVerdict::kUndecided);
  EXPECT_EQ(test_bias(noisy(1, 0.1), reference).verdict(0), BiasVerdict::kFails);
}

TEST(BiasTest, LeavesPixelsWithoutSamplesOut) {
  PixelEstimates picture = noisy(1, 0.1);
  picture.mean[0] = picture.mean[1] = picture.mean[2] = 1e6F;
  picture.samples[0] = 0;
  EXPECT_LT(test_bias(picture, noisy(2, 0.1)).worst(), 5);
}

TEST(Merged, WeighsBySamples) {
  PixelEstimates few = noisy(1, 0.2, 2);
  PixelEstimates many = noisy(2, 0.1, 8);
  few.lookups.assign(few.pixel_count(), 10);
  many.lookups.assign(many.pixel_count(), 20);
  const PixelEstimates both = merged({&few, &many});
  EXPECT_FLOAT_EQ(both.mean[7], 0.2F * few.mean[7] + 0.8F * many.mean[7]);
  EXPECT_FLOAT_EQ(both.variance[7], 0.04F * few.variance[7] + 0.64F * many.variance[7]);
  EXPECT_FLOAT_EQ(both.samples[7], 10);
  EXPECT_FLOAT_EQ(both.lookups[7], 18);
}

TEST(PixelEstimates, TakesVariancesFromHalvesOrChannels) {
  Image image{.width = 1, .height = 1};
  image.channels = {"R", "G", "B", "A.R", "A.G", "A.B", "B.R", "B.G", "B.B"};
  image.values = {1, 2, 3, 1.5F, 2, 3, 0.5F, 2, 3};
  bool known = false;
  EXPECT_FLOAT_EQ(estimates_of(image, "halves", known).variance[0], 0.25F);
  EXPECT_TRUE(known);
  const Image round_trip = to_image(noisy(3, 0.1));
  EXPECT_EQ(estimates_of(round_trip, "image", known).variance, noisy(3, 0.1).variance);
  EXPECT_TRUE(known);
  image.channels.resize(3);
  image.values.resize(3);
  EXPECT_EQ(estimates_of(image, "colour", known).variance[0], 0);
  EXPECT_FALSE(known);
}

TEST(PixelEstimates, RefusesWhatIsNotFinite) {
  Image image = to_image(noisy(3, 0.1));
  image.values[7 * 81] = std::numeric_limits<float>::infinity();
  bool known = false;
  try {
    estimates_of(image, "broken.exr", known);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("broken.exr: pixel (1, 1)"), std::string::npos)
        << error.what();
  }
}

TEST(HeatMap, RunsFromDarkToBright) {
  const ColorScale scale{.low = 0.01, .high = 100, .logarithmic = true};
  EXPECT_DOUBLE_EQ(scale.position(1), 0.5);
  EXPECT_DOUBLE_EQ(scale.value(0.25), 0.1);
  EXPECT_EQ(scale.position(0), 0);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Image map = heat_map(std::vector<float>{0, 1, 1000, nan}, 4, 1, scale);
  const auto brightness = [&](int i) {
    return map.pixel(i, 0)[0] + map.pixel(i, 0)[1] + map.pixel(i, 0)[2];
  };
  EXPECT_LT(brightness(0), brightness(1));
  EXPECT_LT(brightness(1), brightness(2));
  EXPECT_EQ(map.pixel(3, 0)[0], map.pixel(3, 0)[1]);  // grey: unknown
}

TEST(HeatMap, ScalesHoldMostValues) {
  std::vector<float> values(1000, 2.0F);
  values[0] = 0;
  values[1] = 1e9F;
  for (int i = 2; i < 100; ++i) values[i] = 0.5F;
  const ColorScale scale = logarithmic_scale({values});
  EXPECT_EQ(scale.low, 0.5);
  EXPECT_EQ(scale.high, 2.0);
}

}  // namespace
}  // namespace freepath
