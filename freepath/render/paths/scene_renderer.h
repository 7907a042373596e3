#pragma once
/// @file Renders scenes of media, surfaces and lights.

#include "freepath/render/paths/path_colors.h"
#include "freepath/render/paths/path_scene.h"
#include "freepath/render/renderer.h"

namespace freepath {

/// Renders a scene. The picture depends on scene, colour mode, walk settings and sample count
/// alone.
/// @param settings the origin of its walk is that of the scene
/// @throws Error as `render`
RenderResult render_scene(const PathScene& scene, ColorMode mode, const RenderSettings& settings,
                          const ProgressFunction& progress = {});

}  // namespace freepath
