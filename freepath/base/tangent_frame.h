#pragma once
/// @file Coordinates around a direction.

#include <cmath>

#include "freepath/base/vector.h"

namespace freepath {

/// Two unit vectors that complete `normal` to a right-handed orthonormal basis [Duff17].
struct TangentFrame {
  Vec3f tangent, bitangent, normal;

  /// @param unit a unit vector
  explicit TangentFrame(const Vec3f& unit) : normal(unit) {
    const float sign = std::copysign(1.0F, unit.z);
    const float a = -1.0F / (sign + unit.z);
    const float b = unit.x * unit.y * a;
    tangent = {1.0F + sign * unit.x * unit.x * a, sign * b, -sign * unit.x};
    bitangent = {b, sign + unit.y * unit.y * a, -unit.y};
  }

  /// The vector with these coordinates in the basis.
  Vec3f to_world(float x, float y, float z) const {
    return tangent * x + bitangent * y + normal * z;
  }
  /// The coordinates of a vector in the basis.
  Vec3f to_local(const Vec3f& v) const { return {tangent.dot(v), bitangent.dot(v), normal.dot(v)}; }
};

}  // namespace freepath
