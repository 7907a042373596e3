#pragma once
/// @file The parts of a medium that walks take place in one after the other.

#include <cstddef>
#include <span>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/media/box_tree.h"
#include "freepath/media/brick_map.h"
#include "freepath/media/super_voxels.h"
#include "freepath/media/walk_space.h"

namespace freepath {

/// A box of a walk space with super-voxels and windows of its own, so that time and memory of a
/// medium follow its voxels and not the box around them. Most media are one part.
struct WalkPart {
  GridBox box;     ///< What of the medium it holds; parts are disjoint [position in walk space].
  Vec3i first{0};  ///< First voxel of its grid, counted from the walk space's.
  SuperVoxels cells;
  std::size_t first_record = 0;      ///< Where its cells begin in Medium::walk_cells().
  std::vector<BrickWindow> windows;  ///< What it reads of each component's voxels.

  /// The part's point in the middle [position in walk space].
  Vec3d middle() const { return (Vec3d(box.begin) + Vec3d(box.end)) / 2; }
  std::size_t memory_bytes() const;
};

/// Position in the part's grid → position in a window of a field, both counted from their first
/// voxels.
/// @param grid_to_field position in walk space → position in the field's map
Matrix4d to_window(const WalkPart& part, const Matrix4d& grid_to_field, const BrickMap& map,
                   const BrickWindow& window);

/// The window of a field that a box of walk space can read: the map's own index, or what is cut
/// out of one that is a list of bricks.
/// @param grid_to_field position in walk space → position in the field's map
BrickWindow window_of(const BrickMap& map, const GridBox& box, const Matrix4d& grid_to_field);

/// The parts of a medium of voxels.
struct WalkParts {
  std::vector<WalkPart> parts;
  BoxTree tree;  ///< Its leaves are the parts; empty where the walk space is walked as a whole.
};

/// @param extinction,cell_size as build_super_voxels
WalkParts make_walk_parts(const WalkSpace& space, std::span<const Field* const> fields,
                          std::span<const float> extinction, int cell_size);

}  // namespace freepath
