// The equal-area map of the sphere, and images on it.

#include "freepath/base/octahedral.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "freepath/lights/octahedral_environment.h"
#include "tests/lights/scene_lights_cases.h"
#include "tests/statistics.h"

namespace freepath {
namespace {
const Vec3f kWeights(0.2126F, 0.7152F, 0.0722F);

void expect_at(const Vec3f& direction, float u, float v) {
  const SquarePoint p = octahedral_from_direction(direction);
  EXPECT_NEAR(p.u, u, 1e-6) << direction;
  EXPECT_NEAR(p.v, v, 1e-6) << direction;
  EXPECT_LE((direction_from_octahedral({u, v}) - direction.normalized()).length(), 2e-6F);
}

TEST(Octahedral, LiesAsPbrtLaysIt) {
  expect_at({0, 0, 1}, 0.5F, 0.5F);
  expect_at({1, 0, 0}, 1, 0.5F);
  expect_at({-1, 0, 0}, 0, 0.5F);
  expect_at({0, 1, 0}, 0.5F, 1);
  expect_at({0, -3, 0}, 0.5F, 0);  // of any length
  EXPECT_LE((direction_from_octahedral({0, 0}) - Vec3f(0, 0, -1)).length(), 1e-6F);
  EXPECT_LE((direction_from_octahedral({1, 0}) - Vec3f(0, 0, -1)).length(), 1e-6F);
  // Diagonals: 1 - |z| = r², at x = y.
  const float r = 0.3F;
  const float across = r * std::sqrt(2 - r * r) / std::sqrt(2.0F);
  expect_at({across, across, 1 - r * r}, 0.5F + 0.25F * r, 0.5F + 0.25F * r);
  expect_at({-across, across, r * r - 1}, 0.25F * r, 1 - 0.25F * r);
}

TEST(Octahedral, GoesThereAndBack) {
  RandomStream random(1, 2, 3, 4);
  for (int i = 0; i < 100'000; ++i) {
    const float u0 = random.uniform();
    const Vec3f d = sample_sphere(u0, random.uniform());
    const SquarePoint p = octahedral_from_direction(d);
    ASSERT_TRUE(p.u >= 0 && p.u <= 1 && p.v >= 0 && p.v <= 1);
    const Vec3f back = direction_from_octahedral(p);
    ASSERT_LE((back - d).length(), 3e-6F) << d;
    ASSERT_NEAR(back.length(), 1, 1e-6F);
  }
}

TEST(Octahedral, UniformDirectionsAreUniformPoints) {
  constexpr int kBins = 16;
  constexpr int kSamples = 400'000;
  std::vector<uint64_t> counts(kBins * kBins, 0);
  RandomStream random(5, 6, 7, 8);
  for (int i = 0; i < kSamples; ++i) {
    const float u0 = random.uniform();
    const SquarePoint p = octahedral_from_direction(sample_sphere(u0, random.uniform()));
    ++counts[std::min(static_cast<int>(p.v * kBins), kBins - 1) * kBins +
             std::min(static_cast<int>(p.u * kBins), kBins - 1)];
  }
  const std::vector<double> expected(counts.size(), kSamples / double{kBins * kBins});
  EXPECT_TRUE(testing::check_chi_square("equal areas", testing::chi_square_test(counts, expected)));
}

TEST(OctahedralEnvironment, ShowsThePixelThatLiesInADirection) {
  const Image image = testing::colour_image(
      8, 8, [](int column, int row) { return Vec3f(10.0F * row + column, 1, 0); });
  const OctahedralEnvironment environment(image, kWeights, "numbers");
  for (int row = 0; row < 8; ++row) {
    for (int column = 0; column < 8; ++column) {
      const Vec3f d = direction_from_octahedral({(column + 0.5F) / 8, (row + 0.5F) / 8});
      EXPECT_NEAR(environment.evaluate(d).radiance.x, 10.0F * row + column, 2e-4);
    }
  }
}

TEST(OctahedralEnvironment, TheFluenceIsThatOfThePixels) {
  const Image image = testing::rough_image(17, 17).pixels;
  double sum = 0;
  for (std::size_t i = 0; i < image.values.size(); ++i) sum += image.values[i] * kWeights[i % 3];
  const double expected = 4 * std::numbers::pi * sum / (17.0 * 17.0);
  const OctahedralEnvironment environment(image, kWeights, "rough");
  EXPECT_NEAR(environment.fluence(), expected, 1e-5 * expected);
  RandomStream random(3, 1, 4, 1);
  testing::RunningStatistics estimates;
  for (int i = 0; i < 200'000; ++i) {
    const float u0 = random.uniform();
    const LightValue value = environment.sample(u0, random.uniform()).light;
    estimates.add(kWeights.dot(Vec3f(value.radiance.x, value.radiance.y, value.radiance.z)) /
                  value.pdf);
  }
  EXPECT_TRUE(testing::check_mean("fluence", estimates, expected,
                                  {.absolute = 1e-4 * expected, .largest_relative_error = 2e-3}));
}

}  // namespace
}  // namespace freepath
