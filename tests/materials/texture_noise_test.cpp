// Noise, and what textures make of it, in closed form.

#include "freepath/materials/textures/texture_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "freepath/materials/textures/texture_table.h"
#include "freepath/spectra/rgb_color_space.h"

namespace freepath::testing {
namespace {

// The value that reference implementations of [Perlin02] print.
TEST(TextureNoise, HasThePublishedValue) {
  EXPECT_NEAR(texture_noise({3.14, 42, 7}), 0.136919958784, 1e-7);
}

// In the middle of a cell all corners weigh 1/8. Those of cell 0 have the gradients (order x, y, z
// of corners) +x+z, +x-z, +x+y, +x+y, -x-z, +x+z, +y-z, -x-y, and the way from each is half a unit
// along every axis: their ascents sum to -1.
TEST(TextureNoise, InTheMiddleOfACellIsTheMeanOfItsCorners) {
  EXPECT_FLOAT_EQ(texture_noise({0.5, 0.5, 0.5}), -0.125F);
  // Along x only two corners count: gradients +x+z and +x-z, then +x-z and -x-y.
  EXPECT_FLOAT_EQ(texture_noise({0.5, 0, 0}), 0.5F * 0.5F - 0.5F * 0.5F);
  EXPECT_FLOAT_EQ(texture_noise({1.5, 0, 0}), 0.5F * 0.5F + 0.5F * 0.5F);
  // 6t^5 - 15t^4 + 10t^3 is 0.103515625 at 1/4.
  EXPECT_FLOAT_EQ(texture_noise({0.25, 0, 0}), 0.25F * (1 - 0.103515625F) - 0.75F * 0.103515625F);
}

TEST(TextureNoise, IsZeroAtWholePlacesAndRepeats) {
  for (const double x : {-3.0, 0.0, 7.0, 255.0}) {
    for (const double y : {-1.0, 2.0, 300.0}) EXPECT_EQ(texture_noise({x, y, x - y}), 0);
  }
  const Vec3d at(0.3, -1.7, 12.4);
  EXPECT_NEAR(texture_noise(at), texture_noise(at + Vec3d(256, -512, 256 * 1000)), 1e-6);
  EXPECT_EQ(texture_noise({std::nan(""), 0, 0}), 0);
  EXPECT_EQ(texture_noise({0, std::numeric_limits<double>::infinity(), 0}), 0);
  EXPECT_TRUE(std::isfinite(texture_noise({1e300, -1e300, 1e18})));
}

TEST(TextureNoise, OctavesAreSummed) {
  const Vec3d at(1.3, 2.2, -0.7);
  const double one = texture_noise(at);
  const double two = texture_noise(at * 1.99);
  const double three = texture_noise(at * (1.99 * 1.99));
  ASSERT_LT(one * two, 0);  // so that absolute values make a difference
  EXPECT_EQ(fractal_motion(at, 0.5F, 0), 0);
  EXPECT_NEAR(fractal_motion(at, 0.5F, 1), one, 1e-6);
  EXPECT_NEAR(fractal_motion(at, 0.25F, 3), one + two / 4 + three / 16, 1e-6);
  EXPECT_NEAR(turbulence(at, 0.25F, 0), 0.2, 1e-6);
  EXPECT_NEAR(turbulence(at, 0.25F, 3),
              std::abs(one) + std::abs(two) / 4 + std::abs(three) / 16 + 0.2 / 64, 1e-6);
}

TEST(TextureNoise, DotsLieWhereNoiseSays) {
  int dots = 0;
  for (int row = 0; row < 16; ++row) {
    for (int column = 0; column < 16; ++column) {
      const auto noise = [&](double x, double y) {
        return texture_noise({column + x, row + y, 0.5});
      };
      const bool dot = noise(0.5, 0.5) > 0;
      dots += dot ? 1 : 0;
      const double s = column + 0.15 * noise(1.5, 2.8);
      const double t = row + 0.15 * noise(4.5, 9.8);
      for (int i = 0; i < 8; ++i) {
        const double x = std::cos(0.785398 * i);
        const double y = std::sin(0.785398 * i);
        EXPECT_EQ(in_polka_dot(float(s + 0.349 * x), float(t + 0.349 * y)), dot);
        EXPECT_FALSE(in_polka_dot(float(s + 0.351 * x), float(t + 0.351 * y)))
            << column << " " << row << " " << i;
      }
    }
  }
  EXPECT_EQ(dots, 108);  // counted by hand, that is by a program of four lines
  EXPECT_FALSE(in_polka_dot(std::nanf(""), 0));
}

void expect_color(const Vec3f& found, const Vec3f& expected) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-6) << c;
}

TEST(TextureNoise, MarbleHasTheColoursOfItsSpline) {
  const Vec3f pale = Vec3f(0.58F, 0.58F, 0.6F) * 1.5F;
  expect_color(marble_color(0), pale);
  expect_color(marble_color(1), pale);
  expect_color(marble_color(-7), pale);
  expect_color(marble_color(0.5F), Vec3f(0.75F));
  // In the middle of the second curve, (1, 3, 3, 1) / 8 of its points.
  expect_color(
      marble_color(0.25F),
      (Vec3f(0.58F, 0.58F, 0.6F) * 4 + Vec3f(0.5F) * 3 + Vec3f(0.6F, 0.59F, 0.58F)) * (1.5F / 8));
}

/// At a place of the world, with a normal.
SurfacePoint at_position(const Vec3f& position, const Vec3f& normal = {0, 0, 1}) {
  SurfacePoint point;
  point.position = position;
  point.normal = point.shading_normal = normal;
  return point;
}

/// To (x + 1, y, z) / 2 of a point of the world.
SolidMapping half() {
  return {Matrix4d().setTranslation(Vec3d(1, 0, 0)) * Matrix4d().setScale(0.5)};
}

float value_of(const FloatTexture& texture, const SurfacePoint& point,
               const Vec3d& origin = Vec3d(0)) {
  TextureTable table;
  const FloatTextureId id = table.add(texture);
  table.set_origin(origin);
  return table.evaluate_float(id, point);
}

TEST(SolidTextures, AreLookedUpInTheirOwnSpace) {
  const SurfacePoint point = at_position({1.6F, 4.4F, -1.4F});
  const Vec3d there(1.3, 2.2, -0.7);
  EXPECT_NEAR(value_of(FbmTexture{half(), 3, 0.25F}, point), fractal_motion(there, 0.25F, 3), 1e-6);
  EXPECT_NEAR(value_of(WrinkledTexture{half(), 3, 0.25F}, point), turbulence(there, 0.25F, 3),
              1e-6);
  EXPECT_NEAR(value_of(WindyTexture{half()}, point),
              std::abs(fractal_motion(there * 0.1, 0.5F, 3)) * fractal_motion(there, 0.5F, 6),
              1e-6);
  // Positions are relative to an origin.
  EXPECT_NEAR(value_of(FbmTexture{half(), 3, 0.25F}, at_position({0.6F, 4.4F, -2.4F}), {1, 0, 1}),
              fractal_motion(there, 0.25F, 3), 1e-6);
}

TEST(SolidTextures, MarbleIsLayersAlongY) {
  SpectrumTable spectra(rgb_color_space("srgb"));
  const SpectrumValues rgb = spectra.in_rgb();
  const auto seen = [&](float variation, const Vec3f& position) {
    TextureTable table;
    const SpectrumTextureId id =
        table.add(SpectrumTexture(MarbleTexture{half(), 3, 0.25F, 2, variation}));
    return table.evaluate_spectrum(id, at_position(position), rgb);
  };
  const auto expect_height = [&](const SampledSpectrum& found, double height) {
    const SampledSpectrum expected = rgb.reflectance(marble_color(static_cast<float>(height)));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 2e-6);
  };
  expect_height(seen(0, {5, 0, 7}), 0.5);
  expect_height(seen(0, {0, 0.3F, 0}), 0.5 + 0.5 * std::sin(0.3));  // 2 · 0.3 / 2
  const Vec3d there = Vec3d(1.3, 2.2, -0.7) * 2;
  expect_height(seen(0.7F, {1.6F, 4.4F, -1.4F}),
                0.5 + 0.5 * std::sin(4.4 + 0.7 * fractal_motion(there, 0.25F, 3)));
}

TEST(SolidTextures, CheckerboardsOfCubes) {
  CheckerboardTexture<FloatInput> board{1.0F, 2.0F};
  board.mapping = half();
  const FloatTexture texture(board);
  for (int x = -3; x < 3; ++x) {
    for (int y = -2; y < 2; ++y) {
      for (int z = -2; z < 2; ++z) {
        const SurfacePoint point =
            at_position({2 * float(x) + 0.1F, 2 * float(y) + 1.9F, 2 * float(z) + 1});
        EXPECT_EQ(value_of(texture, point), (x + y + z) % 2 == 0 ? 1 : 2);
      }
    }
  }
}

}  // namespace
}  // namespace freepath::testing
