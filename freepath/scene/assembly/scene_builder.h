#pragma once
/// @file From the description of a scene to what is rendered.

#include <filesystem>
#include <memory>
#include <vector>

#include "freepath/io/invalid_values.h"
#include "freepath/paths/path_scene.h"
#include "freepath/scene/assembly/build_camera.h"
#include "freepath/scene/pbrt/diagnostics.h"
#include "freepath/scene/pbrt/scene.h"

namespace freepath {

/// A scene, and how its file wants it rendered.
struct BuiltScene {
  PathScene scene;
  PictureSettings picture;
  /// All that were read: the scene's text, what it includes, and what its statements name.
  std::vector<std::filesystem::path> files = {};
};

/// Builds a scene. Every parameter that is not understood is named in `diagnostics`.
/// @throws Error, beginning with file:line:column, for what cannot be rendered
BuiltScene build_scene(const PbrtScene& pbrt, Diagnostics& diagnostics,
                       const BuildOptions& options = {});

/// Parses and builds the scene of a file.
BuiltScene load_scene(const std::filesystem::path& file, Diagnostics& diagnostics,
                      const BuildOptions& options = {});

}  // namespace freepath
