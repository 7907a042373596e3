#pragma once
/// @file How far two colours are apart.

#include <algorithm>
#include <cmath>

#include "freepath/base/vector.h"

namespace freepath::testing {

/// The largest difference of a channel.
inline double largest_difference(const Vec3d& a, const Vec3d& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

}  // namespace freepath::testing
