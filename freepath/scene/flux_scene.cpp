#include "freepath/scene/flux_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/scene/volume_scene.h"

namespace freepath {
namespace {

/// Distance of the voxels of a field along an axis [world].
double voxel_along(const Field& field, int axis) {
  const Matrix4d& m = field.index_to_world;
  return std::max({std::abs(m[0][axis]), std::abs(m[1][axis]), std::abs(m[2][axis])});
}

}  // namespace

FluxScene make_flux_scene(const VolumeMedium& medium, UpAxis up,
                          const std::optional<Ground>& ground, Interpolation interpolation) {
  const int along = up_index(up);
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == along || (medium.sides.axes[axis] && medium.sides.extents)) continue;
    fail("the medium has to repeat along {} for its fluxes to be known", "xyz"[axis]);
  }
  const bool reflects = ground && largest(ground->albedo) > 0;
  PathScene scene = make_volume_scene(medium, {}, {}, reflects ? ground : std::optional<Ground>());
  const SceneMedium& filling = scene.media[0];
  Box3d box = interpolation == Interpolation::kNearest ? filling.bounds() : filling.outer_bounds();
  if (ground) {
    const double height = height_under(filling.bounds(), *ground);
    if (height > filling.bounds().min[along]) {
      fail("the ground at {:.6g} lies above the bottom of the medium, {:.6g}", height,
           filling.bounds().min[along]);
    }
    box.min[along] = std::min(box.min[along], height);
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == along) continue;
    box.min[axis] = medium.sides.extents->min[axis];
    box.max[axis] = medium.sides.extents->max[axis];
  }
  const Box3d relative(box.min - scene.origin, box.max - scene.origin);
  scene.domain.emplace(relative, medium.sides.axes);
  FluxMeter meter(relative, along, true);
  const Field& field = *medium.medium->components()[0].density;
  int side = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == along) continue;
    const double voxels = box.size()[axis] / voxel_along(field, axis);
    meter.counts[side++] = static_cast<uint32_t>(std::max(1.0, std::round(voxels)));
  }
  return {std::move(scene), std::move(meter), box};
}

}  // namespace freepath
