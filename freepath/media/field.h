#pragma once
/// @file A scalar field read from a file or made by a program: voxels in a brick map, and where
/// they stand in the world.

#include <memory>
#include <string>

#include "freepath/base/vector.h"
#include "freepath/media/brick_map.h"

namespace freepath {

struct DensityFunction;

/// A scalar density field.
struct Field {
  std::string name;           ///< Name of the grid, for messages.
  BrickMap voxels;            ///< Values; 0 outside.
  Matrix4d index_to_world{};  ///< Affine; the centre of voxel (i,j,k) is the index point (i,j,k).
  /// Computes the density in place of the voxels, if set; see make_function_field().
  std::shared_ptr<const DensityFunction> function{};
};

}  // namespace freepath
