// Lights in fog, whose light comes along lines: against quadrature, with bounded variance.

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

const std::string kOnce = "Integrator \"volpath\" \"integer maxdepth\" 1\n";

/// Rays along z, at (0, 0).
std::string rays_along_z(const std::string& world, const std::string& settings) {
  return settings + film(8) +
         "LookAt 0 0 -9  0 0 0  0 1 0\n"
         "Camera \"orthographic\" \"float screenwindow\" [ -1e-4 1e-4 -1e-4 1e-4 ]\nWorldBegin\n" +
         world;
}

std::string fog(const Vec3d& sigma_a, const Vec3d& sigma_s, double g) {
  return fmt::format(R"(MakeNamedMedium "fog" "string type" "homogeneous" )"
                     R"("rgb sigma_a" [ {} {} {} ] "rgb sigma_s" [ {} {} {} ] "float g" {})"
                     "\n",
                     sigma_a.x, sigma_a.y, sigma_a.z, sigma_s.x, sigma_s.y, sigma_s.z, g) +
         medium_box("fog", Vec3d(-1), Vec3d(1));
}

double integral(const std::function<double(double)>& f, double begin, double end) {
  // Finely, as the integrand peaks beside the light.
  constexpr int kParts = 64;
  double sum = 0;
  for (int i = 0; i < kParts; ++i) {
    sum += boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
        f, begin + (end - begin) * i / kParts, begin + (end - begin) * (i + 1) / kParts, 5, 1e-9);
  }
  return sum;
}

/// Light of a point at (height, 0, 0) in the box of fog from -1 to 1 that is scattered once into
/// the ray along z. The phase function is that of Henyey and Greenstein.
/// @param intensity by the direction from the light
double scattered_once(double sigma_a, double sigma_s, double g, double height,
                      const std::function<double(const Vec3d&)>& intensity) {
  const double sigma_t = sigma_a + sigma_s;
  return integral(
      [&](double z) {
        const double r = std::hypot(height, z);
        const double cosine = -z / r;
        const double phase =
            (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
        return sigma_s * phase * std::exp(-sigma_t * (z + 1 + r)) / (r * r) *
               intensity(Vec3d(-height, 0, z) / r);
      },
      -1, 1);
}

constexpr double kHeight = 0.04;
const std::string kPoint =
    fmt::format("LightSource \"point\" \"rgb I\" [ 2 2 2 ] \"point3 from\" [ {} 0 0 ]\n", kHeight);
double two(const Vec3d& /*direction*/) { return 2; }

TEST(NearLights, PointInGreyFogIsThatOfQuadrature) {
  for (const double g : {0.0, -0.5, 0.4}) {
    const double expected = scattered_once(0.3, 0.9, g, kHeight, two);
    const std::string scene = rays_along_z(kPoint + fog(Vec3d(0.3), Vec3d(0.9), g), kOnce);
    for (const ColorMode mode : kColorModes) {
      expect_mean(fmt::format("{} g {}", name_of(mode), g),
                  render_text(scene, {.mode = mode, .samples = 4096}),
                  {expected, expected, expected}, {.largest_relative_error = 0.002});
    }
  }
}

TEST(NearLights, PointInChromaticFogIsThatOfQuadrature) {
  const Vec3d sigma_a(0.1, 0.4, 0.9);
  const Vec3d sigma_s(1.2, 0.6, 0.3);
  std::array<double, 3> expected{};
  for (int c = 0; c < 3; ++c) {
    expected[c] = scattered_once(sigma_a[c], sigma_s[c], 0.4, kHeight, two);
  }
  for (const char* const tracker :
       {"delta", "weighted-delta", "spectral", "hero-wavelength", "spectral-decomposition"}) {
    const std::string integrator = fmt::format(
        "Integrator \"volpath\" \"integer maxdepth\" 1 \"string tracker\" \"{}\"\n", tracker);
    const Picture picture = render_text(
        rays_along_z(kPoint + fog(sigma_a, sigma_s, 0.4), integrator), {.samples = 4096});
    expect_mean(tracker, picture, expected, {.largest_relative_error = 0.004});
  }
}

TEST(NearLights, SpotIsThatOfQuadrature) {
  const double end = std::cos(40 * std::numbers::pi / 180);
  const double start = std::cos(25 * std::numbers::pi / 180);
  const auto intensity = [&](const Vec3d& direction) {
    const double u =
        std::clamp((direction.dot(Vec3d(-0.8, 0, 0.6)) - end) / (start - end), 0.0, 1.0);
    return 3 * u * u * (3 - 2 * u);
  };
  const double expected = scattered_once(0.2, 1, 0.3, 0.3, intensity);
  const std::string spot =
      R"(LightSource "spot" "rgb I" [ 3 3 3 ] "point3 from" [ 0.3 0 0 ] "point3 to" [ -0.5 0 0.6 ] )"
      "\"float coneangle\" 40 \"float conedeltaangle\" 15\n";
  expect_mean(
      "spot",
      render_text(rays_along_z(spot + fog(Vec3d(0.2), Vec3d(1), 0.3), kOnce), {.samples = 4096}),
      {expected, expected, expected}, {.largest_relative_error = 0.002});
}

// Its light is found by lines and by chance: the shares of both have to be one.
TEST(NearLights, SmallBallThatShinesIsThatOfQuadrature) {
  constexpr double kRadius = 0.015;
  constexpr double kSigmaT = 1.0;
  const auto arriving = [&](double r) {  // over radiance, by isotropic scattering
    return integral(
        [&](double angle) {
          const double height = r * std::sin(angle);
          const double way =
              r * std::cos(angle) - std::sqrt(std::max(0.0, kRadius * kRadius - height * height));
          return 0.5 * std::sin(angle) * std::exp(-kSigmaT * way);
        },
        0, std::asin(kRadius / r));
  };
  const double expected = integral(
      [&](double z) {
        return 0.8 * std::exp(-kSigmaT * (z + 1)) * 900 * arriving(std::hypot(0.1, z));
      },
      -1, 1);
  const std::string ball =
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [ 900 900 900 ] "
      "Translate 0.1 0 0 MediumInterface \"\" \"fog\" Material \"diffuse\" \"rgb reflectance\" "
      "[ 0 0 0 ] Shape \"sphere\" \"float radius\" 0.015 AttributeEnd\n";
  expect_mean(
      "ball",
      render_text(rays_along_z(fog(Vec3d(0.2), Vec3d(0.8), 0) + ball, kOnce), {.samples = 8192}),
      {expected, expected, expected}, {.largest_relative_error = 0.003});
}

/// Fog and a denser part of it about a hole with two lights, a mirror that hides one, a wall.
const std::string kManyThings =
    kUnlimited + film(12) +
    R"(LookAt 0 0.3 -4  0 0 0  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
LightSource "point" "rgb I" [ 2 1 1 ] "point3 from" [ 0.3 0.1 0 ]
LightSource "spot" "rgb I" [ 3 6 9 ] "point3 from" [ -0.4 0.2 0.1 ] "point3 to" [ 0.6 0 0 ] "float coneangle" 50
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 0.1 0.2 0.1 ] "rgb sigma_s" [ 0.7 0.7 0.8 ] "float g" 0.6
MakeNamedMedium "cloud" "string type" "uniformgrid" "rgb sigma_a" [ 0 0 0 ] "rgb sigma_s" [ 2 2 1 ]
  "integer nx" 3 "integer ny" 2 "integer nz" 1 "float density" [ 1 0.3 0 0.5 1 0.8 ] "point3 p0" [ -0.7 -0.7 -0.7 ] "point3 p1" [ 0.6 0.7 0.7 ]
)" + medium_box("fog", Vec3d(-1), Vec3d(1)) +
    medium_box("cloud", Vec3d(-0.7), Vec3d(0.6, 0.7, 0.7), "fog") +
    R"(AttributeBegin Material "diffuse" "rgb reflectance" [ 0.7 0.5 0.3 ]
  Shape "bilinearmesh" "point3 P" [ -2 -0.8 -2  2 -0.8 -2  -2 -0.8 2  2 -0.8 2 ] AttributeEnd
AttributeBegin Material "conductor" "float roughness" 0.3 Translate 0 0.1 -0.3
  Shape "sphere" "float radius" 0.2 AttributeEnd
)";

TEST(NearLights, AgreesWithScatteringsAloneAmongSurfacesAndOverlappingMedia) {
  double on_variance = 0;
  double off_variance = 0;
  for (const ColorMode mode : kColorModes) {
    const Picture on = render_text(kManyThings, {.mode = mode, .samples = 512});
    const Picture off =
        render_text(kManyThings, {.mode = mode, .samples = 2048, .near_light_lines = false});
    // No sharper than scatterings alone are.
    expect_alike(name_of(mode), on, off, {.largest_relative_error = 0.1});
    for (int c = 0; c < 3; ++c) {
      on_variance += on.error[c] * on.error[c];
      off_variance += off.error[c] * off.error[c];
    }
  }
  EXPECT_LT(on_variance, off_variance);  // of a quarter of the samples
}

TEST(NearLights, VarianceHasAnEnd) {
  const std::string scene =
      kUnlimited + film(16) +
      "LookAt 0 0 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 20\nWorldBegin\n" +
      "LightSource \"point\" \"rgb I\" [ 1 1 1 ] \"point3 from\" [ 0.03 0.02 0 ]\n" +
      fog(Vec3d(0.1), Vec3d(1), 0.5);
  const auto variance = [&](uint32_t samples, uint64_t seed) {  // of a sample
    const double error = render_text(scene, {.samples = samples, .seed = seed}).error[1];
    return error * error * samples;
  };
  std::vector<double> few;
  for (uint64_t seed = 1; seed <= 9; ++seed) few.push_back(variance(16, seed));
  std::sort(few.begin(), few.end());
  // Scatterings alone: a hundred times, and more.
  EXPECT_LT(variance(4096, 5), 4 * few[4]);
}

TEST(NearLights, PictureDependsOnNoCutOfTheWork) {
  for (const ColorMode mode : kColorModes) {
    const Picture whole = render_text(kManyThings, {.mode = mode, .samples = 4});
    const Picture parts =
        render_text(kManyThings, {.mode = mode, .samples = 4, .threads = 1, .batch = 7});
    EXPECT_EQ(whole.image.values, parts.image.values) << name_of(mode);
  }
}

// A large lamp varies little, and light from outside is of no place.
TEST(NearLights, OtherLightsAreLeftAsTheyAre) {
  const std::string scene =
      kUnlimited + film(8) +
      "LookAt 0 0 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 20\nWorldBegin\n" +
      R"(LightSource "distant" "rgb L" [ 1 1 1 ]
AttributeBegin AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] Translate 0 0 3
  Shape "sphere" "float radius" 0.5 AttributeEnd
)" + fog(Vec3d(0.1), Vec3d(1), 0.5);
  const Picture on = render_text(scene, {.samples = 4});
  const Picture off = render_text(scene, {.samples = 4, .near_light_lines = false});
  EXPECT_EQ(on.image.values, off.image.values);
}

// What is scattered once is in the layer of that, wherever the path went.
TEST(NearLights, LayersTellWhatWasScatteredOnce) {
  const std::string world = kPoint + fog(Vec3d(0.3), Vec3d(0.9), 0);
  const Image image = image_with_layers(rays_along_z(world, kUnlimited), 2048);
  EXPECT_EQ(statistics_of(image, "emission.R").mean(), 0);
  EXPECT_TRUE(check_mean("direct", statistics_of(image, "direct.R"),
                         scattered_once(0.3, 0.9, 0, kHeight, two),
                         {.largest_relative_error = 0.01}));
}

}  // namespace
}  // namespace freepath::testing
