#pragma once
/// @file How much light the parts of an emissive medium give off.

#include <cstddef>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/media/medium.h"
#include "freepath/render/paths/scene_medium.h"

namespace freepath {

/// The box that a medium's walks take place in, cut into cells along its axes, which may stand
/// anyhow in the world.
struct EmissionCells {
  AffineMap world_to_grid;  ///< World, relative to the origin → grid, whose cells have edge 1.
  AffineMap grid_to_world;
  Vec3i counts{0};  ///< Cells along each axis; 0 where nothing emits.
  /// Estimated mean of Σ_k ρ_k σ_a,k L_k over a cell and the channels [radiance/m], x slowest. 0
  /// only where nothing can be emitted.
  std::vector<float> power;

  std::size_t index(const Vec3i& cell) const {
    return (static_cast<std::size_t>(cell.x) * counts.y + cell.y) * counts.z + cell.z;
  }
  double cell_volume() const;  ///< [m³, world]
};

/// The point that a map takes a point to.
inline Vec3f apply(const AffineMap& map, const Vec3f& point) {
  Vec3f result(map.offset[0], map.offset[1], map.offset[2]);
  for (int from = 0; from < 3; ++from) {
    for (int to = 0; to < 3; ++to) result[to] += point[from] * map.linear[from][to];
  }
  return result;
}

/// Evaluates emission at a few points of each cell. A cell's bounds decide whether it can emit, and
/// give it a little power however little the points found.
/// @param origin that positions are relative to [world]
/// @param resolution cells along the longest edge of the box, and no more than its voxels
EmissionCells estimate_emission(const BoundMedium& bound, const Vec3d& origin, int resolution);

}  // namespace freepath
