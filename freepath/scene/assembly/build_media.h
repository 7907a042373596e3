#pragma once
/// @file From the media of a description to those that are rendered.

#include "freepath/scene/assembly/build_context.h"

namespace freepath {

/// Which media a description names, numbered in its order: BuildContext::media.
void name_media(BuildContext& context);

/// The medium of a name; vacuum for the empty one.
MediumId medium_of(const BuildContext& context, const std::string& name);

/// Builds PathScene::media.
/// @param extent what a medium without bounds has to fill, at least [world]
/// @throws Error with file:line:column
void build_media(BuildContext& context, const Box3d& extent);

}  // namespace freepath
