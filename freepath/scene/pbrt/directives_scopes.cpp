// Attributes and objects: what is saved, and what is restored.

#include <algorithm>
#include <utility>

#include "freepath/scene/pbrt/nearest_name.h"
#include "freepath/scene/pbrt/scene_parser.h"

namespace freepath {

std::string_view SceneParser::begin_of(Scope scope) {
  switch (scope) {
    case Scope::kAttribute:
      return "AttributeBegin";
    case Scope::kTransform:
      return "TransformBegin";
    default:
      return "ObjectBegin";
  }
}

std::string_view SceneParser::end_of(Scope scope) {
  switch (scope) {
    case Scope::kAttribute:
      return "AttributeEnd";
    case Scope::kTransform:
      return "TransformEnd";
    default:
      return "ObjectEnd";
  }
}

void SceneParser::open_scope(Scope scope, const SourceLocation& location) {
  if (static_cast<int>(scopes_.size()) >= limits_.attribute_depth) {
    fail_at(location, "attributes and objects stand more than {} deep in one another",
            limits_.attribute_depth);
  }
  scopes_.push_back({scope, location, state_});
}

void SceneParser::close_scope(Scope scope, const SourceLocation& location) {
  if (scopes_.size() <= scopes_outside_import_) {
    fail_at(location, "this {} has no {}", end_of(scope), begin_of(scope));
  }
  const OpenScope& open = scopes_.back();
  if (open.scope != scope) {
    fail_at(location, "expected {} for the {} in line {}, found {}", end_of(open.scope),
            begin_of(open.scope), open.location.line, end_of(scope));
  }
  state_ = std::move(scopes_.back().state);
  scopes_.pop_back();
}

void SceneParser::attribute_begin(const SourceLocation& location) {
  open_scope(Scope::kAttribute, location);
}

void SceneParser::attribute_end(const SourceLocation& location) {
  close_scope(Scope::kAttribute, location);
}

void SceneParser::warn_of_transform_scopes(const SourceLocation& location) {
  diagnostics_.warn(location,
                    "TransformBegin and TransformEnd are deprecated; as in pbrt-v4 they save and "
                    "restore all attributes, like AttributeBegin and AttributeEnd");
}

void SceneParser::transform_begin(const SourceLocation& location) {
  warn_of_transform_scopes(location);
  open_scope(Scope::kTransform, location);
}

void SceneParser::transform_end(const SourceLocation& location) {
  close_scope(Scope::kTransform, location);
}

void SceneParser::attribute(const SourceLocation& location) {
  const Token target = expect_string("what the attributes are for");
  const auto* const found = std::ranges::find(kAttributeTargets, target.text);
  if (found == kAttributeTargets.end()) {
    fail_at(tokens_.location(target),
            "Attribute is for shape, light, material, medium or texture, not {}{}",
            in_quotes(target.text), did_you_mean(target.text, kAttributeTargets));
  }
  const std::string owner = fmt::format("Attribute {}", in_quotes(target.text));
  const ParameterList given = expect_parameters(owner, location);
  auto& current = state_.attributes[static_cast<std::size_t>(found - kAttributeTargets.begin())];
  SharedParameters attributes = current == nullptr ? SharedParameters() : *current;
  for (const auto& parameter : given.own()) {
    std::erase_if(attributes, [&](const auto& old) { return old->name == parameter->name; });
    attributes.push_back(parameter);
    attribute_parameters_.push_back(parameter);
  }
  constexpr std::size_t kMostAttributes = 200;
  if (attributes.size() > kMostAttributes) {
    fail_at(location, "more than {} attributes are set for a {}", kMostAttributes, *found);
  }
  current = std::make_shared<const SharedParameters>(std::move(attributes));
}

void SceneParser::reverse_orientation(const SourceLocation& /*location*/) {
  state_.reverse_orientation = !state_.reverse_orientation;
}

void SceneParser::object_begin(const SourceLocation& location) {
  const Token name = expect_string("the name of an object");
  if (open_object_) {
    fail_at(location, "ObjectBegin stands inside another object, begun in line {}",
            scene_.objects[static_cast<std::size_t>(*open_object_)].location.line);
  }
  const int index = static_cast<int>(scene_.objects.size());
  define(object_names_, name, index, "object");
  open_scope(Scope::kObject, location);
  scene_.objects.push_back({name.text, location, {}});
  open_object_ = index;
}

void SceneParser::object_end(const SourceLocation& location) {
  close_scope(Scope::kObject, location);
  open_object_.reset();
}

void SceneParser::object_instance(const SourceLocation& location) {
  const Token name = expect_string("the name of an object");
  if (open_object_) fail_at(location, "ObjectInstance may not stand inside an object");
  scene_.instances.push_back({tokens_.location(name), 0, state_.transform});
  instance_objects_.push_back(name.text);
}

}  // namespace freepath
