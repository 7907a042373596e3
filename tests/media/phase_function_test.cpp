#include "freepath/media/phase/henyey_greenstein.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "freepath/base/random.h"
#include "tests/statistics.h"

namespace freepath {
namespace {

using testing::check_chi_square;
using testing::chi_square_test;
using testing::RunningStatistics;

/// The textbook's formula in double precision [Henyey41].
double reference(double g, double cosine) {
  return (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

/// P(cosine ≤ c), the integral of the reference.
double reference_cdf(double g, double cosine) {
  if (std::abs(g) < 1e-6) return 0.5 * (1 + cosine);
  return (1 - g * g) / (2 * g) * (1 / std::sqrt(1 + g * g - 2 * g * cosine) - 1 / (1 + g));
}

class HenyeyGreensteinTest : public ::testing::TestWithParam<float> {
 protected:
  const double g_ = GetParam();
  const HenyeyGreenstein phase_{GetParam()};
};

TEST_P(HenyeyGreensteinTest, EqualsTheFormulaInDoublePrecision) {
  for (float cosine = -1; cosine <= 1; cosine += 1.0F / 64) {
    const double expected = reference(g_, cosine);
    EXPECT_NEAR(phase_.evaluate(cosine), expected, 2e-5 * expected) << cosine;
  }
}

TEST_P(HenyeyGreensteinTest, IntegratesToOneAndToItsMeanCosine) {
  // Substituting cosine = ±(1 - 2 q⁴) crowds the points at the peak.
  double norm = 0;
  double moment = 0;
  constexpr int kPoints = 20000;
  const double sign = std::signbit(g_) ? -1 : 1;
  for (int i = 0; i < kPoints; ++i) {
    const double q = (i + 0.5) / kPoints;
    const double distance2 = 4 * std::pow(q, 4);  // 2 (1 - cosine)
    const double angle = 2 * std::asin(0.5 * std::sqrt(distance2));
    const Vec3f before(0, 0, 1);
    const Vec3f after(static_cast<float>(std::sin(angle)), 0,
                      static_cast<float>(sign * std::cos(angle)));
    const double value =
        phase_.evaluate(before, after) * 2 * std::numbers::pi * 8 * q * q * q / kPoints;
    norm += value;
    moment += value * sign * (1 - distance2 / 2);
  }
  EXPECT_NEAR(norm, 1, 1e-4);
  EXPECT_NEAR(moment, g_, 1e-4);
}

TEST_P(HenyeyGreensteinTest, SamplesFollowTheDensity) {
  const Vec3f before = Vec3f(1, -2, 0.5F).normalized();
  const TangentFrame frame(before);
  // Bins of equal probability in the cosine, times the azimuth.
  constexpr int kCosines = 40;
  constexpr int kAzimuths = 8;
  constexpr int kSamples = 400'000;
  std::vector<uint64_t> counts(kCosines * kAzimuths, 0);
  RunningStatistics cosines;
  RandomStream random(1, 2, 3, 4);
  for (int i = 0; i < kSamples; ++i) {
    const float u1 = random.uniform();
    const float u2 = random.uniform();
    const PhaseSample sample = phase_.sample(before, u1, u2);
    ASSERT_NEAR(sample.direction.length(), 1, 1e-6);
    // The cosine from the distance, which is accurate at the peak.
    const double sign = std::signbit(g_) ? -1 : 1;
    const double distance2 = (sample.direction - before * static_cast<float>(sign)).length2();
    const double cosine = sign * (1 - distance2 / 2);
    cosines.add(cosine);
    const int bin = static_cast<int>(reference_cdf(g_, cosine) * kCosines);
    const double azimuth =
        std::atan2(sample.direction.dot(frame.bitangent), sample.direction.dot(frame.tangent));
    const int sector = static_cast<int>((azimuth / (2 * std::numbers::pi) + 0.5) * kAzimuths);
    ++counts[std::clamp(bin, 0, kCosines - 1) * kAzimuths + std::clamp(sector, 0, kAzimuths - 1)];
  }
  const std::vector<double> expected(counts.size(), 1.0 * kSamples / counts.size());
  EXPECT_TRUE(check_chi_square("direction", chi_square_test(counts, expected)));
  EXPECT_TRUE(testing::check_mean("mean cosine", cosines, g_, {.absolute = 1e-6}));
}

TEST_P(HenyeyGreensteinTest, ReportsTheDensityThatEvaluationGives) {
  RandomStream random(5, 6, 7, 8);
  Vec3f direction(0, 1, 0);
  for (int i = 0; i < 10'000; ++i) {
    const float u1 = random.uniform();
    const float u2 = random.uniform();
    const PhaseSample sample = phase_.sample(direction, u1, u2);
    const float expected = phase_.evaluate(direction, sample.direction);
    ASSERT_NEAR(sample.pdf, expected, 1e-3 * expected);
    direction = sample.direction;
  }
  EXPECT_NEAR(direction.length(), 1, 1e-6);
}

TEST_P(HenyeyGreensteinTest, StaysFiniteForTheExtremesOfTheUniformNumbers) {
  constexpr float kLast = 1.0F - 0x1p-24F;
  for (const Vec3f& before : {Vec3f(0, 0, 1), Vec3f(0, 0, -1), Vec3f(1, 0, 0), Vec3f(0, -1, 0)}) {
    for (const float u1 : {0.0F, 0x1p-24F, 0.5F, kLast}) {
      for (const float u2 : {0.0F, 0.25F, kLast}) {
        const PhaseSample sample = phase_.sample(before, u1, u2);
        EXPECT_NEAR(sample.direction.length(), 1, 1e-6);
        EXPECT_TRUE(std::isfinite(sample.pdf));
        EXPECT_GT(sample.pdf, 0);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(MeanCosines, HenyeyGreensteinTest,
                         ::testing::Values(0.0F, 1e-4F, -1e-4F, 0.3F, -0.5F, 0.75F, 0.9F, -0.95F,
                                           0.999F, -0.999F));

TEST(HenyeyGreenstein, IsExactlyIsotropicForAMeanCosineOfZero) {
  const HenyeyGreenstein phase(0);
  for (const float cosine : {-1.0F, -0.3F, 0.0F, 0.7F, 1.0F}) {
    EXPECT_EQ(phase.evaluate(cosine), 1.0F / (4.0F * std::numbers::pi_v<float>));
  }
}

TEST(HenyeyGreenstein, ScattersForwardAlongTheDirectionOfTravelForPositiveMeanCosines) {
  const Vec3f before(0, 0, 1);
  EXPECT_GT(HenyeyGreenstein(0.9F).sample(before, 0.1F, 0.5F).direction.z, 0.9F);
  EXPECT_LT(HenyeyGreenstein(-0.9F).sample(before, 0.1F, 0.5F).direction.z, -0.9F);
}

}  // namespace
}  // namespace freepath
