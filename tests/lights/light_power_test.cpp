// How bright the lights of scenes are, by power and illuminance, and what cannot be a light.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>

#include "freepath/base/error.h"
#include "freepath/lights/photometry.h"
#include "freepath/lights/scene_lights.h"
#include "freepath/spectra/illuminants.h"
#include "tests/lights/scene_lights_cases.h"

namespace freepath {
namespace {

using testing::spectra;
using testing::TestSpectra;

double luminance_of_channels(const SampledSpectrum& c, const SpectrumValues& values) {
  return luminance_weights(spectra().table.space()).dot(Vec3d(values.to_rgb(c)));
}

SceneLights one(LightDescription light) {
  SceneLightsDescription description;
  description.lights.push_back(std::move(light));
  return {std::move(description), spectra().table};
}

/// Luminous flux of a light at a point: its irradiance on a unit sphere around it.
double flux_around(const SceneLights& lights, const Vec3f& centre, int size = 1500) {
  const SpectrumValues values = spectra().table.in_rgb();
  double sum = 0;
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const Vec3f d =
          direction_from_octahedral({(static_cast<float>(column) + 0.5F) / static_cast<float>(size),
                                     (static_cast<float>(row) + 0.5F) / static_cast<float>(size)});
      const LightSample draw = lights.sample(centre + d, values, 0.5F, 0.5F, 0.5F);
      sum += luminance_of_channels(draw.radiance, values);
    }
  }
  return sum * 4 * std::numbers::pi / (static_cast<double>(size) * size);
}

template <class Function>
std::string message_of(const Function& function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

void expect_message(LightDescription light, const std::string& part) {
  const std::string message = message_of([&] { one(std::move(light)); });
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(Photometry, SpectraAreNormalisedToALuminanceOfOneButRgbIsNot) {
  EXPECT_DOUBLE_EQ(photometric_scale(SpectralDistribution(4.0)), 0.25);
  const SpectralDistribution lamp(illuminant_a().scaled(7));
  EXPECT_NEAR(photometric_scale(lamp), 1.0 / 7, 1e-6);
  const RgbColorSpace& space = spectra().table.space();
  EXPECT_EQ(photometric_scale(SpectralDistribution(RgbSpectrum::illuminant({3, 2, 1}, space))), 1);
  EXPECT_EQ(photometric_scale(SpectralDistribution(0.0)), 1);
}

TEST(Photometry, ARadianceOfRgbIsSeenAsThatRgb) {
  const SceneLights lights = one(ConstantInfiniteLight{.radiance = spectra().red, .scale = 3});
  const SpectrumValues values = spectra().table.in_rgb();
  const Vec3f rgb = values.to_rgb(lights.escape({0, 0, 0}, {0, 0, 1}, values).all());
  EXPECT_LE((rgb - Vec3f(6, 1.5F, 0.75F)).length(), 2e-3F);
}

TEST(Photometry, PowerIsThatOfTheLight) {
  const TestSpectra& s = spectra();
  const Matrix4d frame = testing::turned({1, 2, 3});
  const Vec3f centre(1, 2, 3);
  for (const SpectrumId spectrum : {s.constant, s.warm, s.grey}) {
    EXPECT_NEAR(
        flux_around(
            one(PointLight{
                .intensity = spectrum, .power = 50.0, .from = {0, 0, 0}, .light_to_world = frame}),
            centre, 20),
        50, 5e-3);
    EXPECT_NEAR(flux_around(one(SpotLight{.intensity = spectrum,
                                          .power = 50.0,
                                          .cone_angle = 50,
                                          .cone_delta_angle = 30,
                                          .light_to_world = frame}),
                            centre, 600),
                50, 2e-2);
    EXPECT_NEAR(flux_around(one(SpotLight{.intensity = spectrum,
                                          .power = 50.0,
                                          .cone_angle = 130,
                                          .cone_delta_angle = 20,
                                          .light_to_world = frame}),
                            centre, 600),
                50, 2e-2);
  }
  EXPECT_NEAR(flux_around(one(GoniometricLight{.intensity = s.warm,
                                               .image = testing::rough_image(8, 8),
                                               .power = 50.0,
                                               .light_to_world = frame}),
                          centre),
              50, 5e-2);
  for (const auto& [width, height] : {std::pair{12, 8}, {5, 10}}) {
    EXPECT_NEAR(flux_around(one(ProjectionLight{.image = testing::rough_image(width, height),
                                                .fov = 70,
                                                .power = 50.0,
                                                .light_to_world = frame}),
                            centre),
                50, 0.1);
  }
}

TEST(Photometry, PowerOfAnRgbIsMultipliedByItsLuminanceAndScale) {
  const Vec3d rgb(2, 0.5, 0.25);
  const double luminance = luminance_weights(spectra().table.space()).dot(rgb);
  EXPECT_NEAR(flux_around(one(PointLight{.intensity = spectra().red, .scale = 2, .power = 50.0}),
                          Vec3f(0), 20),
              100 * luminance, 0.05);
}

TEST(Photometry, PowerOfAnAreaLightIsThatOfEachPart) {
  const SpectrumValues values = spectra().table.in_rgb();
  const auto mesh = std::make_shared<testing::TestMesh>(std::vector<testing::TestMesh::Corners>{
      {Vec3f(-1, -2, -1), Vec3f(1, -2, -1), Vec3f(0, -2, 2)},
      {Vec3f(1, -2, -1), Vec3f(2, -1, 0), Vec3f(0, -2, 2)}});
  for (const bool two_sided : {false, true}) {
    testing::LightsCase scene;
    testing::add_emitter(&scene, mesh,
                         {.radiance = spectra().warm, .power = 7.0, .two_sided = two_sided});
    const SceneLights lights(scene.description, spectra().table);
    for (uint32_t part = 0; part < 2; ++part) {
      SurfacePoint point = testing::surface_point({0, 0, 0}, mesh->bounds(part).axis);
      point.primitive = part;
      const double sides = two_sided ? 2 : 1;
      const double luminance =
          luminance_of_channels(lights.emitted(0, point, point.normal, values), values);
      EXPECT_NEAR(luminance * std::numbers::pi * mesh->area(part) * sides, 7, 1e-4);
      EXPECT_EQ(is_black(lights.emitted(0, point, -point.normal, values)), !two_sided);
    }
  }
}

TEST(Photometry, AnImageOfAnAreaLightHasItsOriginBelow) {
  const SpectrumValues values = spectra().table.in_rgb();
  testing::LightsCase scene;
  const Image image = testing::colour_image(
      2, 2, [](int column, int row) { return Vec3f(1.0F + 2 * row + column); });
  testing::add_emitter(&scene, std::make_shared<testing::TestSphere>(Vec3f(0), 1.0F),
                       {.image = LightImage{"four", image}, .scale = 2});
  const SceneLights lights(scene.description, spectra().table);
  SurfacePoint point = testing::surface_point({0, 0, 1}, {0, 0, 1});
  EXPECT_FLOAT_EQ(lights.emitted(0, point, point.normal, values)[0], 6);
  point.u = point.v = 1;
  EXPECT_FLOAT_EQ(lights.emitted(0, point, point.normal, values)[0], 4);
  point.u = point.v = 0.5F;
  EXPECT_FLOAT_EQ(lights.emitted(0, point, point.normal, values)[0], 5);
}

TEST(Photometry, IlluminanceIsThatOfASurface) {
  const TestSpectra& s = spectra();
  const SpectrumValues values = s.table.in_rgb();
  const SceneLights distant = one(DistantLight{.radiance = s.warm, .illuminance = 12.0});
  const LightSample draw = distant.sample({0, 0, 0}, values, 0, 0, 0);
  EXPECT_NEAR(luminance_of_channels(draw.radiance, values), 12, 1e-4);
  EXPECT_EQ(draw.direction, Vec3f(0, 0, -1));
  const auto around = [&](LightDescription light, const Vec3f& up) {
    const SceneLights lights = one(std::move(light));
    double sum = 0;
    constexpr int kSize = 800;
    for (int row = 0; row < kSize; ++row) {
      for (int column = 0; column < kSize; ++column) {
        const Vec3f d = direction_from_octahedral({(column + 0.5F) / kSize, (row + 0.5F) / kSize});
        sum += std::max(0.0F, d.dot(up)) *
               luminance_of_channels(lights.escape({0, 0, 0}, d, values).all(), values);
      }
    }
    return sum * 4 * std::numbers::pi / (kSize * kSize);
  };
  EXPECT_NEAR(around(ConstantInfiniteLight{.radiance = s.warm, .illuminance = 12.0}, {1, 0, 0}), 12,
              1e-2);
  const Matrix4d frame = testing::turned();
  Vec3d up;
  frame.multDirMatrix(Vec3d(0, 0, 1), up);
  EXPECT_NEAR(around(ImageInfiniteLight{.image = testing::rough_image(32, 32),
                                        .illuminance = 12.0,
                                        .light_to_world = frame},
                     Vec3f(up)),
              12, 0.05);
  EXPECT_NEAR(around(ImageInfiniteLight{.image = testing::rough_image(32, 16),
                                        .mapping = SphereMapping::kLatLong,
                                        .illuminance = 12.0},
                     {0, 1, 0}),
              12, 0.05);
}

TEST(PunctualLights, AreOrientedAsPbrtDoes) {
  const TestSpectra& s = spectra();
  const SpectrumValues values = s.table.in_rgb();
  // The projector looks along z; the image's first row is up (y), its first column at -x.
  const Image image = testing::colour_image(
      2, 2, [](int column, int row) { return Vec3f(1.0F + 2 * row + column); });
  const SceneLights projector = one(ProjectionLight{.image = {"four", image}, .fov = 90});
  const auto at = [&](const SceneLights& lights, const Vec3f& position) {
    return lights.sample(position, values, 0, 0, 0).radiance[1] * position.length2();
  };
  EXPECT_NEAR(at(projector, {-0.5F, 0.5F, 1}), 1, 1e-5);
  EXPECT_NEAR(at(projector, {0.5F, 0.5F, 1}), 2, 1e-5);
  EXPECT_NEAR(at(projector, {-0.5F, -0.5F, 1}), 3, 1e-5);
  EXPECT_EQ(at(projector, {1.1F, 0, 1}), 0);
  EXPECT_EQ(at(projector, {0, 0, -1}), 0);
  // A goniometric map's z is the light's y.
  Image lobe = testing::colour_image(
      9, 9, [](int column, int row) { return Vec3f(column == 4 && row == 4 ? 9 : 1); });
  const SceneLights goniometric =
      one(GoniometricLight{.intensity = s.grey, .image = LightImage{"lobe", lobe}});
  EXPECT_NEAR(at(goniometric, {0, 2, 0}), 9, 1e-4);
  EXPECT_NEAR(at(goniometric, {0, 0, 2}), 1, 1e-4);
}

TEST(LightErrors, SayWhichLightAndWhy) {
  const TestSpectra& s = spectra();
  TestSpectra bad;
  const SpectrumId negative = bad.table.add(SpectralDistribution(-1.0), SpectrumRole::kIlluminant);
  SceneLightsDescription description;
  description.lights = {PointLight{.name = "a.pbrt:7", .intensity = negative}};
  const std::string message = message_of([&] { SceneLights(description, bad.table); });
  EXPECT_EQ(message.find("a.pbrt:7: its spectrum is -1 at 360 nm"), 0U) << message;
  expect_message(PointLight{.intensity = s.grey, .scale = -1}, "its scale is -1");
  expect_message(
      ConstantInfiniteLight{.radiance = s.grey, .scale = std::numeric_limits<double>::infinity()},
      "its scale is inf");
  expect_message(PointLight{.intensity = s.grey, .power = -3.0}, "power or illuminance is -3");
  expect_message(ImageInfiniteLight{.image = testing::rough_image(8, 4)},
                 "rough: the image has 8 x 4 pixels");
  expect_message(GoniometricLight{.intensity = s.grey, .image = testing::rough_image(8, 4)},
                 "rough: the image has 8 x 4 pixels");
  expect_message(ImageInfiniteLight{.image = {"empty", {}}}, "empty");
  expect_message(SpotLight{.intensity = s.grey, .to = {0, 0, 0}}, "directed to where it is");
  expect_message(SpotLight{.intensity = s.grey, .cone_angle = 20, .cone_delta_angle = 30},
                 "cannot have an edge");
  expect_message(ProjectionLight{.image = testing::rough_image(8, 4), .fov = 180}, "180");
  expect_message(DistantLight{.radiance = s.grey, .from = {1, 1, 1}, .to = {1, 1, 1}},
                 "directed to where it comes from");
  Matrix4d flat;
  flat[2][2] = 0;
  expect_message(DistantLight{.radiance = s.grey, .light_to_world = flat}, "no inverse");
  LightImage infinite = testing::rough_image(4, 4);
  infinite.pixels.values[3 * 6 + 1] = std::numeric_limits<float>::infinity();
  expect_message(ImageInfiniteLight{.image = infinite}, "rough: pixel (2, 1)");
}

TEST(LightErrors, APortalIsARectangle) {
  const testing::TestSpectra& s = spectra();
  const PortalCorners good = testing::test_portal();
  one(ConstantInfiniteLight{.radiance = s.grey, .portal = good});
  PortalCorners bad = good;
  bad[2] += Vec3d(0, 0, 0.2);  // out of the plane
  expect_message(ConstantInfiniteLight{.radiance = s.grey, .portal = bad}, "rectangle");
  bad = good;
  bad[1] = bad[0];
  expect_message(ConstantInfiniteLight{.radiance = s.grey, .portal = bad}, "rectangle");
  bad = good;
  std::swap(bad[1], bad[2]);  // not in order
  expect_message(ConstantInfiniteLight{.radiance = s.grey, .portal = bad}, "rectangle");
  const Vec3d slant = (good[3] - good[0]) * 0.3;
  bad = {good[0], good[1] + slant, good[2] + slant, good[3]};
  expect_message(ConstantInfiniteLight{.radiance = s.grey, .portal = bad}, "rectangle");
}

}  // namespace
}  // namespace freepath
