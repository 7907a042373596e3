// Images of the whole sphere, the sun and the sky, each alone.

#include "freepath/lights/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "freepath/lights/pixel_draws.h"
#include "freepath/lights/sky.h"
#include "tests/expect_near.h"
#include "tests/lights/sky_images.h"
#include "tests/statistics.h"

namespace freepath {
namespace {

using testing::expect_near;
using testing::grey_image;
using testing::rough_image;

TEST(PixelDraws, TheirGainIsThatOfASimulation) {
  // Four pixels of equal solid angle.
  const std::vector<double> importance{20, 2, 1, 1};
  const std::vector<double> solid_angles(2, std::numbers::pi);
  const PixelDraws plain(importance, solid_angles);
  const PixelDraws drawn = plain.above_mean();
  const auto part = [&](std::size_t pixel) {
    return importance[pixel] / (1 + drawn.pdf(pixel) / kUniformSpherePdf);
  };
  testing::RunningStatistics with_draws;
  testing::RunningStatistics without;
  RandomStream random(5, 6, 7, 8);
  for (int i = 0; i < 400'000; ++i) {
    const auto found = static_cast<std::size_t>(random.uniform() * 4);
    without.add(importance[found]);
    double sum = part(found);
    for (int draw = 0; draw < 2; ++draw) {
      const float u = random.uniform();
      const PixelDraws::Choice choice = drawn.choose(u, random.uniform());
      const bool is_lit = random.uniform() < 0.5F;
      if (is_lit) sum += part(choice.row.index * 2 + choice.column.index);
    }
    with_draws.add(sum);
  }
  EXPECT_NEAR(without.mean(), 6, 0.1);
  EXPECT_NEAR(with_draws.mean(), without.mean(), 0.1);
  const double gain = without.variance() / with_draws.variance();
  EXPECT_NEAR(plain.gain_above_mean(), gain, 0.03 * gain);
  EXPECT_EQ(PixelDraws({3, 3, 3, 3}, solid_angles).gain_above_mean(), 0);
}

TEST(ImageEnvironment, FollowsTheLatLongConvention) {
  // With y up: the centre is +z, the left quarter +x, the right quarter -x, the top +y.
  expect_near(lat_long_direction(0.5F, 0, UpAxis::kY), {0, 0, 1});
  expect_near(lat_long_direction(0.25F, 0, UpAxis::kY), {1, 0, 0});
  expect_near(lat_long_direction(0.75F, 0, UpAxis::kY), {-1, 0, 0});
  expect_near(lat_long_direction(0.5F, 1, UpAxis::kY), {0, 1, 0});
  // With z up: the centre is -y, the left quarter still +x, the top +z.
  expect_near(lat_long_direction(0.5F, 0, UpAxis::kZ), {0, -1, 0});
  expect_near(lat_long_direction(0.25F, 0, UpAxis::kZ), {1, 0, 0});
  expect_near(lat_long_direction(0.5F, 1, UpAxis::kZ), {0, 0, 1});
  for (const UpAxis up : {UpAxis::kY, UpAxis::kZ}) {
    const LatLong position = lat_long(lat_long_direction(0.3F, std::cos(1.1F), up), up);
    EXPECT_NEAR(position.u, 0.3F, 1e-6);
    EXPECT_NEAR(position.v, 1.1F / std::numbers::pi, 1e-6);
  }
}

TEST(ImageEnvironment, ShowsThePixelThatLiesInADirection) {
  const Image image = grey_image(8, 4, [](int column, int row) { return 10.0F * row + column; });
  for (const UpAxis up : {UpAxis::kY, UpAxis::kZ}) {
    const ImageEnvironment environment(image, up, "numbers");
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 8; ++column) {
        const auto height = static_cast<float>(std::cos(std::numbers::pi * (row + 0.5) / 4));
        const Vec3f d = lat_long_direction((column + 0.5F) / 8, height, up);
        EXPECT_NEAR(environment.evaluate(d).radiance.x, 10.0F * row + column, 1e-4);
      }
    }
  }
}

TEST(ImageEnvironment, IsContinuousAcrossItsSeam) {
  const ImageEnvironment environment(rough_image(), UpAxis::kY, "rough");
  const float left = environment.evaluate(lat_long_direction(1e-6F, 0.1F, UpAxis::kY)).radiance.x;
  const float right =
      environment.evaluate(lat_long_direction(1 - 1e-6F, 0.1F, UpAxis::kY)).radiance.x;
  EXPECT_NEAR(left, right, 1e-4);
}

TEST(ImageEnvironment, TheDensityIsZeroOnlyWhereTheInterpolantIsBlack) {
  // A black pixel shines at its edge if a neighbour does.
  const ImageEnvironment environment(rough_image(), UpAxis::kY, "rough");
  RandomStream random(51, 52, 53, 54);
  int black = 0;
  for (int i = 0; i < 100'000; ++i) {
    const float u0 = random.uniform();
    const LightValue value = environment.evaluate(sample_sphere(u0, random.uniform()));
    if (value.radiance.x > 0) {
      ASSERT_GT(value.pdf, 0);
    } else {
      ++black;
    }
  }
  EXPECT_GT(black, 1000);
}

TEST(ImageEnvironment, NamesThePixelThatIsNoLight) {
  for (const float bad :
       {-1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    const Image image =
        grey_image(8, 4, [&](int column, int row) { return column == 5 && row == 2 ? bad : 1.0F; });
    try {
      ImageEnvironment(image, UpAxis::kY, "bad.exr");
      FAIL() << "accepted " << bad;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("bad.exr: pixel (5, 2)"), std::string::npos)
          << error.what();
    }
  }
}

TEST(Sun, RadianceTimesSolidAngleIsItsIrradiance) {
  const Sun sun({.elevation = 20, .azimuth = 80, .irradiance = Rgb(3, 2, 1)}, UpAxis::kZ);
  // The solid angle of a cone, in a form that doesn't cancel.
  const double sine = std::sin(0.5 * 0.2665 * std::numbers::pi / 180);
  EXPECT_NEAR(sun.disc().solid_angle(), 4 * std::numbers::pi * sine * sine,
              1e-6 * sun.disc().solid_angle());
  EXPECT_NEAR(sun.radiance().x * sun.disc().solid_angle(), 3, 1e-5);
  EXPECT_NEAR(sun.radiance().z * sun.disc().solid_angle(), 1, 1e-5);
}

TEST(Sun, TheDiscThatRaysSeeHasTheSampledSolidAngle) {
  // Uniform points of a square around the disc, in the plane tangent to the sphere: the fraction
  // inside is π r² / side², up to the curvature (2e-5).
  const Sun sun({.elevation = 33, .azimuth = 77}, UpAxis::kY);
  const TangentFrame frame(sun.direction());
  const double radius = std::tan(0.2665 * std::numbers::pi / 180);
  RandomStream random(41, 42, 43, 44);
  constexpr int kSamples = 2'000'000;
  uint64_t inside = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double x = (2 * random.uniform() - 1) * 1.1 * radius;
    const double y = (2 * random.uniform() - 1) * 1.1 * radius;
    const Vec3f d = frame.to_world(static_cast<float>(x), static_cast<float>(y), 1).normalized();
    inside += sun.disc().contains(d) ? 1 : 0;
  }
  const double expected = std::numbers::pi / (2.2 * 2.2);
  const double error = std::sqrt(expected * (1 - expected) / kSamples);
  EXPECT_TRUE(testing::check_mean("fraction inside", static_cast<double>(inside) / kSamples, error,
                                  kSamples, expected, {.absolute = 5e-5}));
}

TEST(Sun, EverySampledDirectionLiesInTheDisc) {
  for (const double azimuth : {0.0, 45.0, 190.0}) {
    for (const double elevation : {-90.0, -5.0, 0.0, 37.0, 90.0}) {
      const Sun sun({.elevation = elevation, .azimuth = azimuth}, UpAxis::kY);
      for (int i = 0; i < 1000; ++i) {
        const float u1 = static_cast<float>(i) / 1000;
        for (const float u0 : {0.0F, 0.5F, 1.0F - 0x1p-24F}) {
          ASSERT_TRUE(sun.disc().contains(sun.disc().sample(u0, u1)));
        }
      }
    }
  }
}

TEST(Sun, IsDimmerAndRedderWhenItIsLow) {
  const Rgb high = direct_sun_irradiance(60, 3);
  const Rgb low = direct_sun_irradiance(5, 3);
  EXPECT_NEAR(luminance(high) / kRadiancePerKilocandela, 100, 20);  // [klx]
  const Rgb half = direct_sun_irradiance(45, 3);
  EXPECT_NEAR(half.x / half.y, 1, 1e-5F);
  EXPECT_NEAR(half.z / half.y, 1, 1e-5F);
  EXPECT_LT(luminance(low), 0.3F * luminance(high));
  EXPECT_GT(low.x / low.z, 2 * high.x / high.z);
  EXPECT_GT(direct_sun_irradiance(0, 3).x, 0);
}

TEST(Sun, RefusesImpossibleParameters) {
  EXPECT_THROW(Sun({.elevation = 91}, UpAxis::kY), Error);
  EXPECT_THROW(Sun({.turbidity = 1}, UpAxis::kY), Error);
  EXPECT_THROW(Sun({.irradiance = Rgb(-1)}, UpAxis::kY), Error);
}

TEST(DaylightSky, IsBrightestAroundTheSunAndMildBelowTheHorizon) {
  const SunParameters sun{.elevation = 25, .azimuth = 110};
  for (const UpAxis up : {UpAxis::kY, UpAxis::kZ}) {
    const ImageEnvironment sky = make_sky(sun, up);
    const auto at = [&](double elevation, double azimuth) {
      return luminance(sky.evaluate(sky_direction(elevation, azimuth, up)).radiance);
    };
    EXPECT_GT(at(25, 110), 2 * at(25, 290));
    EXPECT_GT(at(25, 110), 2 * at(90, 0));
    EXPECT_LT(at(-60, 0), at(5, 0));
    EXPECT_GT(at(-60, 0), 0.02F);
  }
}

TEST(DaylightSky, RefusesASunBelowTheHorizon) {
  EXPECT_THROW(make_sky({.elevation = -1}, UpAxis::kY), Error);
  EXPECT_THROW(make_sky({.elevation = 10, .turbidity = 20}, UpAxis::kY), Error);
}

}  // namespace
}  // namespace freepath
