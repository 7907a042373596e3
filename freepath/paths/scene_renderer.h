#pragma once
/// @file Renders scenes of media, surfaces and lights.

#include <string>

#include "freepath/paths/path_colors.h"
#include "freepath/paths/path_scene.h"
#include "freepath/paths/renderer.h"

namespace freepath {

/// The tracker for a scene where nobody names one. A path for each channel has less variance in
/// clouds of colour, one path for all costs less where surfaces take most of the time.
std::string standard_tracker(const PathScene& scene);

/// Renders a scene. The picture depends on scene, colour mode, walk settings and sample count
/// alone.
/// @param settings the origin of its walk is that of the scene
/// @throws Error as `render`
RenderResult render_scene(const PathScene& scene, ColorMode mode, const RenderSettings& settings,
                          const ProgressFunction& progress = {});

}  // namespace freepath
