// What stands before WorldBegin: the picture and how it is made.

#include <string>
#include <utility>

#include "freepath/scene/pbrt/nearest_name.h"
#include "freepath/scene/pbrt/scene_parser.h"

namespace freepath {

void SceneParser::warn_if_repeated(bool repeated, std::string_view directive,
                                   const SourceLocation& location) {
  if (!repeated) return;
  diagnostics_.warn(location,
                    fmt::format("{} is given more than once; the last one counts", directive));
}

void SceneParser::set_entity(std::optional<PbrtEntity>& entity, std::string_view directive,
                             const SourceLocation& location) {
  warn_if_repeated(entity.has_value(), directive, location);
  entity = expect_entity(directive, location);
}

void SceneParser::option(const SourceLocation& /*location*/) {
  scene_.options.add(parse_option(tokens_, context()));
}

void SceneParser::color_space(const SourceLocation& /*location*/) {
  const Token name = expect_string("the name of a colour space");
  const auto space = find_color_space(name.text);
  if (!space) {
    const std::string_view names[] = {name_of(ColorSpace::kSrgb), name_of(ColorSpace::kDciP3),
                                      name_of(ColorSpace::kRec2020),
                                      name_of(ColorSpace::kAces2065)};
    fail_at(tokens_.location(name), "there is no colour space {}{}", in_quotes(name.text),
            did_you_mean(name.text, names));
  }
  state_.color_space = *space;
}

void SceneParser::camera(const SourceLocation& location) {
  warn_if_repeated(scene_.camera.has_value(), "Camera", location);
  PbrtCamera camera{expect_entity("Camera", location), state_.transform, state_.outside_medium};
  coordinate_systems_["camera"] = state_.transform.inverse();
  scene_.camera = std::move(camera);
}

void SceneParser::film(const SourceLocation& location) {
  set_entity(scene_.film, "Film", location);
}

void SceneParser::sampler(const SourceLocation& location) {
  set_entity(scene_.sampler, "Sampler", location);
}

void SceneParser::pixel_filter(const SourceLocation& location) {
  set_entity(scene_.filter, "PixelFilter", location);
}

void SceneParser::integrator(const SourceLocation& location) {
  set_entity(scene_.integrator, "Integrator", location);
}

void SceneParser::accelerator(const SourceLocation& location) {
  set_entity(scene_.accelerator, "Accelerator", location);
}

void SceneParser::world_begin(const SourceLocation& /*location*/) {
  in_world_ = true;
  scene_.color_space = state_.color_space;
  state_.transform = {};
  state_.start_active = state_.end_active = true;
  coordinate_systems_["world"] = state_.transform;
}

}  // namespace freepath
