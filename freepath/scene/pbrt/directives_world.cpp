// What stands after WorldBegin: materials, textures, media, lights and shapes.

#include <utility>

#include "freepath/scene/pbrt/scene_parser.h"

namespace freepath {

void SceneParser::define(std::map<std::string, int, std::less<>>& names, const Token& name,
                         int index, std::string_view what) {
  if (names.emplace(name.text, index).second) return;
  fail_at(tokens_.location(name), "{} {} is defined already", what, in_quotes(name.text));
}

PbrtEntity SceneParser::expect_typed_parameters(const std::string& owner,
                                                const SourceLocation& location,
                                                AttributeTarget target) {
  PbrtEntity entity{{}, location, expect_parameters(owner, location, target)};
  entity.type = entity.parameters.get_string("type", "");
  if (entity.type.empty()) fail_at(location, "{} needs a parameter \"string type\"", owner);
  return entity;
}

void SceneParser::make_named_material(const SourceLocation& location) {
  const Token name = expect_string("the name of a material");
  define(material_names_, name, static_cast<int>(scene_.materials.size()), "material");
  const std::string owner = fmt::format("material {}", in_quotes(name.text));
  scene_.materials.push_back(
      {expect_typed_parameters(owner, location, AttributeTarget::kMaterial), name.text});
}

void SceneParser::named_material(const SourceLocation& /*location*/) {
  const Token name = expect_string("the name of a material");
  material_references_.push_back({name.text, tokens_.location(name)});
  state_.named_material = name.text;
}

void SceneParser::material(const SourceLocation& location) {
  PbrtMaterial material{expect_entity("Material", location, AttributeTarget::kMaterial), {}};
  state_.material = static_cast<int>(scene_.materials.size());
  state_.named_material.clear();
  scene_.materials.push_back(std::move(material));
}

void SceneParser::texture(const SourceLocation& location) {
  const Token name = expect_string("the name of a texture");
  const Token kind = expect_string("float or spectrum, the kind of a texture,");
  if (kind.text != "float" && kind.text != "spectrum") {
    fail_at(tokens_.location(kind), "a texture is of kind float or spectrum, not {}",
            in_quotes(kind.text));
  }
  const bool is_float = kind.text == "float";
  define(is_float ? float_texture_names_ : spectrum_texture_names_, name,
         static_cast<int>(scene_.textures.size()), is_float ? "float texture" : "spectrum texture");
  PbrtTexture texture{expect_entity("Texture", location, AttributeTarget::kTexture), name.text,
                      is_float ? PbrtTextureKind::kFloat : PbrtTextureKind::kSpectrum,
                      state_.transform};
  scene_.textures.push_back(std::move(texture));
}

void SceneParser::make_named_medium(const SourceLocation& location) {
  const Token name = expect_string("the name of a medium");
  define(medium_names_, name, static_cast<int>(scene_.media.size()), "medium");
  const std::string owner = fmt::format("medium {}", in_quotes(name.text));
  scene_.media.push_back({expect_typed_parameters(owner, location, AttributeTarget::kMedium),
                          name.text, state_.transform});
}

void SceneParser::medium_interface(const SourceLocation& /*location*/) {
  const auto expect_medium = [&] {
    const Token name = expect_string("the name of a medium");
    // An empty name is vacuum.
    if (!name.text.empty()) medium_references_.push_back({name.text, tokens_.location(name)});
    return name.text;
  };
  state_.inside_medium = expect_medium();
  const bool has_outside = tokens_.peek().kind == TokenKind::kString;
  state_.outside_medium = has_outside ? expect_medium() : state_.inside_medium;
}

void SceneParser::light_source(const SourceLocation& location) {
  PbrtLight light{expect_entity("LightSource", location, AttributeTarget::kLight), state_.transform,
                  state_.outside_medium};
  scene_.lights.push_back(std::move(light));
}

void SceneParser::area_light_source(const SourceLocation& location) {
  PbrtAreaLight light = expect_entity("AreaLightSource", location, AttributeTarget::kLight);
  state_.area_light = static_cast<int>(scene_.area_lights.size());
  scene_.area_lights.push_back(std::move(light));
}

void SceneParser::shape(const SourceLocation& location) {
  PbrtShape shape;
  static_cast<PbrtEntity&>(shape) = expect_entity("Shape", location, AttributeTarget::kShape);
  shape.world_from_object = state_.transform;
  shape.reverse_orientation = state_.reverse_orientation;
  shape.material = state_.material;
  shape.area_light = state_.area_light;
  shape.inside_medium = state_.inside_medium;
  shape.outside_medium = state_.outside_medium;
  shape.object = open_object_;
  if (open_object_) {
    PbrtObject& object = scene_.objects[static_cast<std::size_t>(*open_object_)];
    object.shapes.push_back(static_cast<int>(scene_.shapes.size()));
  }
  scene_.shapes.push_back(std::move(shape));
  shape_materials_.push_back(state_.named_material);
}

}  // namespace freepath
