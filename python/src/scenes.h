#pragma once
/// @file A scene as Python holds it.

#include <optional>

#include "freepath/scene/assembly/scene_builder.h"
#include "freepath/scene/surroundings.h"

namespace freepath::python {

/// A scene, built: of a pbrt file, or around a medium.
struct PythonScene {
  BuiltScene built;
  bool is_of_file = false;  ///< Whether it has settings of its own for its picture.
};

}  // namespace freepath::python
