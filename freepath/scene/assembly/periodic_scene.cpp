#include "freepath/scene/assembly/periodic_scene.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/scene/assembly/build_shapes.h"

namespace freepath {
namespace {

/// The faces of the voxels of all media, or what stands in the scene where there are none.
Box3d period_of(const PathScene& scene, const Box3d& standing) {
  Box3d box;
  for (const SceneMedium& medium : scene.media) {
    if (!medium.is_homogeneous()) box.extendBy(medium.bounds());
  }
  return box.isEmpty() ? standing : box;
}

/// A box with the extents of the domain along the axes that repeat.
Box3d along_domain(Box3d box, const PeriodicSides& sides) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!sides.axes[axis]) continue;
    box.min[axis] = sides.extents->min[axis];
    box.max[axis] = sides.extents->max[axis];
  }
  return box;
}

/// Boundaries that rays still have to meet have to do so within the sides: the media on both sides
/// of a side are the same.
void check_boundaries(const PathScene& scene, const SurfaceScene& surfaces,
                      const PeriodicSides& sides) {
  const auto changes = [&](const SurfaceShape& shape) {
    return scene.shapes[shape.shape].inside != scene.shapes[shape.shape].outside;
  };
  SurfaceScene boundaries = surfaces;
  std::erase_if(boundaries.shapes, [&](const SurfaceShape& shape) { return !changes(shape); });
  for (auto& group : boundaries.groups) {
    std::erase_if(group, [&](const SurfaceShape& shape) { return !changes(shape); });
  }
  std::erase_if(boundaries.instances, [&](const SurfaceInstance& instance) {
    return boundaries.groups[instance.group].empty();
  });
  const Box3d extent = extent_of(boundaries);
  if (extent.isEmpty()) return;
  const Vec3d camera = scene.camera->position();
  for (int axis = 0; axis < 3; ++axis) {
    if (!sides.axes[axis]) continue;
    const double low = sides.extents->min[axis];
    const double high = sides.extents->max[axis];
    if (extent.min[axis] <= low || extent.max[axis] >= high) {
      fail(
          "a medium ends at a boundary that reaches from {:.6g} to {:.6g} along {}, to the sides "
          "of the domain from {:.6g} to {:.6g}: to repeat, it has to end within them, or fill a "
          "boundary that is a box, or lies around all of its voxels and half of one more",
          extent.min[axis], extent.max[axis], "xyz"[axis], low, high);
    }
    if (camera[axis] < low || camera[axis] > high) {
      fail(
          "the camera stands at {:.6g} along {}, beside the domain from {:.6g} to {:.6g}: put it "
          "into that period, where it is known which media are around it",
          camera[axis], "xyz"[axis], low, high);
    }
  }
}

}  // namespace

void make_periodic(PathScene& scene, PeriodicSides sides, const Box3d& standing,
                   const SurfaceScene& surfaces, int super_voxel) {
  if (!sides.extents) sides.extents = period_of(scene, standing);
  if (sides.extents->isEmpty()) {
    fail("nothing in the scene has bounds that could repeat: give the extents by --domain");
  }
  check_boundaries(scene, surfaces, sides);
  Box3d box = extent_of(surfaces);
  std::vector<uint32_t> shapes(scene.shapes.size());
  std::iota(shapes.begin(), shapes.end(), 0U);
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    SceneMedium& medium = scene.media[i];
    // One that is bounded by surfaces alone ends where they stand.
    const bool has_end = !medium.is_homogeneous() || !scene.has_boundary(static_cast<MediumId>(i));
    if (has_end) box.extendBy(medium.outer_bounds());
    medium = repeated(medium, sides, super_voxel);
    // Its voxels at the other side may lie where surfaces are.
    if (scene.surfaces && scene.is_clear[i]) {
      scene.is_clear[i] = !scene.surfaces->intersects_box(
          shapes, OrientedBox(along_domain(medium.bounds(), sides)));
    }
  }
  box = along_domain(box, sides);
  scene.domain = PeriodicDomain(Box3d(box.min - scene.origin, box.max - scene.origin), sides.axes);
}

void check_lights_of_domain(const SceneLightsDescription& lights) {
  const auto refuse = [](const std::string& name, const char* what) {
    fail(
        "{}: a light that {}: what repeats can have light from afar only (infinite, distant, the "
        "sun)",
        name, what);
  };
  if (!lights.area_lights.empty()) {
    refuse(lights.emissions[lights.area_lights[0].emission].name, "stands in the scene");
  }
  for (const LightDescription& light : lights.lights) {
    std::visit(
        [&](const auto& one) {
          using Light = std::decay_t<decltype(one)>;
          if constexpr (std::is_same_v<Light, ConstantInfiniteLight> ||
                        std::is_same_v<Light, ImageInfiniteLight>) {
            if (one.portal) refuse(one.name, "has a portal");
          } else if constexpr (!std::is_same_v<Light, EnvironmentLight> &&
                               !std::is_same_v<Light, SunLight> &&
                               !std::is_same_v<Light, DistantLight>) {
            refuse(one.name, "stands in the scene");
          }
        },
        light);
  }
}

}  // namespace freepath
