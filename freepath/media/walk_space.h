#pragma once
/// @file The space that a medium's walks take place in, common to components whose voxels stand
/// anyhow in the world.

#include <span>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/media/box_tree.h"
#include "freepath/media/field.h"

namespace freepath {

/// A grid of voxels over all components. A *position in a grid* counts voxels from its first: voxel
/// i covers the positions from i to i + 1 along each axis, and its centre is at i + 1/2.
struct WalkSpace {
  /// Whether all components have one transform, bit for bit, and one layout of bricks, or windows
  /// of one layout cut out of them: one position serves all.
  bool aligned = true;
  /// Whether the walk takes place in parts, each with windows of the components; else the grid is
  /// walked through as a whole, by the components' own indices.
  bool in_parts = false;
  Matrix4d index_to_world;  ///< Transform of the grid.
  Vec3i origin{0};          ///< Its first voxel [index].
  Vec3i voxel_counts{0};    ///< Number of voxels along each axis.
  /// Position in the grid → position in the voxels of each component.
  /// Composed in double precision without the way to the world's origin and back.
  std::vector<Matrix4d> to_component;

  /// What the voxels' active bounds cover [position in the grid].
  /// @param reach how far a voxel reaches from its centre [voxels]
  Box3d bounds(std::span<const Field* const> fields, double reach) const;
  /// What every brick of the fields covers, grown by one voxel, within the bounds of the active
  /// voxels that are [position in the grid].
  std::vector<GridBox> occupied(std::span<const Field* const> fields) const;
};

/// Gives fields that share one transform one layout of bricks as well, which makes walks through
/// them faster; leaves them as they are where their transforms differ, where an index is a list, or
/// where they lie so far apart that the index would hold little but nothing.
void share_layout(std::span<Field* const> fields);

/// The layout of the fields where they share one; else the index axes of the finest of them, over
/// all that the trilinear filter can reach.
/// @throws Error naming the grid: transforms that have no inverse where that is needed; fields so
///   far apart, or so long, that single precision cannot tell their voxels from each other
WalkSpace make_walk_space(std::span<const Field* const> fields);

/// Fails, naming the grids, if a part of the walk space is too long for single precision where
/// positions pass from one grid to another.
void check_part(const WalkSpace& space, const GridBox& box, std::span<const Field* const> fields);

}  // namespace freepath
