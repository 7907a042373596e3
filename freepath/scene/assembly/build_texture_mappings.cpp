#include "freepath/scene/assembly/build_texture_mappings.h"

#include <array>
#include <string>

#include "freepath/scene/pbrt/nearest_name.h"

namespace freepath {
namespace {

constexpr std::array<std::string_view, 4> kMappings = {"cylindrical", "planar", "spherical", "uv"};

Matrix4d world_from_texture(BuildContext& context, const PbrtTexture& texture) {
  if (texture.world_from_texture.is_animated()) {
    context.diagnostics.warn(texture.location,
                             "moving textures are not supported: this one stays as at the start");
  }
  return texture.world_from_texture.start;
}

Matrix4d texture_from_world(BuildContext& context, const PbrtTexture& texture) {
  return world_from_texture(context, texture).inverse();
}

}  // namespace

TextureMapping texture_mapping(BuildContext& context, const PbrtTexture& texture) {
  const ParameterList& list = texture.parameters;
  const std::string mapping = list.get_string("mapping", "uv");
  const auto number = [&list](std::string_view name, double otherwise) {
    return static_cast<float>(list.get_float(name, otherwise));
  };
  if (mapping == "uv") {
    return UvMapping{number("uscale", 1), number("vscale", 1), number("udelta", 0),
                     number("vdelta", 0)};
  }
  if (mapping == "planar") {
    return PlanarTextureMapping{texture_from_world(context, texture),
                                list.get_vector("v1", Vec3d(1, 0, 0)),
                                list.get_vector("v2", Vec3d(0, 1, 0)), list.get_float("udelta", 0),
                                list.get_float("vdelta", 0)};
  }
  if (mapping == "spherical") return SphericalTextureMapping{texture_from_world(context, texture)};
  if (mapping == "cylindrical")
    return CylindricalTextureMapping{texture_from_world(context, texture)};
  fail_at(list.location_of("mapping"), "there is no mapping {}{}", in_quotes(mapping),
          did_you_mean(mapping, kMappings));
}

SolidMapping solid_mapping(BuildContext& context, const PbrtTexture& texture) {
  return {texture_from_world(context, texture)};
}

Vec3f texture_direction(BuildContext& context, const PbrtTexture& texture, std::string_view name,
                        const Vec3d& otherwise) {
  const ParameterList& list = texture.parameters;
  const Vec3d given = list.get_vector(name, otherwise);
  Vec3d direction;
  world_from_texture(context, texture).multDirMatrix(given, direction);
  if (!(direction.length() > 0)) {
    fail_at(list.location_of(name), "parameter {} is 0, which is no direction", in_quotes(name));
  }
  return Vec3f(direction.normalized());
}

}  // namespace freepath
