#pragma once
/// @file A cloud for tests of the renderer, and how it is looked at.

#include <memory>

#include "freepath/base/box.h"
#include "freepath/paths/renderer.h"
#include "tests/scene/volume_pictures.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {

/// A lumpy cloud of 24³ voxels with holes and tiles, turned and stretched in the world.
inline std::shared_ptr<Field> lumpy_field() {
  Matrix4d index_to_world;
  index_to_world.setScale(Vec3d(0.1, 0.07, 0.12));
  index_to_world *= Matrix4d().rotate(Vec3d(0.3, 0.5, 0.2));
  return make_field(
      Vec3i(-12), Vec3i(11),
      [](const Vec3i& p) {
        const Vec3i brick(p.x >> 3, p.y >> 3, p.z >> 3);
        const float lump = hash_noise(brick);
        if (lump < 0.3F) return 0.0F;
        if (lump < 0.4F) return 0.5F;
        return hash_noise(p) * lump;
      },
      index_to_world);
}

inline Component cloud(const Rgb& sigma_a, const Rgb& sigma_s, float g) {
  Component component;
  component.density = lumpy_field();
  component.sigma_a = sigma_a;
  component.sigma_s = sigma_s;
  component.phase = PhaseFunction::henyey_greenstein(g);
  return component;
}

inline Camera camera_for(const Medium& medium, int width, int height) {
  return {frame_points(corners_of(medium.world_bounds()), UpAxis::kY, 30, double(width) / height),
          width, height};
}

inline Surroundings constant_light(float radiance) { return {Rgb(radiance)}; }

inline RenderSettings settings_of(uint32_t samples, const char* tracker = "delta") {
  RenderSettings settings;
  settings.samples = samples;
  settings.walk.tracker = tracker;
  settings.walk.seed = 11;
  return settings;
}

}  // namespace freepath::testing
