#pragma once
/// @file An affine map in double precision, cheaper to apply than a 4x4 matrix.

#include <cmath>

#include "freepath/base/vector.h"

namespace freepath {

/// A point is a row: p.x * x + p.y * y + p.z * z + translation.
struct AffineTransform {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Vec3d translation{0, 0, 0};

  AffineTransform() = default;
  explicit AffineTransform(const Matrix4d& m)
      : x(m[0][0], m[0][1], m[0][2]),
        y(m[1][0], m[1][1], m[1][2]),
        z(m[2][0], m[2][1], m[2][2]),
        translation(m[3][0], m[3][1], m[3][2]) {}

  Vec3d point(const Vec3d& p) const { return x * p.x + y * p.y + z * p.z + translation; }
  Vec3d vector(const Vec3d& v) const { return x * v.x + y * v.y + z * v.z; }
  /// This map, and another one after it.
  AffineTransform then(const AffineTransform& next) const {
    AffineTransform both;
    both.x = next.vector(x);
    both.y = next.vector(y);
    both.z = next.vector(z);
    both.translation = next.point(translation);
    return both;
  }
  /// Takes a normal of B to A, where the map is from A to B. Not normalised.
  Vec3d normal_back(const Vec3d& n) const { return {x.dot(n), y.dot(n), z.dot(n)}; }
  /// Whether it keeps angles.
  bool is_similarity() const {
    constexpr double kSame = 1e-9;
    const double scale = x.length();
    const auto is_small = [&](double value, double power) {
      return std::abs(value) <= kSame * power;
    };
    const double squared = scale * scale;
    return is_small(y.length() - scale, scale) && is_small(z.length() - scale, scale) &&
           is_small(x.dot(y), squared) && is_small(y.dot(z), squared) &&
           is_small(z.dot(x), squared);
  }
  /// Negative where the map swaps handedness.
  double determinant() const { return x.dot(y.cross(z)); }
};

}  // namespace freepath
