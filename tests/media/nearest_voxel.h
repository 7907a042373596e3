#pragma once
/// @file The voxel that a point of the index space lies in.

#include <cmath>

#include "freepath/base/vector.h"

namespace freepath::testing {

inline Vec3i nearest_voxel(const Vec3d& p) {
  return {static_cast<int>(std::floor(p.x + 0.5)), static_cast<int>(std::floor(p.y + 0.5)),
          static_cast<int>(std::floor(p.z + 0.5))};
}

}  // namespace freepath::testing
