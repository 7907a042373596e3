#pragma once
/// @file The parameters of one statement of a scene, and what became of them.

#include <Imath/ImathVec.h>

#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/scene/pbrt/diagnostics.h"
#include "freepath/scene/pbrt/parameter.h"

namespace freepath {

using Vec2d = Imath::V2d;

using SharedParameters = std::vector<std::shared_ptr<const Parameter>>;

/// What to do about a parameter that nobody asked for.
enum class UnusedPolicy { kWarning, kError };

/// Typed access to the parameters of a statement. Every getter notes which name was asked for, and
/// report_unused names the parameters that were not. Getters of one value return the default where
/// the parameter is absent, those of many an empty range.
///
/// Each throws Error, beginning with the parameter's "file:line:column: ", if it is of another
/// type; getters of one value also if it does not have exactly one. Not to be asked by two threads
/// at once.
class ParameterList {
 public:
  ParameterList() = default;
  /// @param owner what a message calls the statement: "Shape 'sphere'"
  ParameterList(std::string owner, SourceLocation location)
      : owner_(std::move(owner)), location_(std::move(location)) {}

  /// @throws Error if there is one of this name already
  void add(std::shared_ptr<const Parameter> parameter);
  /// Gives the statement what Attribute directives set for all of its kind. A parameter that the
  /// statement has itself hides an inherited one; those need not be used.
  void inherit(std::shared_ptr<const SharedParameters> parameters) {
    inherited_ = std::move(parameters);
  }

  int get_integer(std::string_view name, int otherwise) const;
  std::span<const int> get_integers(std::string_view name) const;
  double get_float(std::string_view name, double otherwise) const;
  std::span<const double> get_floats(std::string_view name) const;
  std::vector<Vec2d> get_point2s(std::string_view name) const;
  Vec3d get_point(std::string_view name, const Vec3d& otherwise) const;
  std::vector<Vec3d> get_points(std::string_view name) const;
  Vec3d get_vector(std::string_view name, const Vec3d& otherwise) const;
  std::vector<Vec3d> get_normals(std::string_view name) const;
  bool get_bool(std::string_view name, bool otherwise) const;
  std::string get_string(std::string_view name, const std::string& otherwise) const;
  std::span<const std::string> get_strings(std::string_view name) const;
  /// The name of a texture; empty where there is none.
  std::string get_texture(std::string_view name) const;
  /// A parameter of type rgb, spectrum or blackbody.
  SpectrumValue get_spectrum(std::string_view name, const SpectrumValue& otherwise) const;
  std::vector<SpectrumValue> get_spectra(std::string_view name) const;

  /// The type of a parameter, nothing where there is none. Counts as asking for it.
  std::optional<ParameterType> type_of(std::string_view name) const;
  /// The place of a parameter, that of the statement where there is none.
  const SourceLocation& location_of(std::string_view name) const;
  /// The place of the statement.
  const SourceLocation& location() const { return location_; }

  /// Parameters of the statement itself, in the order of the scene.
  const SharedParameters& own() const { return own_; }
  /// Parameters of the statement, and the inherited ones that they do not hide.
  SharedParameters all() const;

  /// Names every parameter of the statement that nobody has asked for, with the nearest of the
  /// names that somebody has.
  /// @throws Error for the first of them, with kError
  void report_unused(Diagnostics& diagnostics, UnusedPolicy policy = UnusedPolicy::kWarning) const;

 private:
  const Parameter* find_any(std::string_view name) const;
  const Parameter* find(std::string_view name, ParameterType type) const;
  const Parameter* find_spectrum(std::string_view name) const;
  std::span<const double> numbers(std::string_view name, ParameterType type) const;
  std::span<const double> one(std::string_view name, ParameterType type) const;
  std::vector<Vec2d> pairs(std::string_view name, ParameterType type) const;
  std::vector<Vec3d> triples(std::string_view name, ParameterType type) const;

  std::string owner_;
  SourceLocation location_;
  SharedParameters own_;
  std::shared_ptr<const SharedParameters> inherited_;
  /// Asking changes nothing that a caller could see but the report.
  mutable std::set<std::string, std::less<>> asked_;
};

}  // namespace freepath
