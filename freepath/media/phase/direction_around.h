#pragma once
/// @file A direction at a given angle from an axis.

#include <algorithm>
#include <cmath>

#include "freepath/base/tangent_frame.h"
#include "freepath/base/turn.h"
#include "freepath/base/vector.h"

namespace freepath {

/// The unit vector at an angle θ from a unit axis, turned around it by u2 of a full circle.
/// @param h sin²(θ/2) = (1 - cos θ) / 2, which keeps its digits at the axis where the cosine
/// doesn't
inline Vec3f direction_around(const Vec3f& axis, double h, float u2) {
  const auto sine = static_cast<float>(2.0 * std::sqrt(std::max(0.0, h * (1.0 - h))));
  const auto cosine = static_cast<float>(1.0 - 2.0 * h);
  const SinCos azimuth = sincos_of_turn(u2);
  const Vec3f after =
      TangentFrame(axis).to_world(sine * azimuth.cosine, sine * azimuth.sine, cosine);
  // Normalised, so that rounding doesn't build up over thousands of events.
  return after * (1.0F / std::sqrt(after.length2()));
}

}  // namespace freepath
