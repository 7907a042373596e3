#pragma once
/// @file The parser's inside: what directives act on. Programs include parser.h.

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/scene/pbrt/parameter_parser.h"
#include "freepath/scene/pbrt/parser.h"
#include "freepath/scene/pbrt/token_stream.h"

namespace freepath {

/// Statements that an Attribute directive can give parameters to.
enum class AttributeTarget { kShape, kLight, kMaterial, kMedium, kTexture };
inline constexpr std::array<std::string_view, 5> kAttributeTargets = {"shape", "light", "material",
                                                                      "medium", "texture"};

/// What AttributeBegin saves and AttributeEnd restores.
struct GraphicsState {
  /// Transform of the coordinates in use to the world (camera: the reverse).
  TransformPair transform;
  bool start_active = true, end_active = true;
  bool reverse_orientation = false;
  ColorSpace color_space = ColorSpace::kSrgb;
  int material = 0;            ///< Index into PbrtScene::materials, unless there is a name:
  std::string named_material;  ///< resolved at the end, since it may be made later.
  std::optional<int> area_light;
  std::string inside_medium, outside_medium;
  /// Shared with the statements that have inherited them.
  std::array<std::shared_ptr<const SharedParameters>, kAttributeTargets.size()> attributes;
};

/// A name that a statement refers to, and where; checked when all is read.
struct NameUse {
  std::string name;
  SourceLocation location;
};

/// One parse. Directives are member functions, in files by what they are about.
class SceneParser {
 public:
  SceneParser(Diagnostics& diagnostics, const FileReader& reader, const ParseLimits& limits)
      : diagnostics_(diagnostics), reader_(reader), limits_(limits) {}

  PbrtScene parse(std::string text, const std::string& name);

  /// The place of the directive in hand.
  using Directive = void (SceneParser::*)(const SourceLocation&);
  /// The directives that act on one half of the scene, or on both.
  enum class Phase { kAny, kOptions, kWorld };
  struct DirectiveInfo {
    std::string_view name;
    Directive run;
    Phase phase;
  };

 private:
  enum class Scope { kAttribute, kTransform, kObject };
  struct OpenScope {
    Scope scope;
    SourceLocation location;
    GraphicsState state;
  };

  // scene_parser.cpp
  void parse_directives();
  void run_directive(const Token& token, const SourceLocation& location);
  Token expect_string(std::string_view what);
  Token expect_type(std::string_view directive);
  double expect_number(std::string_view what);
  void expect_numbers(double* numbers, int count, std::string_view what);
  Vec3d expect_vector(std::string_view what);
  ParameterList expect_parameters(const std::string& owner, const SourceLocation& location);
  ParameterList expect_parameters(const std::string& owner, const SourceLocation& location,
                                  AttributeTarget target);
  /// Parameters whose "string type" names the implementation.
  PbrtEntity expect_typed_parameters(const std::string& owner, const SourceLocation& location,
                                     AttributeTarget target);
  PbrtEntity expect_entity(std::string_view directive, const SourceLocation& location);
  PbrtEntity expect_entity(std::string_view directive, const SourceLocation& location,
                           AttributeTarget target);
  ParameterContext context();
  std::shared_ptr<const SpectrumSamples> read_spectrum(const std::string& name,
                                                       const SourceLocation& location);

  // directives_files.cpp
  void include_file(const SourceLocation& location);
  void import_file(const SourceLocation& location);
  void open_file(const Token& name, const SourceLocation& location);
  std::string read_named_file(const std::filesystem::path& path, const SourceLocation& location);

  // directives_transform.cpp
  void identity(const SourceLocation& location);
  void translate(const SourceLocation& location);
  void scale(const SourceLocation& location);
  void rotate(const SourceLocation& location);
  void look_at_point(const SourceLocation& location);
  void transform(const SourceLocation& location);
  void concat_transform(const SourceLocation& location);
  void coordinate_system(const SourceLocation& location);
  void coord_sys_transform(const SourceLocation& location);
  void transform_times(const SourceLocation& location);
  void active_transform(const SourceLocation& location);
  Matrix4d expect_matrix(const SourceLocation& location);
  void concatenate(const Matrix4d& matrix, const SourceLocation& location);

  // directives_options.cpp
  void option(const SourceLocation& location);
  void color_space(const SourceLocation& location);
  void camera(const SourceLocation& location);
  void film(const SourceLocation& location);
  void sampler(const SourceLocation& location);
  void pixel_filter(const SourceLocation& location);
  void integrator(const SourceLocation& location);
  void accelerator(const SourceLocation& location);
  void world_begin(const SourceLocation& location);
  void set_entity(std::optional<PbrtEntity>& entity, std::string_view directive,
                  const SourceLocation& location);
  void warn_if_repeated(bool repeated, std::string_view directive, const SourceLocation& location);

  // directives_scopes.cpp
  void attribute_begin(const SourceLocation& location);
  void attribute_end(const SourceLocation& location);
  void transform_begin(const SourceLocation& location);
  void transform_end(const SourceLocation& location);
  void attribute(const SourceLocation& location);
  void reverse_orientation(const SourceLocation& location);
  void object_begin(const SourceLocation& location);
  void object_end(const SourceLocation& location);
  void object_instance(const SourceLocation& location);
  void open_scope(Scope scope, const SourceLocation& location);
  void close_scope(Scope scope, const SourceLocation& location);
  static std::string_view begin_of(Scope scope);
  static std::string_view end_of(Scope scope);
  void warn_of_transform_scopes(const SourceLocation& location);

  // directives_world.cpp
  void make_named_material(const SourceLocation& location);
  void named_material(const SourceLocation& location);
  void material(const SourceLocation& location);
  void texture(const SourceLocation& location);
  void make_named_medium(const SourceLocation& location);
  void medium_interface(const SourceLocation& location);
  void light_source(const SourceLocation& location);
  void area_light_source(const SourceLocation& location);
  void shape(const SourceLocation& location);
  void define(std::map<std::string, int, std::less<>>& names, const Token& name, int index,
              std::string_view what);

  // references.cpp
  void resolve_references();
  void resolve_textures(const SharedParameters& parameters) const;
  std::optional<int> only_texture_of_name(const std::string& name) const;
  void refuse_texture_cycles() const;

  static const std::vector<DirectiveInfo>& directives();

  Diagnostics& diagnostics_;
  const FileReader& reader_;
  const ParseLimits limits_;

  PbrtScene scene_;
  GraphicsState state_;
  bool in_world_ = false;
  std::vector<OpenScope> scopes_;
  std::size_t scopes_outside_import_ = 0;  ///< Scopes that an imported file may not close.
  std::optional<int> open_object_;
  std::map<std::string, TransformPair, std::less<>> coordinate_systems_;

  TokenStream tokens_;
  std::size_t files_read_ = 0;
  std::map<std::string, std::shared_ptr<const SpectrumSamples>> spectra_;

  std::map<std::string, int, std::less<>> material_names_, medium_names_, object_names_;
  std::map<std::string, int, std::less<>> float_texture_names_, spectrum_texture_names_;
  std::vector<NameUse> material_references_, medium_references_;
  SharedParameters attribute_parameters_;  ///< All that Attribute directives have set.
  /// Names of the shapes' materials, one for each shape.
  std::vector<std::string> shape_materials_;
  /// Names of the instances' objects, one for each instance.
  std::vector<std::string> instance_objects_;
};

}  // namespace freepath
