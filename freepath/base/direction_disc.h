#pragma once
/// @file A disc of directions, as that of the sun.

#include <cmath>
#include <numbers>

#include "freepath/base/tangent_frame.h"
#include "freepath/base/turn.h"
#include "freepath/base/vector.h"

namespace freepath {

/// The directions that differ from one by at most a small angle.
struct DirectionDisc {
  /// Factor that takes back inside what rounding has put beyond the edge, by some 1e-5 of the
  /// radius.
  static constexpr float kInside = 0.9999F;

  TangentFrame frame;  ///< Around the middle.
  /// Square of the distance of the edge from the middle on the unit sphere: 2 (1 - cosine of the
  /// radius).
  float largest_distance2;

  /// @param sine_of_half sine of half the angular radius, 1e-3 to 1e-1: of smaller discs rounding
  ///   leaves too little
  DirectionDisc(const Vec3f& middle, float sine_of_half)
      : frame(middle), largest_distance2(4 * sine_of_half * sine_of_half) {}

  const Vec3f& middle() const { return frame.normal; }
  /// Solid angle, 2π (1 - cosine of the radius) [sr].
  float solid_angle() const { return std::numbers::pi_v<float> * largest_distance2; }

  /// Whether a direction lies in the disc. Decided by the distance of two points of the sphere: the
  /// cosine has no digits left for angles as small as the sun's.
  bool contains(const Vec3f& direction) const {
    return (direction - middle()).length2() <= largest_distance2;
  }

  /// A direction uniformly distributed in the disc, for which `contains` holds. The lanes compute
  /// the same in the same order (transport/scattering-inl.h).
  /// @param u0,u1 in [0, 1)
  Vec3f sample(float u0, float u1) const {
    const float drop = u0 * 0.5F * largest_distance2;  // 1 - cosine
    const float sine = std::sqrt(drop * (2.0F - drop));
    const SinCos azimuth = sincos_of_turn(u1);
    const Vec3f direction = frame.to_world(sine * azimuth.cosine, sine * azimuth.sine, 1.0F - drop);
    if (contains(direction)) return direction;
    const Vec3f inside = middle() + (direction - middle()) * kInside;
    return inside * (1.0F / std::sqrt(inside.length2()));
  }
};

}  // namespace freepath
