#pragma once
/// @file Corners and images of boxes, and boxes that stand anyhow in the world.

#include <Imath/ImathBoxAlgo.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "freepath/base/vector.h"

namespace freepath {

inline std::array<Vec3d, 8> corners_of(const Box3d& box) {
  std::array<Vec3d, 8> corners;
  for (int i = 0; i < 8; ++i) {
    corners[i] = {(i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                  (i & 4) != 0 ? box.max.z : box.min.z};
  }
  return corners;
}

/// The image of a box under an affine map, which must have an inverse.
class OrientedBox {
 public:
  /// A box along the axes of the world, unless a map from its own space to the world is given.
  explicit OrientedBox(const Box3d& box, const Matrix4d& to_world = Matrix4d())
      : box_(box), to_world_(to_world) {}

  /// The box in its own space.
  const Box3d& box() const { return box_; }
  const Matrix4d& to_world() const { return to_world_; }
  Vec3d center() const { return box_.center() * to_world_; }
  /// The box around it along the axes of the world.
  Box3d bounds() const { return Imath::transform(box_, to_world_); }

  /// Largest coordinate of its corners, relative to an origin [world].
  double farthest_coordinate(const Vec3d& origin) const {
    double farthest = 0;
    for (const Vec3d& corner : corners_of(box_)) {
      const Vec3d relative = corner * to_world_ - origin;
      for (int axis = 0; axis < 3; ++axis) {
        farthest = std::max(farthest, std::abs(relative[axis]));
      }
    }
    return farthest;
  }

  /// A copy whose sides are farther out by a length [world]; by a negative one farther in, but no
  /// more than half of the way to the middle.
  OrientedBox grown_by(double length) const {
    const Matrix4d from_world = to_world_.inverse();
    OrientedBox grown = *this;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3d gradient(from_world[0][axis], from_world[1][axis], from_world[2][axis]);
      const double step = std::max(length * gradient.length(), -box_.size()[axis] / 4);
      grown.box_.min[axis] -= step;
      grown.box_.max[axis] += step;
    }
    return grown;
  }

 private:
  Box3d box_;
  Matrix4d to_world_;
};

}  // namespace freepath
