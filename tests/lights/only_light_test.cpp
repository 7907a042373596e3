// Scenes in which all draws of lights are of one light.

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "freepath/base/distributions.h"
#include "freepath/base/random.h"
#include "freepath/lights/scene_lights.h"
#include "freepath/spectra/wavelengths.h"
#include "tests/lights/scene_lights_cases.h"

namespace freepath {
namespace {

using testing::spectra;

const Vec3f kPlace(0.2F, -0.1F, 0.3F);

TEST(OnlyLight, DrawsOfTheSunAloneHaveOneRadianceAndOneDensity) {
  const Sun sun({.elevation = 30, .irradiance = Rgb(4, 3, 2)}, UpAxis::kY);
  SceneLightsDescription description;
  // The sky is not drawn beside it.
  description.lights = {SunLight{.sun = sun}, ConstantInfiniteLight{.radiance = spectra().warm}};
  const SceneLights lights(description, spectra().table);
  const auto only = lights.only_light();
  ASSERT_TRUE(only);
  ASSERT_NE(only->disc, nullptr);
  const SpectrumValues in_rgb = spectra().table.in_rgb();
  const SpectrumValues spectral =
      spectra().table.at(sample_wavelengths<kMaxChannels>(0.37, WavelengthDensity::kVisible));
  RandomStream random(1, 2, 3, 4);
  for (int i = 0; i < 100; ++i) {
    const float u0 = random.uniform();
    const float u1 = random.uniform();
    for (const SpectrumValues* values : {&in_rgb, &spectral}) {
      const LightSample draw = lights.sample(kPlace, *values, u0, u1, random.uniform());
      EXPECT_EQ(draw.direction, only->disc->sample(u0, u1));
      EXPECT_EQ(draw.radiance, lights.only_radiance(*values));
      EXPECT_FLOAT_EQ(draw.pdf, only->pdf);
      EXPECT_EQ(draw.distance, only->distance);
      EXPECT_FALSE(draw.delta);
    }
  }
  const LightSeen seen = lights.escape(kPlace, sun.direction(), in_rgb);
  EXPECT_FLOAT_EQ(seen.pdf, only->pdf);
}

TEST(OnlyLight, DrawsOfSeveralLightsAreNotOfOne) {
  const SunLight sun{.sun = Sun({.elevation = 30, .irradiance = Rgb(4, 3, 2)}, UpAxis::kY)};
  const DistantLight distant{.radiance = spectra().grey};
  const ImageInfiniteLight peaks{.image = {"peaks", testing::colour_image(16, 16, [](int x, int y) {
                                             return Vec3f(x == 3 && y == 5 ? 1 : 0);
                                           })}};
  const ConstantInfiniteLight portal{.radiance = spectra().warm, .portal = testing::test_portal()};
  const auto has_one = [](std::vector<LightDescription> all) {
    SceneLightsDescription description;
    description.lights = std::move(all);
    return SceneLights(description, spectra().table).only_light().has_value();
  };
  EXPECT_TRUE(has_one({sun}));
  EXPECT_TRUE(has_one({distant}));
  EXPECT_FALSE(has_one({}));
  EXPECT_FALSE(has_one({peaks}));
  EXPECT_FALSE(has_one({portal}));
  EXPECT_FALSE(has_one({sun, peaks}));
  EXPECT_FALSE(has_one({sun, portal}));
  EXPECT_FALSE(has_one({sun, sun}));
  EXPECT_FALSE(has_one({sun, distant}));
  EXPECT_FALSE(has_one({distant, distant}));
  EXPECT_FALSE(has_one({sun, PointLight{.intensity = spectra().warm}}));
}

TEST(OnlyImage, EscapesThatKnowWhatItShowsSeeTheSame) {
  const SunLight sun{.sun = Sun({.elevation = 30, .irradiance = Rgb(4, 3, 2)}, UpAxis::kY)};
  const EnvironmentLight around{
      .environment = ImageEnvironment(testing::rough_image(24, 12).pixels, UpAxis::kY, "around"),
      .scale = 2};
  const ImageInfiniteLight framed = {.image = testing::rough_image(16, 16)};
  const auto lights_of = [](std::vector<LightDescription> all) {
    SceneLightsDescription description;
    description.lights = std::move(all);
    return SceneLights(std::move(description), spectra().table);
  };
  EXPECT_EQ(lights_of({sun, framed}).image_around(), nullptr);
  EXPECT_EQ(lights_of({around, around}).image_around(), nullptr);
  const SceneLights lights = lights_of({sun, framed, around});
  const ImageEnvironment* const image = lights.image_around();
  ASSERT_NE(image, nullptr);
  const SpectrumValues values = spectra().table.in_rgb();
  RandomStream random(5, 2, 3, 4);
  for (int i = 0; i < 200; ++i) {
    const float u = random.uniform();
    const Vec3f direction = i == 0 ? sun.sun.direction() : sample_sphere(u, random.uniform());
    const LightSeen seen = lights.escape(kPlace, direction, values);
    LightValue known = image->evaluate(direction);
    const LightSeen same = lights.escape(kPlace, direction, values, &known);
    EXPECT_EQ(same.radiance, seen.radiance);
    EXPECT_EQ(same.undrawn, seen.undrawn);
    EXPECT_EQ(same.pdf, seen.pdf);
    // It is taken at its word, and for this image alone.
    known.radiance += Rgb(1, 2, 3);
    const LightSeen more = lights.escape(kPlace, direction, values, &known);
    EXPECT_NEAR(sum_of(more.radiance + more.undrawn), sum_of(seen.radiance + seen.undrawn) + 12,
                1e-3F * sum_of(more.radiance + more.undrawn));
  }
}

}  // namespace
}  // namespace freepath
