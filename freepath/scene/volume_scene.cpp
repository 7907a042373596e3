#include "freepath/scene/volume_scene.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "freepath/geometry/surfaces.h"
#include "freepath/spectra/rgb_color_space.h"

namespace freepath {
namespace {

PeriodicDomain make_domain(const PeriodicSides& sides, const PathScene& scene,
                           const std::optional<Ground>& ground) {
  Box3d box = scene.media[0].outer_bounds();
  if (ground) {
    const double height = height_under(scene.media[0].bounds(), *ground);
    const int up = up_index(ground->up);
    box.min[up] = std::min(box.min[up], height);
    box.max[up] = std::max(box.max[up], height);
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!sides.axes[axis]) continue;
    box.min[axis] = sides.extents->min[axis];
    box.max[axis] = sides.extents->max[axis];
  }
  return {Box3d(box.min - scene.origin, box.max - scene.origin), sides.axes};
}

}  // namespace

PathScene make_volume_scene(const VolumeMedium& medium, const std::optional<Camera>& camera,
                            const Surroundings& surroundings, const std::optional<Ground>& ground) {
  PathScene scene;
  scene.spectra = std::make_unique<SpectrumTable>(rgb_color_space("srgb"));
  scene.media.push_back(to_scene_medium(medium, *scene.spectra));
  scene.is_clear = {true};
  scene.camera_media.add(0, 1);
  scene.camera = camera;
  scene.filter = PixelFilter(BoxFilter());
  scene.origin = medium.medium->world_bounds().center();
  SceneLightsDescription lights;
  lights.origin = scene.origin;
  lights.lights = to_lights(surroundings, *scene.spectra);
  scene.lights.emplace(std::move(lights), *scene.spectra);
  if (ground) {
    const Box3d& bounds = scene.media[0].bounds();
    SurfaceScene surfaces;
    add_ground(*ground, bounds, camera ? camera->position() : bounds.center(), scene, surfaces);
    scene.surfaces.emplace(surfaces, scene.origin);
    scene.is_clear[0] =
        !scene.surfaces->intersects_box(std::vector<uint32_t>{0}, OrientedBox(bounds));
  }
  if (medium.sides.extents) scene.domain = make_domain(medium.sides, scene, ground);
  return scene;
}

}  // namespace freepath
