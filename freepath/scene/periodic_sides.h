#pragma once
/// @file Volumes that repeat sideways.

#include <array>
#include <optional>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/paths/scene_medium.h"
#include "freepath/scene/volume.h"

namespace freepath {

/// Along which axes volumes repeat, and how long a period is.
struct PeriodicSides {
  std::array<bool, 3> axes{};
  /// Extents along the axes that repeat [world]; none: the bounds of all voxels
  /// together, or of all else where there are none.
  std::optional<Box3d> extents = {};

  /// Whether any axis repeats.
  bool any() const { return axes[0] || axes[1] || axes[2]; }
};

/// Makes voxels at one side of the domain know those at the other, as filters between them need:
/// one more layer of them, of values of the opposite side.
/// @param volumes of voxels, whose temperatures are treated alike
/// @return the domain; what it is along other axes has no meaning
/// @throws Error naming grid and axis: a transform that is not parallel to an axis that repeats,
///   voxels beyond the domain, a period that is no whole number of those that touch its sides
Box3d repeat_sides(std::vector<Volume>& volumes, const PeriodicSides& sides);

/// A medium whose voxels at one side of the domain know those at the other (repeat_sides). One
/// without voxels stays as it is; one that ends at the faces of its voxels does so where these
/// touch one side alone.
/// @param sides with extents
/// @param super_voxel edge of the super-voxels [voxels], 0 for automatic
/// @throws Error as repeat_sides
SceneMedium repeated(const SceneMedium& medium, const PeriodicSides& sides, int super_voxel);

}  // namespace freepath
