// Transforms and coordinate systems.

#include <vector>

#include "freepath/scene/pbrt/nearest_name.h"
#include "freepath/scene/pbrt/scene_parser.h"

namespace freepath {

void SceneParser::concatenate(const Matrix4d& matrix, const SourceLocation& location) {
  const auto apply = [&](Matrix4d& current) {
    current = matrix * current;
    if (!is_usable(current)) {
      fail_at(location, "with this the current transform becomes singular, or too large or small");
    }
  };
  if (state_.start_active) apply(state_.transform.start);
  if (state_.end_active) apply(state_.transform.end);
}

void SceneParser::identity(const SourceLocation& /*location*/) {
  if (state_.start_active) state_.transform.start = Matrix4d();
  if (state_.end_active) state_.transform.end = Matrix4d();
}

void SceneParser::translate(const SourceLocation& location) {
  concatenate(translation(expect_vector("Translate")), location);
}

void SceneParser::scale(const SourceLocation& location) {
  const Vec3d factors = expect_vector("Scale");
  if (factors.x == 0 || factors.y == 0 || factors.z == 0) {
    fail_at(location, "Scale by 0 is singular: it has no inverse");
  }
  concatenate(scaling(factors), location);
}

void SceneParser::rotate(const SourceLocation& location) {
  double numbers[4] = {};
  expect_numbers(numbers, 4, "Rotate");
  const Vec3d axis(numbers[1], numbers[2], numbers[3]);
  if (axis == Vec3d(0)) fail_at(location, "Rotate needs an axis that is not 0 0 0");
  concatenate(rotation(numbers[0], axis), location);
}

void SceneParser::look_at_point(const SourceLocation& location) {
  double numbers[9] = {};
  expect_numbers(numbers, 9, "LookAt");
  const Vec3d from(numbers[0], numbers[1], numbers[2]);
  const Vec3d at(numbers[3], numbers[4], numbers[5]);
  const Vec3d up(numbers[6], numbers[7], numbers[8]);
  if (from == at) fail_at(location, "LookAt needs a target other than the position");
  if (up == Vec3d(0)) fail_at(location, "LookAt needs an up vector that is not 0 0 0");
  constexpr double kParallel = 1e-9;
  if ((at - from).normalized().cross(up.normalized()).length() < kParallel) {
    fail_at(location, "LookAt needs an up vector that is not parallel to the view");
  }
  concatenate(look_at(from, at, up), location);
}

Matrix4d SceneParser::expect_matrix(const SourceLocation& location) {
  Matrix4d matrix;
  expect_numbers(&matrix[0][0], 16, "a transform");
  for (int row = 0; row < 4; ++row) {
    if (matrix[row][3] != (row == 3 ? 1 : 0)) {
      fail_at(location, "every fourth number of a transform must be 0, the last one 1");
    }
  }
  if (!is_usable(matrix)) {
    fail_at(location, "this transform is singular, or too large or small: it has no inverse");
  }
  return matrix;
}

void SceneParser::transform(const SourceLocation& location) {
  const Matrix4d matrix = expect_matrix(location);
  if (state_.start_active) state_.transform.start = matrix;
  if (state_.end_active) state_.transform.end = matrix;
}

void SceneParser::concat_transform(const SourceLocation& location) {
  concatenate(expect_matrix(location), location);
}

void SceneParser::coordinate_system(const SourceLocation& /*location*/) {
  coordinate_systems_[expect_string("the name of a coordinate system").text] = state_.transform;
}

void SceneParser::coord_sys_transform(const SourceLocation& /*location*/) {
  const Token name = expect_string("the name of a coordinate system");
  const auto found = coordinate_systems_.find(name.text);
  if (found == coordinate_systems_.end()) {
    std::vector<std::string_view> names;
    for (const auto& entry : coordinate_systems_) names.emplace_back(entry.first);
    fail_at(tokens_.location(name), "there is no coordinate system {}{}", in_quotes(name.text),
            did_you_mean(name.text, names));
  }
  state_.transform = found->second;
}

void SceneParser::transform_times(const SourceLocation& location) {
  scene_.start_time = expect_number("the starting time");
  scene_.end_time = expect_number("the ending time");
  if (!(scene_.start_time < scene_.end_time)) {
    fail_at(location, "TransformTimes must begin before they end");
  }
}

void SceneParser::active_transform(const SourceLocation& /*location*/) {
  const Token which = tokens_.next();
  const bool all = which.source == "All";
  if (!all && which.source != "StartTime" && which.source != "EndTime") {
    fail_at(tokens_.location(which), "expected StartTime, EndTime or All, found {}",
            describe(which));
  }
  state_.start_active = all || which.source == "StartTime";
  state_.end_active = all || which.source == "EndTime";
}

}  // namespace freepath
