#pragma once
/// @file Scenes that have all kinds of lights, for the tests that every light must pass.

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/octahedral.h"
#include "freepath/base/random.h"
#include "freepath/lights/scene_lights.h"
#include "freepath/lights/sky.h"
#include "freepath/spectra/blackbody.h"
#include "freepath/spectra/rgb_spectrum.h"
#include "tests/lights/emitter_shapes.h"

namespace freepath::testing {

inline Image colour_image(int width, int height,
                          const std::function<Vec3f(int column, int row)>& colour) {
  Image image{.width = width, .height = height, .channels = {"R", "G", "B"}};
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Vec3f c = colour(column, row);
      image.values.insert(image.values.end(), {c.x, c.y, c.z});
    }
  }
  return image;
}

/// A rough image with black parts and one bright pixel.
inline LightImage rough_image(int width, int height) {
  RandomStream random(2, 7, 1, 8);
  return {"rough", colour_image(width, height, [&](int column, int row) {
            const float value = random.uniform();
            if (column < width / 3 && row > height / 4) return Vec3f(0);
            if (column == width / 2 && row == height / 3) return Vec3f(40, 30, 5);
            return Vec3f(value * value, value, random.uniform());
          })};
}

/// A transform with a rotation about an odd axis and a translation.
inline Matrix4d turned(const Vec3d& shift = Vec3d(0)) {
  Matrix4d matrix;
  matrix.rotate(Vec3d(0.3, -1.1, 2.0));
  for (int i = 0; i < 3; ++i) matrix[3][i] = shift[i];
  return matrix;
}

/// A light without extent as it is seen from a point.
struct SeenDelta {
  Vec3f direction;
  double irradiance;  // in green
};

/// A scene of lights and all that rays can meet in it.
struct LightsCase {
  std::string name;
  SceneLightsDescription description;
  std::vector<std::shared_ptr<const TestEmitter>> emitters = {};  // as area_lights
  std::optional<Sun> sun = {};
  std::function<std::vector<SeenDelta>(const Vec3f&)> deltas = {};
};

/// What a ray finds of all lights along it, were none of them to hide another: as draws do.
inline LightSeen trace(const LightsCase& scene, const SceneLights& lights, const Vec3f& from,
                       const Vec3f& direction, const SpectrumValues& values) {
  LightSeen all = lights.escape(from, direction, values);
  for (uint32_t i = 0; i < scene.emitters.size(); ++i) {
    const auto point = scene.emitters[i]->intersect(from, direction);
    if (!point) continue;
    const LightSeen seen = lights.hit(from, i, *point, values);
    all.radiance += seen.radiance;
    all.undrawn += seen.undrawn;
    all.pdf += seen.pdf;
  }
  return all;
}

/// What the ray of a draw finds of the light that was drawn.
inline LightSeen trace(const LightsCase& scene, const SceneLights& lights, const Vec3f& from,
                       const LightSample& draw, const SpectrumValues& values) {
  if (std::isinf(draw.distance)) return lights.escape(from, draw.direction, values);
  for (uint32_t i = 0; i < scene.emitters.size(); ++i) {
    const auto point = scene.emitters[i]->intersect(from, draw.direction);
    if (!point) continue;
    const float distance = (point->position - from).length();
    if (std::abs(distance - draw.distance) > 1e-2F * distance) continue;
    return lights.hit(from, i, *point, values);
  }
  return {};
}

/// The spectra that the cases use.
struct TestSpectra {
  SpectrumTable table{rgb_color_space("srgb")};
  SpectrumId red =
      table.add(SpectralDistribution(RgbSpectrum::illuminant({2, 0.5, 0.25}, table.space())),
                SpectrumRole::kIlluminant);
  SpectrumId grey =
      table.add(SpectralDistribution(RgbSpectrum::illuminant({1, 1, 1}, table.space())),
                SpectrumRole::kIlluminant);
  SpectrumId constant = table.add(SpectralDistribution(3.7), SpectrumRole::kIlluminant);
  SpectrumId warm =
      table.add(SpectralDistribution(BlackbodySpectrum(3200)), SpectrumRole::kIlluminant);
};

inline const TestSpectra& spectra() {
  static const TestSpectra kSpectra;
  return kSpectra;
}

/// Adds a shape that shines.
inline void add_emitter(LightsCase* scene, std::shared_ptr<const TestEmitter> emitter,
                        AreaEmission emission, bool reversed = false, bool invisible = false) {
  scene->description.area_lights.push_back(
      {emitter, static_cast<uint32_t>(scene->description.emissions.size()), reversed, invisible});
  scene->description.emissions.push_back(std::move(emission));
  scene->emitters.push_back(std::move(emitter));
}

inline PortalCorners test_portal() {
  // A window of 3 x 2 in a tilted wall, which faces the points of the tests.
  const Vec3d p0(-2, -1, 2.5), across(3, 0.4, 0.2), normal(0.1, -0.2, 1);
  const Vec3d x = across.normalized();
  const Vec3d y = normal.cross(x).normalized();
  return {p0, p0 + y * 2, p0 + x * 3 + y * 2, p0 + x * 3};
}

inline std::vector<LightsCase> infinite_cases(const TestSpectra& s) {
  const auto of = [](std::string name, std::vector<LightDescription> lights) {
    LightsCase scene{std::move(name), {}};
    scene.description.lights = std::move(lights);
    return scene;
  };
  Matrix4d sheared = turned();
  sheared[0][1] += 0.4;
  sheared[2][2] *= 1.5;
  std::vector<LightsCase> cases;
  cases.push_back(of("constant", {ConstantInfiniteLight{.radiance = s.red, .scale = 2}}));
  cases.push_back(
      of("image", {ImageInfiniteLight{.image = rough_image(17, 17), .light_to_world = turned()}}));
  cases.push_back(of("image of one pixel", {ImageInfiniteLight{.image = rough_image(1, 1)}}));
  cases.push_back(of("sheared image", {ImageInfiniteLight{.image = rough_image(16, 16),
                                                          .light_to_world = sheared}}));
  cases.push_back(of("lat-long image", {ImageInfiniteLight{.image = rough_image(16, 9),
                                                           .mapping = SphereMapping::kLatLong,
                                                           .light_to_world = turned()}}));
  cases.push_back(of("constant through a portal",
                     {ConstantInfiniteLight{.radiance = s.red, .portal = test_portal()}}));
  cases.push_back(of("image through a portal", {ImageInfiniteLight{.image = rough_image(32, 32),
                                                                   .light_to_world = turned(),
                                                                   .portal = test_portal()}}));
  cases.push_back(of("constant and image", {ConstantInfiniteLight{.radiance = s.warm, .scale = 0.3},
                                            ImageInfiniteLight{.image = rough_image(17, 17)}}));
  const SunParameters parameters{.elevation = 30, .azimuth = 200};
  const Sun sun(parameters, UpAxis::kY);
  cases.push_back(of(
      "sky and sun",
      {EnvironmentLight{.environment = make_sky(parameters, UpAxis::kY)}, SunLight{.sun = sun}}));
  cases.back().sun = sun;
  return cases;
}

inline std::vector<LightsCase> area_cases(const TestSpectra& s) {
  const auto sphere = std::make_shared<TestSphere>(Vec3f(0.5F, 1, 2), 0.8F);
  const auto disk = std::make_shared<TestDisk>(Vec3f(-1, 1.5F, -0.5F), Vec3f(0.3F, -1, 0.2F), 1.5F);
  const auto back =
      std::make_shared<TestDisk>(Vec3f(-1, 1.5F, -0.5F), Vec3f(-0.3F, 1, -0.2F), 1.5F);
  const auto mesh = std::make_shared<TestMesh>(
      std::vector<TestMesh::Corners>{{Vec3f(-1, -2, -1), Vec3f(1, -2, -1), Vec3f(0, -2, 2)},
                                     {Vec3f(1, -2, -1), Vec3f(2, -1, 0), Vec3f(0, -2, 2)}});
  std::vector<LightsCase> cases;
  cases.push_back({"sphere", {}});
  add_emitter(&cases.back(), sphere, {.radiance = s.red, .scale = 3});
  cases.push_back({"disk", {}});
  add_emitter(&cases.back(), disk, {.radiance = s.warm});
  cases.push_back({"reversed disk", {}});
  add_emitter(&cases.back(), back, {.radiance = s.warm}, true);
  cases.push_back({"two-sided disk with an image", {}});
  add_emitter(&cases.back(), back, {.image = rough_image(7, 5), .two_sided = true});
  cases.push_back({"triangles", {}});
  add_emitter(&cases.back(), mesh, {.radiance = s.grey, .two_sided = true});
  cases.push_back({"three shapes and what is around", {}});
  add_emitter(&cases.back(), sphere, {.radiance = s.red});
  add_emitter(&cases.back(), disk, {.radiance = s.grey, .power = 20.0});
  add_emitter(&cases.back(), mesh, {.radiance = s.grey, .two_sided = true});
  cases.back().description.lights = {ImageInfiniteLight{.image = rough_image(9, 9)}};
  // So many that they make a tree; all around, so that none hides another.
  cases.push_back({"many spheres", {}});
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      const Vec3f towards = direction_from_octahedral(
          {(static_cast<float>(i) + 0.5F) / 5, (static_cast<float>(j) + 0.5F) / 5});
      const float distance = 3 + 0.4F * static_cast<float>((i * 5 + j) % 7);
      add_emitter(&cases.back(), std::make_shared<TestSphere>(towards * distance, 0.4F),
                  {.radiance = s.red, .scale = 1.0 + i});
    }
  }
  return cases;
}

}  // namespace freepath::testing
