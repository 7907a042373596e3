#pragma once
/// @file Which way is up, and directions on the sky.
///
/// Everything that stands on the ground (camera framing, environments, sky, sun) is described once,
/// with y up. A world with z up is the same world turned about the x axis, so that the y-up axes
/// (x, y, z) are its (x, z, -y).

#include <cmath>
#include <numbers>

#include "freepath/base/vector.h"

namespace freepath {

/// The axis of world space that points up.
enum class UpAxis { kY, kZ };

/// The number of that axis.
constexpr int up_index(UpAxis up) { return up == UpAxis::kY ? 1 : 2; }

/// World space → the same vector with y up.
inline Vec3f to_y_up(const Vec3f& world, UpAxis up) {
  return up == UpAxis::kY ? world : Vec3f(world.x, world.z, -world.y);
}

/// The inverse of to_y_up.
inline Vec3f from_y_up(const Vec3f& standing, UpAxis up) {
  return up == UpAxis::kY ? standing : Vec3f(standing.x, -standing.z, standing.y);
}

/// The unit vector that points up [world].
inline Vec3f up_vector(UpAxis up) { return from_y_up({0, 1, 0}, up); }

/// The direction towards a point of the sky [world].
///
/// @param elevation above the horizon [degrees]
/// @param azimuth as on a compass, clockwise seen from above [degrees]: 0 is north, which is -z
///   with y up and +y with z up; 90 is east, +x either way
inline Vec3f sky_direction(double elevation, double azimuth, UpAxis up) {
  constexpr double kRadians = std::numbers::pi / 180;
  const double height = std::sin(elevation * kRadians);
  const double reach = std::cos(elevation * kRadians);
  return from_y_up(
      {static_cast<float>(reach * std::sin(azimuth * kRadians)), static_cast<float>(height),
       static_cast<float>(-reach * std::cos(azimuth * kRadians))},
      up);
}

}  // namespace freepath
