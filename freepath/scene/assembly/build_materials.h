#pragma once
/// @file Materials of a scene.

#include "freepath/scene/assembly/build_context.h"

namespace freepath {

/// Fills PathScene::materials with one material for each of PbrtScene::materials that is no
/// `interface`, in their order, and BuildContext::materials with where they are. To be called after
/// build_textures.
/// @throws Error with file:line:column
void build_materials(BuildContext& context);

}  // namespace freepath
