#pragma once
/// @file Media that repeat along x and y, and integrals along lines through them.

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "freepath/scene/volume_medium.h"
#include "tests/media/make_field.h"

namespace freepath::testing {

/// A domain from the origin on, of cubic voxels, that repeats along x and y.
struct PeriodicVoxels {
  Vec3i counts{1};
  double voxel = 1;
  std::function<float(const Vec3i&)> extinction;

  Vec3d size() const { return Vec3d(counts) * voxel; }

  /// Of one phase function and albedo.
  VolumeMedium medium(float albedo, const PhaseFunction& phase = {}) const {
    Matrix4d index_to_world;
    index_to_world.setScale(Vec3d(voxel));
    index_to_world *= Matrix4d().setTranslation(Vec3d(0.5 * voxel));
    std::vector<Volume> volumes(1);
    volumes[0].densities.push_back(
        *make_field(Vec3i(0), counts - Vec3i(1), extinction, index_to_world));
    volumes[0].optics.albedo = Rgb(albedo);
    volumes[0].optics.phase = phase;
    return make_medium(std::move(volumes), 0, {.axes = {true, true, false}});
  }

  float at(Vec3i voxel) const {
    if (voxel.z < 0 || voxel.z >= counts.z) return 0;
    for (int axis = 0; axis < 2; ++axis) {
      voxel[axis] = (voxel[axis] % counts[axis] + counts[axis]) % counts[axis];
    }
    return extinction(voxel);
  }

  /// Extinction at a point, in voxels or between their centres.
  double at(const Vec3d& point, bool trilinear) const {
    const Vec3d position = point * (1 / voxel);
    const auto floor = [](double x) { return static_cast<int>(std::floor(x)); };
    if (!trilinear) return at(Vec3i(floor(position.x), floor(position.y), floor(position.z)));
    const Vec3d between = position - Vec3d(0.5);
    const Vec3i base(floor(between.x), floor(between.y), floor(between.z));
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3i step(corner & 1, corner >> 1 & 1, corner >> 2);
      double weight = 1;
      for (int axis = 0; axis < 3; ++axis) {
        const double share = between[axis] - base[axis];
        weight *= step[axis] != 0 ? share : 1 - share;
      }
      sum += weight * at(base + step);
    }
    return sum;
  }

  /// Optical depth between two points, by midpoints.
  double depth(const Vec3d& from, const Vec3d& to, bool trilinear, int steps) const {
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += at(from + (to - from) * ((i + 0.5) / steps), trilinear);
    return sum * (to - from).length() / steps;
  }
};

}  // namespace freepath::testing
