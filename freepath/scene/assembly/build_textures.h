#pragma once
/// @file Textures of a scene.

#include "freepath/scene/assembly/build_context.h"

namespace freepath {

/// Fills PathScene::textures and the names of textures in the context. A spectrum texture whose
/// colours something takes as reflectances and something else as the index of a metal is built for
/// each.
/// @throws Error with file:line:column
void build_textures(BuildContext& context);

}  // namespace freepath
