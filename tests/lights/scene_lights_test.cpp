// Every light of scenes: that draws have the density that rays find, and estimate what rays see.

#include "freepath/lights/scene_lights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "freepath/lights/photometry.h"
#include "freepath/spectra/wavelengths.h"
#include "tests/lights/scene_lights_cases.h"
#include "tests/statistics.h"

namespace freepath {
namespace {

using testing::LightsCase;
using testing::SeenDelta;
using testing::spectra;
using testing::TestSpectra;

const Vec3f kPosition(0.2F, -0.1F, 0.3F);

/// Lights without extent, and what a position sees of each.
std::vector<LightsCase> delta_cases() {
  const TestSpectra& s = spectra();
  std::vector<LightsCase> cases;
  cases.push_back({"parallel lights", {}});
  cases.back().description.lights = {
      DistantLight{.radiance = s.grey, .scale = 2, .from = {1, 2, 2}, .to = {0, 0, 0}},
      DistantLight{.radiance = s.grey, .illuminance = 0.5, .from = {0, 0, 0}, .to = {0, 3, 0}}};
  cases.back().deltas = [](const Vec3f&) {
    return std::vector<SeenDelta>{{Vec3f(1, 2, 2).normalized(), 2}, {{0, -1, 0}, 0.5}};
  };
  cases.push_back({"point", {}});
  cases.back().description.lights = {
      PointLight{.intensity = s.grey, .scale = 3, .from = {1, 2, 3}}};
  cases.back().deltas = [](const Vec3f& from) {
    const Vec3f towards = Vec3f(1, 2, 3) - from;
    return std::vector<SeenDelta>{{towards.normalized(), 3 / towards.length2()}};
  };
  // Seen within the edge of the cone, halfway up the smooth step.
  cases.push_back({"spot", {}});
  const double middle =
      0.5 * (std::cos(40 * std::numbers::pi / 180) + std::cos(20 * std::numbers::pi / 180));
  const Vec3d aside(std::sqrt(1 - middle * middle), 0, middle);
  cases.back().description.lights = {
      SpotLight{.intensity = s.grey,
                .from = Vec3d(kPosition) - aside * 2.0,
                .to = Vec3d(kPosition) - aside * 2.0 + Vec3d(0, 0, 1),
                .cone_angle = 40,
                .cone_delta_angle = 20}};
  cases.back().deltas = [aside](const Vec3f&) {
    return std::vector<SeenDelta>{{Vec3f(-aside), 0.5 / 4}};
  };
  cases.push_back({"everything without extent, and an area", {}});
  cases.back().description.lights = {
      ConstantInfiniteLight{.radiance = s.red},
      DistantLight{.radiance = s.grey, .from = {0, 0, 1}, .to = {0, 0, 0}},
      PointLight{.intensity = s.grey, .from = {-1, 0, 0}}};
  testing::add_emitter(&cases.back(), std::make_shared<testing::TestSphere>(Vec3f(2, 0, 0), 1.0F),
                       {.radiance = s.red});
  cases.back().deltas = [](const Vec3f& from) {
    const Vec3f towards = Vec3f(-1, 0, 0) - from;
    return std::vector<SeenDelta>{{{0, 0, 1}, 1}, {towards.normalized(), 1 / towards.length2()}};
  };
  return cases;
}

std::vector<LightsCase> all_cases() {
  std::vector<LightsCase> cases = testing::infinite_cases(spectra());
  for (auto& scene : testing::area_cases(spectra())) cases.push_back(std::move(scene));
  for (auto& scene : delta_cases()) cases.push_back(std::move(scene));
  return cases;
}

LightSample draw_with(const SceneLights& lights, const SpectrumValues& values,
                      RandomStream* random) {
  const float u0 = random->uniform();
  const float u1 = random->uniform();
  return lights.sample(kPosition, values, u0, u1, random->uniform());
}

/// Calls f(direction, solid angle) for the midpoints of a grid on the sphere.
template <class Function>
void for_directions(int size, const Function& f) {
  const double solid_angle = 4 * std::numbers::pi / (static_cast<double>(size) * size);
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      f(direction_from_octahedral({(static_cast<float>(column) + 0.5F) / static_cast<float>(size),
                                   (static_cast<float>(row) + 0.5F) / static_cast<float>(size)}),
        solid_angle);
    }
  }
}

bool in_sun(const LightsCase& scene, const Vec3f& d) {
  return scene.sun && scene.sun->disc().contains(d);
}

TEST(SceneLights, ADrawHasTheDensityAndRadianceThatItsRayFinds) {
  const SpectrumTable& table = spectra().table;
  const SpectrumValues in_rgb = table.in_rgb();
  const SpectrumValues spectral =
      table.at(sample_wavelengths<kMaxChannels>(0.37, WavelengthDensity::kVisible));
  for (const LightsCase& scene : all_cases()) {
    const SceneLights lights(scene.description, table);
    for (const SpectrumValues* values : {&in_rgb, &spectral}) {
      RandomStream random(31, 32, 33, 34);
      int compared = 0;
      int off = 0;
      for (int i = 0; i < 20'000; ++i) {
        const LightSample draw = draw_with(lights, *values, &random);
        ASSERT_TRUE(std::isfinite(draw.pdf) && draw.pdf >= 0 && is_finite(draw.radiance));
        if (draw.pdf == 0) continue;
        ASSERT_NEAR(draw.direction.length(), 1, 1e-5) << scene.name;
        if (draw.delta) continue;
        const LightSeen seen = trace(scene, lights, kPosition, draw, *values);
        ++compared;
        // Rounding makes a ray to the very edge of a shape miss it.
        const bool same_pdf = std::abs(seen.pdf - draw.pdf) <= 2e-4F * draw.pdf;
        const bool same_radiance = largest_magnitude(seen.radiance - draw.radiance) <=
                                   1e-3F * (0.01F + largest_magnitude(draw.radiance));
        off += same_pdf && same_radiance ? 0 : 1;
      }
      EXPECT_LE(off, compared / 2000) << scene.name;
      EXPECT_TRUE(compared > 0 || scene.deltas || !lights.is_drawn()) << scene.name;
    }
  }
}

TEST(SceneLights, DrawsFollowTheDensityThatRaysFind) {
  constexpr int kBins = 20;
  constexpr int kSamples = 300'000;
  const SpectrumValues values = spectra().table.in_rgb();
  const auto bin_of = [](const Vec3f& d) {
    const SquarePoint p = octahedral_from_direction(d);
    return std::min(static_cast<int>(p.v * kBins), kBins - 1) * kBins +
           std::min(static_cast<int>(p.u * kBins), kBins - 1);
  };
  for (const LightsCase& scene : all_cases()) {
    const SceneLights lights(scene.description, spectra().table);
    std::vector<double> expected(kBins * kBins + 1, 0.0);
    // So fine that edges of pixels and shapes fall between points without notice.
    for_directions(kBins * 80, [&](const Vec3f& d, double solid_angle) {
      if (in_sun(scene, d)) return;  // which has a bin of its own
      expected[bin_of(d)] +=
          kSamples * solid_angle * trace(scene, lights, kPosition, d, values).pdf;
    });
    if (scene.sun) {
      expected.back() = kSamples * scene.sun->disc().solid_angle() *
                        trace(scene, lights, kPosition, scene.sun->direction(), values).pdf;
    }
    RandomStream random(11, 12, 13, 14);
    std::vector<uint64_t> counts(expected.size(), 0);
    uint64_t with_extent = 0;
    for (int i = 0; i < kSamples; ++i) {
      const LightSample draw = draw_with(lights, values, &random);
      if (draw.delta || draw.pdf == 0) continue;
      ++with_extent;
      ++counts[in_sun(scene, draw.direction) ? counts.size() - 1 : bin_of(draw.direction)];
    }
    if (with_extent == 0) continue;
    // The density integrates to the fraction of draws that it describes.
    const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
    const auto found = static_cast<double>(with_extent);
    // To within what the quadrature misses at the edges of pixels and shapes.
    const double tolerance = 2e-3 * kSamples + 5 * std::sqrt(found * (1 - found / kSamples));
    EXPECT_NEAR(total, found, tolerance) << scene.name;
    // A shape may touch a bin between the points of the quadrature.
    constexpr double kTouched = 0.01;
    for (double& value : expected) value = std::max(kTouched, value * found / total);
    EXPECT_TRUE(testing::check_chi_square(scene.name, testing::chi_square_test(counts, expected)));
  }
}

/// Draws are combined with directions of their own, as those of a path, by the balance heuristic
/// [Veach97].
TEST(SceneLights, DrawsAndEscapesTogetherEstimateTheIntegralOfWhatRaysSee) {
  constexpr float kByItself = 1 / (4 * std::numbers::pi_v<float>);
  const SpectrumValues values = spectra().table.in_rgb();
  // A lobe that no light is symmetric to, as a phase function would weight the light.
  const Vec3f axis = Vec3f(1, 0.4F, -0.7F).normalized();
  const auto f = [&](const Vec3f& d) { return 1.0 + d.dot(axis) + 0.3 * d.y * d.z; };
  for (const LightsCase& scene : all_cases()) {
    const SceneLights lights(scene.description, spectra().table);
    double expected = 0;
    for_directions(1000, [&](const Vec3f& d, double solid_angle) {
      if (in_sun(scene, d)) return;
      expected += f(d) * solid_angle * trace(scene, lights, kPosition, d, values).all()[1];
    });
    if (scene.sun) {
      const Vec3f& d = scene.sun->direction();
      expected +=
          f(d) * scene.sun->disc().solid_angle() * lights.escape(kPosition, d, values).all()[1];
    }
    if (scene.deltas) {
      for (const SeenDelta& delta : scene.deltas(kPosition)) {
        expected += f(delta.direction) * delta.irradiance;
      }
    }
    RandomStream random(21, 22, 23, 24);
    testing::RunningStatistics estimates;
    for (int i = 0; i < 300'000; ++i) {
      const LightSample draw = draw_with(lights, values, &random);
      const float rest = draw.delta ? 0 : kByItself;
      double sum = draw.pdf > 0 ? f(draw.direction) * draw.radiance[1] / (draw.pdf + rest) : 0;
      const float u0 = random.uniform();
      const Vec3f found = sample_sphere(u0, random.uniform());
      const auto find = [&](const LightSeen& seen) {
        sum += f(found) * (seen.radiance[1] / (seen.pdf + kByItself) + seen.undrawn[1] / kByItself);
      };
      find(lights.escape(kPosition, found, values));
      for (uint32_t light = 0; light < scene.emitters.size(); ++light) {
        const auto point = scene.emitters[light]->intersect(kPosition, found);
        if (point) find(lights.hit(kPosition, light, *point, values));
      }
      estimates.add(sum);
    }
    EXPECT_TRUE(testing::check_mean(scene.name, estimates, expected,
                                    {.absolute = 1e-3 * expected, .largest_relative_error = 5e-3}));
  }
}

TEST(SceneLights, ExtremesOfTheUniformNumbersAreDirections) {
  constexpr float kLast = 1.0F - 0x1p-24F;
  const SpectrumValues values = spectra().table.in_rgb();
  for (const LightsCase& scene : all_cases()) {
    const SceneLights lights(scene.description, spectra().table);
    for (int i = 0; i < 8; ++i) {
      const LightSample draw =
          lights.sample(kPosition, values, i & 1 ? kLast : 0, i & 2 ? kLast : 0, i & 4 ? kLast : 0);
      EXPECT_TRUE(std::isfinite(draw.pdf) && is_finite(draw.radiance)) << scene.name;
      if (draw.pdf == 0) continue;
      EXPECT_NEAR(draw.direction.length(), 1, 1e-5) << scene.name;
    }
  }
}

TEST(SceneLights, TheOriginMovesAllLightsAlike) {
  const SpectrumValues values = spectra().table.in_rgb();
  SceneLightsDescription description;
  description.lights = {
      PointLight{.intensity = spectra().grey,
                 .from = {1, 0, 0},
                 .light_to_world = testing::turned({1e6, 0, 0})},
      ConstantInfiniteLight{.radiance = spectra().grey, .portal = testing::test_portal()}};
  for (Vec3d& corner : *std::get<ConstantInfiniteLight>(description.lights[1]).portal) {
    corner += Vec3d(1e6, 0, 0);
  }
  description.origin = {1e6, 0, 0};
  const SceneLights lights(description, spectra().table);
  const Vec3d expected = Vec3d(1, 0, 0) * testing::turned();
  const LightSample draw = lights.sample({0, 0, 0}, values, 0.5F, 0.5F, 0.9F);
  EXPECT_TRUE(draw.delta);
  EXPECT_NEAR((draw.direction * draw.distance - Vec3f(expected)).length(), 0, 1e-5);
  EXPECT_GT(lights.escape({0, 0, 0}, {0, 0, 1}, values).pdf, 0);
}

TEST(SceneLights, SeesNothingFromBehindAPortal) {
  const SpectrumValues values = spectra().table.in_rgb();
  SceneLightsDescription description;
  description.lights = {
      ConstantInfiniteLight{.radiance = spectra().grey, .portal = testing::test_portal()}};
  const SceneLights lights(description, spectra().table);
  const Vec3f behind(0, 0, 10);
  EXPECT_EQ(lights.sample(behind, values, 0.5F, 0.5F, 0.5F).pdf, 0);
  for (const Vec3f& d : {Vec3f(0, 0, 1), Vec3f(0, 0, -1)}) {
    EXPECT_TRUE(is_black(lights.escape(behind, d, values).all()));
  }
}

TEST(SceneLights, AnAreaLightGivesItsRadianceTimesItsSolidAngle) {
  const SpectrumValues values = spectra().table.in_rgb();
  const auto sphere = std::make_shared<testing::TestSphere>(Vec3f(2, 0, 1), 1.0F);
  const auto mesh = std::make_shared<testing::TestMesh>(std::vector<testing::TestMesh::Corners>{
      {Vec3f(-1, -2, -1), Vec3f(0, -2, 2), Vec3f(1, -2, -1)}});
  const auto fluence = [&](std::shared_ptr<const testing::TestEmitter> emitter, bool two_sided) {
    LightsCase scene;
    testing::add_emitter(&scene, std::move(emitter),
                         {.radiance = spectra().constant, .scale = 3, .two_sided = two_sided});
    const SceneLights lights(scene.description, spectra().table);
    RandomStream random(1, 2, 3, 4);
    testing::RunningStatistics estimates;
    for (int i = 0; i < 100'000; ++i) {
      const LightSample draw = draw_with(lights, values, &random);
      // The constant spectrum is not white, but has a luminance of 3 after all.
      const Vec3d rgb(values.to_rgb(draw.radiance));
      estimates.add(draw.pdf > 0 ? luminance_weights(spectra().table.space()).dot(rgb) / draw.pdf
                                 : 0);
    }
    return estimates;
  };
  EXPECT_TRUE(testing::check_mean("sphere", fluence(sphere, false),
                                  3 * sphere->solid_angle(kPosition), {.absolute = 1e-4}));
  const double triangle = 3 * mesh->solid_angle(0, kPosition);
  EXPECT_TRUE(testing::check_mean("triangle", fluence(mesh, true), triangle,
                                  {.absolute = 1e-4, .largest_relative_error = 3e-3}));
}

TEST(SceneLights, AnInvisibleAreaLightIsOnlyDrawn) {
  LightsCase scene{"invisible", {}};
  const auto sphere = std::make_shared<testing::TestSphere>(Vec3f(2, 0, 0), 1.0F);
  testing::add_emitter(&scene, sphere, {.radiance = spectra().grey}, false, true);
  const SceneLights lights(scene.description, spectra().table);
  const LightSample draw = lights.sample(kPosition, spectra().table.in_rgb(), 0.5F, 0.5F, 0.5F);
  EXPECT_TRUE(draw.delta);
  EXPECT_NEAR(draw.radiance[1] / draw.pdf, sphere->solid_angle(kPosition), 1e-4);
}

TEST(SceneLights, DrawsNoLightThatIsTheSameFromEverywhere) {
  const SpectrumValues values = spectra().table.in_rgb();
  SceneLightsDescription sky;
  sky.lights = {ConstantInfiniteLight{.radiance = spectra().warm}};
  const SceneLights alone(sky, spectra().table);
  EXPECT_FALSE(alone.is_drawn());
  EXPECT_EQ(alone.sample(kPosition, values, 0.5F, 0.5F, 0.5F).pdf, 0);
  EXPECT_EQ(alone.escape(kPosition, {0, 0, 1}, values).pdf, 0);
  EXPECT_TRUE(is_black(alone.escape(kPosition, {0, 0, 1}, values).radiance));
  EXPECT_FALSE(is_black(alone.escape(kPosition, {0, 0, 1}, values).undrawn));
  sky.lights.emplace_back(DistantLight{.radiance = spectra().grey});
  const SceneLights with_sun(sky, spectra().table);
  for (const float u : {0.0F, 0.3F, 0.999F}) {
    const LightSample draw = with_sun.sample(kPosition, values, 0.5F, 0.5F, u);
    EXPECT_TRUE(draw.delta);
    EXPECT_EQ(draw.pdf, 1);
  }
}

TEST(SceneLights, KnowsWhenThereIsNoLight) {
  const SpectrumValues values = spectra().table.in_rgb();
  EXPECT_FALSE(SceneLights({}, spectra().table).is_drawn());
  SceneLightsDescription black;
  black.lights = {ConstantInfiniteLight{}, DistantLight{}, PointLight{},
                  ImageInfiniteLight{.image = {"black", testing::colour_image(4, 4, [](int, int) {
                                                 return Vec3f(0);
                                               })}}};
  const SceneLights lights(black, spectra().table);
  EXPECT_FALSE(lights.is_drawn());
  EXPECT_EQ(lights.sample(kPosition, values, 0.5F, 0.5F, 0.5F).pdf, 0);
  EXPECT_TRUE(is_black(lights.escape(kPosition, {0, 0, 1}, values).all()));
  SceneLightsDescription lit;
  lit.lights = {PointLight{.intensity = spectra().warm}};
  EXPECT_TRUE(SceneLights(lit, spectra().table).is_drawn());
}

}  // namespace
}  // namespace freepath
