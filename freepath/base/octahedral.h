#pragma once
/// @file The equal-area map between the sphere and a square [Clarberg08], as pbrt-v4 orients it.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "freepath/base/distributions.h"
#include "freepath/base/turn.h"
#include "freepath/base/vector.h"

namespace freepath {

/// A point of the unit square; an image's first row is at v = 0.
struct SquarePoint {
  float u, v;
};

/// The point of a direction. The centre is +z, the corners are -z, the edges' middles ±x and ±y,
/// where u grows with x and v with y.
/// @param d need not be a unit vector, but not 0
inline SquarePoint octahedral_from_direction(const Vec3f& d) {
  const float length = d.length();
  const float across2 = d.x * d.x + d.y * d.y;
  // sqrt(1 - |z|) for a unit vector, without the cancellation at the poles.
  const float r = std::min(1.0F, std::sqrt(across2 / (length * (length + std::abs(d.z)))));
  const float angle =
      fast_atan2(std::abs(d.y), std::abs(d.x)) * (2.0F * std::numbers::inv_pi_v<float>);
  float v = r * angle;
  float u = r - v;
  if (d.z < 0) {  // the lower half is folded out over the diagonal of its quadrant
    const float folded = 1.0F - v;
    v = 1.0F - u;
    u = folded;
  }
  return {0.5F + 0.5F * std::copysign(u, d.x), 0.5F + 0.5F * std::copysign(v, d.y)};
}

/// The inverse: a unit vector.
inline Vec3f direction_from_octahedral(const SquarePoint& p) {
  const float u = 2.0F * p.u - 1.0F;
  const float v = 2.0F * p.v - 1.0F;
  const float au = std::abs(u);
  const float av = std::abs(v);
  const float inside = 1.0F - (au + av);  // below 0 on the lower half
  const float r = 1.0F - std::abs(inside);
  const SinCos azimuth = sincos_of_turn((r <= 0 ? 1.0F : (av - au) / r + 1.0F) * 0.125F);
  const float across = r * std::sqrt(std::max(0.0F, 2.0F - r * r));
  return {std::copysign(across * azimuth.cosine, u), std::copysign(across * azimuth.sine, v),
          std::copysign(1.0F - r * r, inside)};
}

}  // namespace freepath
