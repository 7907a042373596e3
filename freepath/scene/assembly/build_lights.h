#pragma once
/// @file From the lights of a description to those that are rendered.

#include "freepath/lights/light_descriptions.h"
#include "freepath/scene/assembly/build_context.h"

namespace freepath {

/// All lights but those of shapes.
/// @throws Error with file:line:column
std::vector<LightDescription> build_lights(BuildContext& context);

/// The emission of an area light.
/// @throws Error with file:line:column
AreaEmission build_emission(BuildContext& context, const PbrtAreaLight& light);

}  // namespace freepath
