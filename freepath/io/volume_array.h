#pragma once
/// @file Fields from dense arrays in memory.

#include <array>
#include <cstddef>
#include <string>

#include "freepath/base/vector.h"
#include "freepath/io/volume.h"

namespace freepath {

/// Values of a dense grid, borrowed: that of voxel (i, j, k) is
/// values[i · strides[0] + j · strides[1] + k · strides[2]].
template <class Real>
struct VoxelArray {
  const Real* values = nullptr;
  std::array<std::size_t, 3> counts{};  ///< Voxels along x, y and z.
  /// Step from one voxel to the next along each axis [values].
  std::array<std::ptrdiff_t, 3> strides{};
};

/// Copies an array into a field whose voxels are all active, from voxel (0, 0, 0) on. Bricks of one
/// value are stored once.
/// @param name of the field, for messages too
/// @param index_to_world affine; the centre of voxel (i, j, k) is the index point (i, j, k)
/// @param options what to do about values that are negative, NaN or infinite
/// @throws Error, naming the voxel, for such values; for an empty array, more voxels than memory
///   or a brick map may hold, and a transform that is not finite or has no inverse
LoadedField field_from_array(const VoxelArray<float>& array, const std::string& name,
                             const Matrix4d& index_to_world, const LoadOptions& options = {});
LoadedField field_from_array(const VoxelArray<double>& array, const std::string& name,
                             const Matrix4d& index_to_world, const LoadOptions& options = {});

/// Copies the voxels in the bounds of the active ones, z fastest: the inverse of field_from_array.
/// @param values room for all of them
void copy_voxels(const BrickMap& map, float* values);

}  // namespace freepath
