#pragma once
/// @file The triangle that a triangle in space covers of the unit sphere around a point.

#include "freepath/base/vector.h"

namespace freepath {

class SphericalTriangle {
 public:
  /// @param corners as seen from the point: not 0, of any length
  SphericalTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c);

  /// [sr] [VanOosterom83]
  double solid_angle() const { return solid_angle_; }
  /// A unit vector, uniformly distributed in the triangle, for uniform numbers in [0, 1) [Arvo95].
  Vec3d sample(double u0, double u1) const;

 private:
  Vec3d a_, b_, c_;  // unit
  double solid_angle_;
};

}  // namespace freepath
