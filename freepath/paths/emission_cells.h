#pragma once
/// @file How much light the parts of an emissive medium give off.

#include <cstddef>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/media/medium.h"
#include "freepath/paths/scene_medium.h"

namespace freepath {

/// A box of a medium, cut into cells along the axes of its walks, which may stand anyhow in the
/// world.
struct CellGrid {
  AffineMap world_to_grid;  ///< World, relative to the origin → grid, whose cells have edge 1.
  AffineMap grid_to_world;
  Vec3i counts{0};  ///< Cells along each axis.

  std::size_t size() const { return static_cast<std::size_t>(counts.x) * counts.y * counts.z; }
  /// Cells are stored x slowest.
  std::size_t index(const Vec3i& cell) const {
    return (static_cast<std::size_t>(cell.x) * counts.y + cell.y) * counts.z + cell.z;
  }
  Vec3i cell(std::size_t index) const {
    const auto number = static_cast<int>(index);  // divides much faster
    const int row = number / counts.z;
    return {row / counts.y, row % counts.y, number % counts.z};
  }
  double cell_volume() const;  ///< [m³, world]
};

/// What the parts of a medium emit.
struct EmissionCells {
  CellGrid grid;  ///< Grid over the box around all that can emit; no cells where nothing can.
  /// Estimated means of Σ_k ρ_k σ_a,k L_k over the cells and the channels [radiance/m]. 0 only
  /// where nothing can be emitted.
  std::vector<float> power;
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
/// @param most_cells and no more than one for each voxel
EmissionCells estimate_emission(const BoundMedium& bound, const Vec3d& origin, int most_cells);

}  // namespace freepath
