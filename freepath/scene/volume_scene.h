#pragma once
/// @file The scene of bare volumes: their medium, sun and sky around it, perhaps a ground.

#include <optional>

#include "freepath/paths/path_scene.h"
#include "freepath/scene/ground.h"
#include "freepath/scene/surroundings.h"
#include "freepath/scene/volume_medium.h"
#include "freepath/sensors/camera.h"

namespace freepath {

/// A scene of a medium that fills its own bounds, and of nothing else but the ground. Colours
/// become spectra as those of scenes do, and are as given where R, G and B are rendered.
/// @param camera none where fluxes alone are measured
/// @throws Error for a radiance that is negative or not finite, an albedo not in [0, 1], and as
///   to_scene_medium
PathScene make_volume_scene(const VolumeMedium& medium, const std::optional<Camera>& camera,
                            const Surroundings& surroundings,
                            const std::optional<Ground>& ground = {});

}  // namespace freepath
