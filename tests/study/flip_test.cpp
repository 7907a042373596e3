#include "freepath/study/flip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "freepath/base/error.h"

namespace freepath {
namespace {

constexpr int kSize = 48;

std::vector<float> constant(float r, float g, float b) {
  std::vector<float> picture;
  for (int i = 0; i < kSize * kSize; ++i) picture.insert(picture.end(), {r, g, b});
  return picture;
}

/// Smooth, in colour, and brighter than 1 here and there.
std::vector<float> landscape() {
  std::vector<float> picture;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const double wave = 0.5 + 0.5 * std::sin(0.3 * x) * std::cos(0.2 * y);
      picture.push_back(static_cast<float>(3 * wave));
      picture.push_back(static_cast<float>(wave * wave));
      picture.push_back(static_cast<float>(0.1 + 0.02 * y));
    }
  }
  return picture;
}

double mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double mean_flip(const std::vector<float>& a, const std::vector<float>& b) {
  return mean(flip(a, b, kSize, kSize));
}

TEST(Flip, FindsNothingBetweenAPictureAndItself) {
  for (const float value : high_range_flip(landscape(), landscape(), kSize, kSize)) {
    EXPECT_EQ(value, 0);
  }
}

// Without edges the colour difference alone is left. HyAB of black and white is that of their
// lightness, 100; the largest that the metric counts is between green, L* 87.735, a* -86.183,
// b* 83.180, and blue, L* 32.297, a* 79.188, b* -107.860, with chroma times L*/100.
TEST(Flip, AgreesWithTheFormulaForBlackAndWhite) {
  const double a = -86.183 * 0.87735 - 79.188 * 0.32297;
  const double b = 83.180 * 0.87735 + 107.860 * 0.32297;
  const double largest = std::pow(87.735 - 32.297 + std::hypot(a, b), 0.7);
  const double limit = 0.4 * largest;
  const double expected = 0.95 + 0.05 * (std::pow(100, 0.7) - limit) / (largest - limit);
  EXPECT_NEAR(mean_flip(constant(0, 0, 0), constant(1, 1, 1)), expected, 1e-4);
}

// A small step of grey stays in the linear part: 0.95 (ΔL^0.7 / limit), ΔL from CIELAB's own
// formula for luminances 0.5 and 0.52.
TEST(Flip, AgreesWithTheFormulaForASmallStep) {
  const double step = 116 * (std::cbrt(0.52) - std::cbrt(0.5));
  const double a = -86.183 * 0.87735 - 79.188 * 0.32297;
  const double b = 83.180 * 0.87735 + 107.860 * 0.32297;
  const double largest = std::pow(87.735 - 32.297 + std::hypot(a, b), 0.7);
  const double expected = 0.95 * std::pow(step, 0.7) / (0.4 * largest);
  EXPECT_NEAR(mean_flip(constant(0.5F, 0.5F, 0.5F), constant(0.52F, 0.52F, 0.52F)), expected, 2e-4);
}

TEST(Flip, GrowsWithTheDifference) {
  const std::vector<float> grey = constant(0.3F, 0.3F, 0.3F);
  double last = 0;
  for (const float more : {0.01F, 0.03F, 0.1F, 0.3F}) {
    const double difference = mean_flip(grey, constant(0.3F + more, 0.3F, 0.3F));
    EXPECT_GT(difference, last);
    last = difference;
  }
}

// Edges raise a difference of colour where they are: the power 1 - ΔF is below 1.
TEST(Flip, CountsFeaturesMoreThanSmoothDifferences) {
  const std::vector<float> grey = constant(0.3F, 0.3F, 0.3F);
  std::vector<float> with_edge = grey;
  for (int y = 0; y < kSize; ++y) {
    for (int x = kSize / 2; x < kSize; ++x) {
      for (int channel = 0; channel < 3; ++channel) with_edge[3 * (y * kSize + x) + channel] = 0.5F;
    }
  }
  const std::vector<float> differences = flip(grey, with_edge, kSize, kSize);
  const float at_edge = differences[kSize / 2 * kSize + kSize / 2 + 1];
  const float inside = differences[kSize / 2 * kSize + kSize - 2];
  const float outside = differences[kSize / 2 * kSize + 2];
  EXPECT_GT(at_edge, inside);
  EXPECT_GT(inside, 0.2F);
  EXPECT_LT(outside, 0.01F);
}

// Both sides pass through the same steps, and differences are absolute.
TEST(Flip, IsSymmetric) {
  std::vector<float> other = landscape();
  std::reverse(other.begin(), other.end());
  EXPECT_NEAR(mean_flip(landscape(), other), mean_flip(other, landscape()), 1e-6);
}

// Exposures follow from the reference, so that a common factor changes nothing.
TEST(HighRangeFlip, DoesNotDependOnACommonScale) {
  const std::vector<float> reference = landscape();
  std::vector<float> test = reference;
  for (std::size_t i = 0; i < test.size(); i += 7) test[i] *= 1.3F;
  const double expected = mean(high_range_flip(reference, test, kSize, kSize));
  EXPECT_GT(expected, 0.01);
  std::vector<float> bright_reference = reference;
  std::vector<float> bright_test = test;
  for (float& value : bright_reference) value *= 64;
  for (float& value : bright_test) value *= 64;
  EXPECT_NEAR(mean(high_range_flip(bright_reference, bright_test, kSize, kSize)), expected, 1e-4);
}

// A difference in highlights, which a picture clipped to [0, 1] hides.
TEST(HighRangeFlip, SeesWhatIsBrighterThanWhite) {
  std::vector<float> reference = constant(0.2F, 0.2F, 0.2F);
  for (int i = 0; i < 3 * kSize * 12; ++i) reference[i] = 8;
  std::vector<float> test = reference;
  for (int i = 0; i < 3 * kSize * 12; ++i) test[i] = 5;
  EXPECT_EQ(mean_flip(reference, test), 0);
  EXPECT_GT(mean(high_range_flip(reference, test, kSize, kSize)), 0.02);
}

TEST(HighRangeFlip, StandsBlackPicturesAndNaN) {
  const std::vector<float> black = constant(0, 0, 0);
  std::vector<float> broken = black;
  broken[0] = std::numeric_limits<float>::quiet_NaN();
  broken[3] = std::numeric_limits<float>::infinity();
  for (const float value : high_range_flip(black, broken, kSize, kSize)) {
    EXPECT_TRUE(value >= 0 && value <= 1) << value;
  }
}

TEST(Flip, RefusesPicturesOfOtherSizes) {
  EXPECT_THROW(flip(landscape(), constant(0, 0, 0), kSize, kSize + 1), Error);
}

}  // namespace
}  // namespace freepath
