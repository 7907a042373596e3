#include "freepath/scene/volume_scene.h"

#include <memory>
#include <vector>

#include "freepath/geometry/surfaces.h"
#include "freepath/spectra/rgb_color_space.h"

namespace freepath {

PathScene make_volume_scene(const VolumeMedium& medium, const Camera& camera,
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
    add_ground(*ground, bounds, camera.place(), scene, surfaces);
    scene.surfaces.emplace(surfaces, scene.origin);
    scene.is_clear[0] = !scene.surfaces->intersects_box(std::vector<uint32_t>{0}, bounds);
  }
  return scene;
}

}  // namespace freepath
