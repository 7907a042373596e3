#pragma once
/// @file The mappings that textures name, and where textures lie.

#include "freepath/materials/textures/texture_mapping.h"
#include "freepath/scene/assembly/build_context.h"

namespace freepath {

/// The mapping of a flat texture, by its parameter "mapping".
/// @throws Error with file:line:column if there is none of that name
TextureMapping texture_mapping(BuildContext& context, const PbrtTexture& texture);

/// The mapping of a texture that fills space.
SolidMapping solid_mapping(BuildContext& context, const PbrtTexture& texture);

/// The direction [world, unit] of a parameter in the texture's space.
/// @throws Error with file:line:column if it is no direction
Vec3f texture_direction(BuildContext& context, const PbrtTexture& texture, std::string_view name,
                        const Vec3d& otherwise);

}  // namespace freepath
