#include "freepath/scene/pbrt/scene_parser.h"

#include <algorithm>
#include <utility>

#include "freepath/scene/pbrt/nearest_name.h"
#include "freepath/scene/pbrt/source_text.h"

namespace freepath {

const std::vector<SceneParser::DirectiveInfo>& SceneParser::directives() {
  using P = SceneParser;
  static const std::vector<DirectiveInfo> kDirectives = {
      {"Accelerator", &P::accelerator, Phase::kOptions},
      {"ActiveTransform", &P::active_transform, Phase::kAny},
      {"AreaLightSource", &P::area_light_source, Phase::kWorld},
      {"Attribute", &P::attribute, Phase::kAny},
      {"AttributeBegin", &P::attribute_begin, Phase::kWorld},
      {"AttributeEnd", &P::attribute_end, Phase::kWorld},
      {"Camera", &P::camera, Phase::kOptions},
      {"ColorSpace", &P::color_space, Phase::kAny},
      {"ConcatTransform", &P::concat_transform, Phase::kAny},
      {"CoordSysTransform", &P::coord_sys_transform, Phase::kAny},
      {"CoordinateSystem", &P::coordinate_system, Phase::kAny},
      {"Film", &P::film, Phase::kOptions},
      {"Identity", &P::identity, Phase::kAny},
      {"Import", &P::import_file, Phase::kWorld},
      {"Include", &P::include_file, Phase::kAny},
      {"Integrator", &P::integrator, Phase::kOptions},
      {"LightSource", &P::light_source, Phase::kWorld},
      {"LookAt", &P::look_at_point, Phase::kAny},
      {"MakeNamedMaterial", &P::make_named_material, Phase::kWorld},
      {"MakeNamedMedium", &P::make_named_medium, Phase::kAny},
      {"Material", &P::material, Phase::kWorld},
      {"MediumInterface", &P::medium_interface, Phase::kAny},
      {"NamedMaterial", &P::named_material, Phase::kWorld},
      {"ObjectBegin", &P::object_begin, Phase::kWorld},
      {"ObjectEnd", &P::object_end, Phase::kWorld},
      {"ObjectInstance", &P::object_instance, Phase::kWorld},
      {"Option", &P::option, Phase::kOptions},
      {"PixelFilter", &P::pixel_filter, Phase::kOptions},
      {"ReverseOrientation", &P::reverse_orientation, Phase::kWorld},
      {"Rotate", &P::rotate, Phase::kAny},
      {"Sampler", &P::sampler, Phase::kOptions},
      {"Scale", &P::scale, Phase::kAny},
      {"Shape", &P::shape, Phase::kWorld},
      {"Texture", &P::texture, Phase::kWorld},
      {"Transform", &P::transform, Phase::kAny},
      {"TransformBegin", &P::transform_begin, Phase::kWorld},
      {"TransformEnd", &P::transform_end, Phase::kWorld},
      {"TransformTimes", &P::transform_times, Phase::kOptions},
      {"Translate", &P::translate, Phase::kAny},
      {"WorldBegin", &P::world_begin, Phase::kOptions},
  };
  return kDirectives;
}

PbrtScene SceneParser::parse(std::string text, const std::string& name) {
  scene_.file = name;
  tokens_.open(name, std::move(text));
  const SourceLocation start = tokens_.location(Token{});
  scene_.options = ParameterList("Option", start);
  PbrtMaterial standard;
  standard.type = "diffuse";
  standard.location = start;
  standard.parameters = ParameterList("Material 'diffuse'", start);
  scene_.materials.push_back(standard);
  parse_directives();
  const SourceLocation end = tokens_.location(tokens_.peek());
  if (!scopes_.empty()) {
    const OpenScope& open = scopes_.back();
    fail_at(open.location, "this {} is never closed", begin_of(open.scope));
  }
  if (!in_world_) fail_at(end, "the scene has no WorldBegin");
  resolve_references();
  return std::move(scene_);
}

void SceneParser::parse_directives() {
  while (tokens_.peek().kind != TokenKind::kEnd) {
    tokens_.free_finished();
    const Token token = tokens_.next();
    run_directive(token, tokens_.location(token));
  }
}

void SceneParser::run_directive(const Token& token, const SourceLocation& location) {
  if (token.kind != TokenKind::kWord) {
    fail_at(location, "expected a directive, found {}", describe(token));
  }
  const auto& known = directives();
  const auto info = std::ranges::find(known, token.source, &DirectiveInfo::name);
  if (info == known.end()) {
    std::vector<std::string_view> names;
    names.reserve(known.size());
    for (const DirectiveInfo& each : known) names.push_back(each.name);
    fail_at(location, "there is no directive {}{}", in_quotes(token.source),
            did_you_mean(token.source, names));
  }
  if (info->phase == Phase::kOptions && in_world_) {
    fail_at(location, "{} must stand before WorldBegin", info->name);
  }
  if (info->phase == Phase::kWorld && !in_world_) {
    fail_at(location, "{} must stand after WorldBegin", info->name);
  }
  (this->*info->run)(location);
}

Token SceneParser::expect_string(std::string_view what) {
  Token token = tokens_.next();
  if (token.kind == TokenKind::kString) return token;
  fail_at(tokens_.location(token), "expected {} as a string, found {}", what, describe(token));
}

double SceneParser::expect_number(std::string_view what) {
  const Token token = tokens_.next();
  if (token.kind == TokenKind::kNumber) return token.number;
  fail_at(tokens_.location(token), "expected {}, found {}", what, describe(token));
}

void SceneParser::expect_numbers(double* numbers, int count, std::string_view what) {
  // Some exporters put the numbers of any transform into brackets.
  const bool bracketed = tokens_.peek().kind == TokenKind::kOpenBracket;
  if (bracketed) tokens_.next();
  for (int i = 0; i < count; ++i) {
    const Token token = tokens_.next();
    if (token.kind != TokenKind::kNumber) {
      fail_at(tokens_.location(token), "expected number {} of the {} of {}, found {}", i + 1, count,
              what, describe(token));
    }
    numbers[i] = token.number;
  }
  if (!bracketed) return;
  const Token close = tokens_.next();
  if (close.kind != TokenKind::kCloseBracket) {
    fail_at(tokens_.location(close), "expected ']' after the {} numbers of {}, found {}", count,
            what, describe(close));
  }
}

Vec3d SceneParser::expect_vector(std::string_view what) {
  double numbers[3] = {};
  expect_numbers(numbers, 3, what);
  return {numbers[0], numbers[1], numbers[2]};
}

ParameterContext SceneParser::context() {
  return {state_.color_space, [this](const std::string& name, const SourceLocation& location) {
            return read_spectrum(name, location);
          }};
}

ParameterList SceneParser::expect_parameters(const std::string& owner,
                                             const SourceLocation& location) {
  return parse_parameters(tokens_, context(), owner, location);
}

ParameterList SceneParser::expect_parameters(const std::string& owner,
                                             const SourceLocation& location,
                                             AttributeTarget target) {
  ParameterList list = expect_parameters(owner, location);
  list.inherit(state_.attributes[static_cast<std::size_t>(target)]);
  return list;
}

Token SceneParser::expect_type(std::string_view directive) {
  Token type = tokens_.next();
  if (type.kind == TokenKind::kString) return type;
  fail_at(tokens_.location(type), "expected the type of {} as a string, found {}", directive,
          describe(type));
}

PbrtEntity SceneParser::expect_entity(std::string_view directive, const SourceLocation& location) {
  const Token type = expect_type(directive);
  const std::string owner = fmt::format("{} {}", directive, in_quotes(type.text));
  return {type.text, location, expect_parameters(owner, location)};
}

PbrtEntity SceneParser::expect_entity(std::string_view directive, const SourceLocation& location,
                                      AttributeTarget target) {
  const Token type = expect_type(directive);
  const std::string owner = fmt::format("{} {}", directive, in_quotes(type.text));
  return {type.text, location, expect_parameters(owner, location, target)};
}

PbrtScene parse_pbrt_file(const std::filesystem::path& path, Diagnostics& diagnostics,
                          const FileReader& reader, const ParseLimits& limits) {
  std::string bytes;
  try {
    bytes = reader.read(path, limits.file_bytes);
  } catch (const Error& error) {
    fail("{}: {}", path.string(), error.what());
  }
  return parse_pbrt_text(std::move(bytes), path.string(), diagnostics, reader, limits);
}

PbrtScene parse_pbrt_text(std::string text, const std::string& name, Diagnostics& diagnostics,
                          const FileReader& reader, const ParseLimits& limits) {
  try {
    text = unpack(std::move(text), limits.file_bytes);
  } catch (const Error& error) {
    fail("{}: {}", name, error.what());
  }
  SceneParser parser(diagnostics, reader, limits);
  return parser.parse(check_text(std::move(text), name), name);
}

}  // namespace freepath
