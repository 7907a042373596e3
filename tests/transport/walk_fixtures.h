#pragma once
/// @file A crooked medium of noise, holes and tiles, rays through it, and their free paths by
/// quadrature.

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "freepath/transport/walker.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {

/// Scaled differently along each axis, mirrored, turned and moved.
inline Matrix4d crooked_transform() {
  Matrix4d matrix;
  matrix.setScale(Vec3d(0.1, 0.07, -0.12));
  matrix *= Matrix4d().rotate(Vec3d(0.3, 0.5, 0.2));
  matrix *= Matrix4d().setTranslation(Vec3d(0.4, -0.3, 0.2));
  return matrix;
}

/// 24³ voxels in bricks of noise, holes and tiles; a seed gives another field in the same bricks.
/// @param padding grows the layout of bricks, and nothing else, by so many voxels on one side
inline std::shared_ptr<Field> lumpy_field(int seed = 0,
                                          const Matrix4d& index_to_world = crooked_transform(),
                                          int padding = 0) {
  return make_field(
      Vec3i(-12 - padding), Vec3i(11),
      [seed](const Vec3i& p) {
        if (p.x < -12 || p.y < -12 || p.z < -12) return 0.0F;
        const float lump = hash_noise(Vec3i(p.x >> 3, p.y >> 3, p.z >> 3) + Vec3i(9 * seed));
        if (lump < 0.2F) return 0.0F;
        if (lump < 0.4F) return 2 * lump;
        return 0.05F + hash_noise(p + Vec3i(100 * seed)) * lump;
      },
      index_to_world);
}

/// A part of a line in the world.
struct TestRay {
  Vec3f origin;
  Vec3f direction;
  float t_max;
};

/// Through the middle, from outside to inside, and from inside along a skew line out again.
inline std::vector<TestRay> test_rays() {
  return {{Vec3f(-2.0F, -0.9F, 0.8F), Vec3f(0.90F, 0.24F, -0.21F).normalized(), 6.0F},
          {Vec3f(0.5F, 2.5F, 0.3F), Vec3f(0.04F, -1, 0.03F).normalized(), 3.3F},
          {Vec3f(0.1F, -0.4F, -0.6F), Vec3f(0.3F, 0.33F, 0.9F).normalized(), 5.0F}};
}

inline RayStream repeat_ray(const TestRay& ray, std::size_t count, std::size_t first_sample) {
  return repeat_ray(ray.origin, ray.direction, ray.t_max, count,
                    static_cast<uint32_t>(first_sample));
}

/// What quadrature knows of the free path along a ray, with T(t) = exp(-depth(t)).
struct RayIntegrals {
  double step = 0;               ///< [world]
  std::vector<double> depth;     ///< Optical depth at multiples of the step.
  std::vector<double> collided;  ///< Of each component: ∫ ρ_k T dt.

  double transmittance() const { return std::exp(-depth.back()); }
  /// Optical depth at a distance.
  double depth_at(double t) const {
    const auto i = std::min(static_cast<std::size_t>(t / step), depth.size() - 2);
    return depth[i] + (depth[i + 1] - depth[i]) * (t / step - static_cast<double>(i));
  }
  /// Distances that cut the collisions into bins of equal probability; ends where they end.
  std::vector<double> equal_bins(int bins) const {
    std::vector<double> edges;
    std::size_t i = 0;
    for (int bin = 1; bin <= bins; ++bin) {
      const double wanted = -std::log1p(-(1 - transmittance()) * bin / bins);
      while (i + 2 < depth.size() && depth[i + 1] < wanted) ++i;
      const double slope = depth[i + 1] - depth[i];
      edges.push_back(step * (static_cast<double>(i) + (wanted - depth[i]) / slope));
    }
    edges.back() = step * static_cast<double>(depth.size() - 1);
    return edges;
  }
};

/// By the midpoint rule, for the extinction of one channel.
inline RayIntegrals integrate(const Medium& medium, const TestRay& ray, Interpolation interpolation,
                              int steps = 60000, int channel = 0) {
  const std::vector<Component>& components = medium.components();
  std::vector<Matrix4d> world_to_index;
  world_to_index.reserve(components.size());
  for (const Component& component : components) {
    world_to_index.push_back(component.density->index_to_world.inverse());
  }
  RayIntegrals result;
  result.step = double(ray.t_max) / steps;
  result.depth.assign(1, 0.0);
  result.collided.assign(components.size(), 0.0);
  std::vector<double> densities(components.size());
  for (int i = 0; i < steps; ++i) {
    const Vec3d world = Vec3d(ray.origin) + Vec3d(ray.direction) * ((i + 0.5) * result.step);
    double sigma_t = 0;
    for (std::size_t k = 0; k < components.size(); ++k) {
      const Vec3d point = world * world_to_index[k];
      const BrickMap& voxels = components[k].density->voxels;
      densities[k] = interpolation == Interpolation::kNearest
                         ? voxels.value(Vec3i(static_cast<int>(std::floor(point.x + 0.5)),
                                              static_cast<int>(std::floor(point.y + 0.5)),
                                              static_cast<int>(std::floor(point.z + 0.5))))
                         : voxels.interpolate(point);
      sigma_t += densities[k] * components[k].sigma_t()[channel];
    }
    const double before = result.depth.back();
    result.depth.push_back(before + sigma_t * result.step);
    if (sigma_t == 0) continue;
    const double lost = std::exp(-before) - std::exp(-result.depth.back());
    for (std::size_t k = 0; k < components.size(); ++k) {
      result.collided[k] += densities[k] / sigma_t * lost;
    }
  }
  return result;
}

/// A mean over all paths of what only some of them add to.
struct Tally {
  double sum = 0;
  double squares = 0;
  void add(double value) {
    sum += value;
    squares += value * value;
  }
  double mean(std::size_t paths) const { return sum / static_cast<double>(paths); }
  double standard_error(std::size_t paths) const {
    const auto n = static_cast<double>(paths);
    return std::sqrt((squares / n - mean(paths) * mean(paths)) / n);
  }
};

inline constexpr Interpolation kInterpolations[] = {
    Interpolation::kNearest, Interpolation::kTrilinear, Interpolation::kStochastic};

inline const char* name_of(Interpolation interpolation) {
  return interpolation == Interpolation::kNearest     ? "nearest"
         : interpolation == Interpolation::kTrilinear ? "trilinear"
                                                      : "stochastic";
}

/// Calls f(flights, i) for `paths` flights of one ray.
template <class Function>
void for_each_flight(const Walker& walker, const TestRay& ray, std::size_t paths, Function f) {
  constexpr std::size_t kBatch = 20'000;
  FlightStream flights;
  WalkStatistics statistics;
  for (std::size_t done = 0; done < paths; done += kBatch) {
    const std::size_t count = std::min(kBatch, paths - done);
    walker.free_paths(repeat_ray(ray, count, done), flights, statistics);
    for (std::size_t i = 0; i < count; ++i) f(flights, i);
  }
}

}  // namespace freepath::testing
