#pragma once
/// @file The voxels of media that list them in their statement.

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "freepath/base/vector.h"
#include "freepath/media/field.h"
#include "freepath/scene/pbrt/parameter_list.h"

namespace freepath {

/// Where the voxels of a grid stand: nx x ny x nz of them fill the box from p0 to p1.
struct VoxelLayout {
  Vec3i counts;
  Matrix4d index_to_world;  ///< Transform of voxel centers.
  std::size_t voxels() const { return std::size_t(counts.x) * counts.y * counts.z; }
};

/// Reads nx, ny, nz, p0 and p1.
/// @throws Error that says what is wrong and where
VoxelLayout read_voxel_layout(const ParameterList& list, const Matrix4d& medium_to_world);

/// Checks that a parameter has a value for each voxel.
/// @throws Error if it has not
void check_voxel_count(const ParameterList& list, std::string_view name, std::size_t count,
                       const VoxelLayout& layout);

/// Reads the values of a parameter, x fastest, as a field.
/// @param field_name of the field
/// @throws Error for another count, or a value that is negative
std::shared_ptr<const Field> read_voxels(const ParameterList& list, const VoxelLayout& layout,
                                         std::string_view name, std::string field_name);

}  // namespace freepath
