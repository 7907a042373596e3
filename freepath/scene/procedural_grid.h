#pragma once
/// @file Sampling functions of space into brick maps, and sets of spheres to make shapes of.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "freepath/scene/procedural.h"

namespace freepath::procedural {

/// Voxels over a box of the world: voxel (i,j,k) is centred at origin + (i,j,k)·voxel_size.
struct GridShape {
  Vec3i size{0};  ///< Voxels.
  Vec3f origin{0};
  float voxel_size = 1;

  Vec3f centre(const Vec3i& voxel) const { return origin + Vec3f(voxel) * voxel_size; }
};

/// Length of the longest side of every procedural volume [world].
inline constexpr float kLongestSide = 100;

/// The grid over a box whose longest side is kLongestSide.
/// @throws Error for a resolution out of range
GridShape grid_over(const Box3f& box, int resolution);

/// 8³ voxels to be sampled.
struct BrickRegion {
  Vec3i first;       ///< First voxel.
  Vec3f centre;      ///< World.
  float radius = 0;  ///< Radius of the sphere around all its voxel centres [world].
};

/// Fills the values of a brick, 512 for each field one after the other, zero at first. False: it is
/// empty.
using BrickSampler = std::function<bool(const BrickRegion&, std::span<float>)>;

/// Samples fields over a grid, bricks in parallel. Only bricks that hold something are stored.
std::vector<Field> sample_fields(const GridShape& shape, std::span<const std::string> names,
                                 const BrickSampler& sampler,
                                 const std::function<void(double)>& progress);

/// Samples the voxels of a brick.
/// @param at point of the world → array of one value for each field; where the first, the density,
///   is not above 0, nothing is kept
/// @return whether anything was kept
template <class Sample>
bool sample_voxels(const GridShape& shape, const BrickRegion& brick, std::span<float> values,
                   Sample at) {
  bool any = false;
  for (std::size_t i = 0; i < BrickMap::kBrickVoxels; ++i) {
    const auto offset = static_cast<int>(i);
    const Vec3i voxel = brick.first + Vec3i(offset >> 6, offset >> 3 & 7, offset & 7);
    const auto found = at(shape.centre(voxel));
    if (!(found[0] > 0)) continue;
    for (std::size_t field = 0; field < found.size(); ++field) {
      values[field * BrickMap::kBrickVoxels + i] = found[field];
    }
    any = true;
  }
  return any;
}

struct Sphere {
  Vec3f centre{0};
  float radius = 0;
};

/// The union of spheres as a distance: negative inside.
class SphereUnion {
 public:
  explicit SphereUnion(std::vector<Sphere> spheres) : spheres_(std::move(spheres)) {}

  float distance(const Vec3f& point) const;
  Box3f bounds() const;
  /// The spheres that the distance may come from at some point within `radius` of `centre`.
  SphereUnion near(const Vec3f& centre, float radius) const;
  /// Moves and scales all spheres: centre · scale + offset.
  void transform(float scale, const Vec3f& offset);

 private:
  std::vector<Sphere> spheres_;
};

/// Samples the voxels of a brick, for a shape that is made of spheres: see sample_voxels.
/// @param warp how far points are pushed before their distance to the spheres is taken [world]
/// @param outward how far the shape reaches beyond the spheres [world]
/// @param at (point of the world, the spheres that matter there) → values
template <class Sample>
bool sample_near(const SphereUnion& spheres, float warp, float outward, const GridShape& shape,
                 const BrickRegion& brick, std::span<float> values, Sample at) {
  const SphereUnion near = spheres.near(brick.centre, brick.radius + warp);
  if (near.distance(brick.centre) > brick.radius + outward + warp) return false;
  return sample_voxels(shape, brick, values, [&](const Vec3f& point) { return at(point, near); });
}

}  // namespace freepath::procedural
