#pragma once
/// @file The coordinates of a light.

#include <array>
#include <cmath>
#include <string>

#include "freepath/base/error.h"
#include "freepath/base/vector.h"

namespace freepath {

/// Directions between the world and a light, by the linear part of its transform.
class LightFrame {
 public:
  LightFrame() = default;

  /// @throws Error that names the light, if the transform has no inverse
  LightFrame(const Matrix4d& light_to_world, const std::string& name) {
    Imath::M33d linear;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) linear[i][j] = light_to_world[i][j];
    }
    const double determinant = linear.determinant();
    if (!std::isfinite(determinant) || determinant == 0) {
      fail("{}: its transform has no inverse", name);
    }
    const Imath::M33d inverse = linear.inverse();
    for (int j = 0; j < 3; ++j) {
      to_world_[j] = Vec3f(Vec3d(linear[0][j], linear[1][j], linear[2][j]));
      to_light_[j] = Vec3f(Vec3d(inverse[0][j], inverse[1][j], inverse[2][j]));
    }
    inverse_determinant_ = static_cast<float>(std::abs(1 / determinant));
  }

  /// Coordinates in the light; not normalised.
  Vec3f to_light(const Vec3f& v) const {
    return {to_light_[0].dot(v), to_light_[1].dot(v), to_light_[2].dot(v)};
  }
  /// Coordinates in the world; not normalised.
  Vec3f to_world(const Vec3f& v) const {
    return {to_world_[0].dot(v), to_world_[1].dot(v), to_world_[2].dot(v)};
  }
  /// Whether angles are the same in both.
  bool keeps_angles() const {
    constexpr float kTolerance = 1e-3F;
    const float scale2 = to_light_[0].length2();
    return std::abs(to_light_[1].length2() - scale2) <= kTolerance * scale2 &&
           std::abs(to_light_[2].length2() - scale2) <= kTolerance * scale2 &&
           std::abs(to_light_[0].dot(to_light_[1])) <= kTolerance * scale2 &&
           std::abs(to_light_[1].dot(to_light_[2])) <= kTolerance * scale2 &&
           std::abs(to_light_[2].dot(to_light_[0])) <= kTolerance * scale2;
  }
  /// Solid angle in the light for one in the world: the density of a direction is to be multiplied
  /// by it. 1 without shears and uneven scales.
  /// @param length of to_light of the unit direction in the world
  float light_solid_angle(float length) const {
    return inverse_determinant_ / (length * length * length);
  }

 private:
  std::array<Vec3f, 3> to_world_{Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 0, 1)};
  std::array<Vec3f, 3> to_light_{Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 0, 1)};
  float inverse_determinant_ = 1;
};

}  // namespace freepath
