#pragma once
/// @file Media with known answers, and rays through them.

#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "freepath/media/field.h"
#include "freepath/media/medium.h"
#include "freepath/tracking/streams.h"
#include "tests/media/make_field.h"

namespace freepath::testing {

/// Noise in [0,1) from a hash of the indices.
inline float hash_noise(const Vec3i& p) {
  uint32_t h =
      uint32_t(p.x) * 0x8DA6B343U ^ uint32_t(p.y) * 0xD8163841U ^ uint32_t(p.z) * 0xCB1AB31FU;
  h ^= h >> 16;
  h *= 0x7FEB352DU;
  h ^= h >> 15;
  h *= 0x846CA68BU;
  h ^= h >> 16;
  return static_cast<float>(h >> 8) * 0x1p-24F;
}

/// `count` copies of one ray, each its own sample.
inline RayStream repeat_ray(const Vec3f& origin, const Vec3f& direction, float t_max,
                            std::size_t count, uint32_t first_sample = 0) {
  RayStream rays;
  rays.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      rays.origin[axis][i] = origin[axis];
      rays.direction[axis][i] = direction[axis];
    }
    rays.t_max[i] = t_max;
    rays.pixel[i] = 7;
    rays.sample[i] = first_sample + static_cast<uint32_t>(i);
    rays.stream[i] = 0;
  }
  return rays;
}

/// Optical depth of unit extinction along a ray, by the midpoint rule: exact to about 1e-6 for
/// `steps` of some thousands a voxel width of the field.
inline double optical_depth(const Field& field, const Vec3d& origin, const Vec3d& direction,
                            double length, Interpolation interpolation, int steps = 200000) {
  const Matrix4d world_to_index = field.index_to_world.inverse();
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const Vec3d point = (origin + direction * ((i + 0.5) * length / steps)) * world_to_index;
    sum += interpolation == Interpolation::kNearest
               ? field.voxels.value(Vec3i(static_cast<int>(std::floor(point.x + 0.5)),
                                          static_cast<int>(std::floor(point.y + 0.5)),
                                          static_cast<int>(std::floor(point.z + 0.5))))
               : field.voxels.interpolate(point);
  }
  return sum * length / steps;
}

/// Fixture A: the canonical chromatic setting in one dimension, x in [0,1]. Scattering ends a path
/// with the radiance L_s(x); the medium emits L_e(x); the background is 1.
struct FixtureA {
  /// Exact radiance at x = 0 by quadrature, and optical thickness.
  static constexpr double kRadiance[3] = {0.74584544, 1.10968931, 0.74747946};
  static constexpr double kThickness[3] = {3.82675652, 2.57584138, 2.86495606};
  static constexpr int kVoxels = 4096;

  static double r(double x) {
    return 0.15 + 0.85 * (0.5 + 0.5 * std::sin(17 * x) * std::cos(5 * x * x + 1));
  }
  static double emitted(double x, int channel) {
    return channel == 0 ? 1 + x : channel == 1 ? 2 - x : 0.5 + x * x;
  }
  static double scattered(double x, int channel) {
    return channel == 0 ? 0.7 : channel == 1 ? 1.1 - x : 1 + 0.3 * std::sin(9 * x);
  }

  /// mu_s = (6r, 0.9 + 2.1r², r), mu_a = (0.5r, 1.5r, 3√r), as a sum of seven components. The
  /// absorbing ones are split so that sums of constant emissions make L_e(x) exactly:
  /// 1+x = 1(1-x) + 2x, 2-x = 2(1-x) + 1x, 0.5+x² = 0.5(1-x²) + 1.5x².
  static Medium medium(int super_voxel = 64, int voxels = kVoxels) {
    std::vector<Component> components;
    const auto add = [&](auto density, const Rgb& sigma_a, const Rgb& sigma_s,
                         const Rgb& emission) {
      Component component;
      Matrix4d index_to_world;
      index_to_world.setScale(Vec3d(1.0 / voxels, 1, 1));
      index_to_world[3][0] = 0.5 / voxels;
      component.density = make_field(
          Vec3i(0, 0, 0), Vec3i(voxels - 1, 0, 0),
          [&](const Vec3i& p) { return static_cast<float>(density((p.x + 0.5) / voxels)); },
          index_to_world);
      component.sigma_a = sigma_a;
      component.sigma_s = sigma_s;
      component.emission = emission;
      components.push_back(component);
    };
    const Rgb none(0.0F);
    add([](double x) { return r(x); }, none, Rgb(6, 0, 1), none);
    add([](double x) { return r(x) * r(x); }, none, Rgb(0, 2.1F, 0), none);
    add([](double) { return 1.0; }, none, Rgb(0, 0.9F, 0), none);
    add([](double x) { return r(x) * (1 - x); }, Rgb(0.5F, 1.5F, 0), none, Rgb(1, 2, 0));
    add([](double x) { return r(x) * x; }, Rgb(0.5F, 1.5F, 0), none, Rgb(2, 1, 0));
    add([](double x) { return std::sqrt(r(x)) * (1 - x * x); }, Rgb(0, 0, 3), none,
        Rgb(0, 0, 0.5F));
    add([](double x) { return std::sqrt(r(x)) * x * x; }, Rgb(0, 0, 3), none, Rgb(0, 0, 1.5F));
    return Medium(std::move(components), super_voxel);
  }
};

}  // namespace freepath::testing
