#pragma once
/// @file How a scene is rendered: as its file says, unless someone else says otherwise.

#include <cstdint>
#include <optional>
#include <string>

#include "freepath/paths/renderer.h"
#include "freepath/scene/assembly/scene_builder.h"

namespace freepath {

/// What is said of a rendering from outside of a scene's file; what is not, the file decides.
struct RenderWishes {
  std::optional<uint32_t> samples;
  std::optional<uint64_t> seed;
  std::optional<uint32_t> max_scatterings;
  std::optional<std::string> tracker, transmittance;
  std::optional<Interpolation> interpolation;
  std::optional<Crop> crop;
  std::optional<LayerSet> layers;
};

/// What is wished of a rendering, else what the scene says, else what is standard.
/// @param settings all that is not wished for one by one
/// @throws Error for methods that do not exist
RenderSettings settle_settings(const BuiltScene& built, const RenderWishes& wishes,
                               RenderSettings settings);

}  // namespace freepath
