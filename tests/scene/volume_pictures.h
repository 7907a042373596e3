#pragma once
/// @file Rendering a bare medium in a test.

#include <memory>
#include <utility>

#include "freepath/paths/renderer.h"
#include "freepath/scene/volume_scene.h"
#include "freepath/sensors/framing.h"

namespace freepath::testing {

/// The scene of a medium alone.
inline PathScene scene_of(const Medium& medium, const Camera& camera,
                          const Surroundings& surroundings) {
  return make_volume_scene({std::make_shared<const Medium>(medium)}, camera, surroundings);
}

/// Renders a medium in R, G and B.
inline RenderResult render(const Medium& medium, const Camera& camera,
                           const Surroundings& surroundings, const RenderSettings& settings,
                           const ProgressFunction& progress = {}) {
  return render_scene(scene_of(medium, camera, surroundings), ColorMode::kRgb, settings, progress);
}

}  // namespace freepath::testing
