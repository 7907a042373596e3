#pragma once
/// @file Grids in the frustum of a camera, whose voxels grow with their distance: resampled to
/// voxels of one size.

#include <optional>
#include <string>
#include <vector>

#include "freepath/io/volume.h"

namespace freepath::io {

/// The map of OpenVDB's NonlinearFrustumMap: planes of one z in index space stay planes, and their
/// voxels' edges grow linearly with z; then an affine map.
struct FrustumMap {
  Vec3d origin;  ///< The index point that is 0 in the frustum's space.
  double width =
      1;  ///< Voxels across the plane at the origin, which is 1 wide in the frustum's space.
  double step = 1;    ///< Distance of neighbouring planes in the frustum's space.
  double growth = 0;  ///< Growth of the planes' width by unit of z.
  Matrix4d frustum_to_world;

  /// Edge of a voxel in x and y at a depth; not positive behind the camera.
  double edge(double z) const { return (growth * z + 1) / width; }
  Vec3d to_frustum(const Vec3d& index) const {
    const Vec3d inside = index - origin;
    const double z = inside.z * step;
    return {inside.x * edge(z), inside.y * edge(z), z};
  }
  /// Nothing behind the camera.
  std::optional<Vec3d> to_index(const Vec3d& point) const {
    const double size = edge(point.z);
    if (!(size > 0)) return std::nullopt;
    return origin + Vec3d(point.x / size, point.y / size, point.z / step);
  }
};

/// Replaces fields in the index space of a frustum by ones whose voxels all have the size of those
/// at its near end (larger if that makes too many), planes in z staying where they are. A warning
/// says how many voxels that makes, and the largest difference of the interpolants at 4096 points.
/// @param label the beginning of the warning
void resample_frustum(const std::string& label, const FrustumMap& map,
                      std::vector<LoadedField>& fields);

}  // namespace freepath::io
