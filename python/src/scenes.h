#pragma once
/// @file A scene as Python holds it.

#include <shared_mutex>

#include "freepath/scene/assembly/scene_builder.h"
#include "freepath/scene/surroundings.h"

namespace freepath::python {

/// A scene, built: of a pbrt file, or around a medium.
struct PythonScene {
  BuiltScene built;
  bool is_of_file = false;  ///< Whether it has settings of its own for its picture.
  /// Held by those who render; alone by one who has put another camera into the scene.
  mutable std::shared_mutex camera_gate;
};

}  // namespace freepath::python
