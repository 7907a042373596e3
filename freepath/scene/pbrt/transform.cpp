#include "freepath/scene/pbrt/transform.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freepath {
namespace {

Vec3d row_of(const Matrix4d& matrix, int row) {
  return {matrix[row][0], matrix[row][1], matrix[row][2]};
}

Matrix4d from_rows(const Vec3d& x, const Vec3d& y, const Vec3d& z, const Vec3d& origin) {
  return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, origin.x, origin.y, origin.z, 1};
}

}  // namespace

Matrix4d translation(const Vec3d& offset) { return Matrix4d().setTranslation(offset); }

Matrix4d scaling(const Vec3d& factors) { return Matrix4d().setScale(factors); }

Matrix4d rotation(double angle, const Vec3d& axis) {
  return Matrix4d().setAxisAngle(axis.normalized(), angle * std::numbers::pi / 180);
}

Matrix4d look_at(const Vec3d& from, const Vec3d& at, const Vec3d& up) {
  const Vec3d ahead = (at - from).normalized();
  const Vec3d right = up.normalized().cross(ahead).normalized();
  const Vec3d world_from_camera_up = ahead.cross(right);
  return from_rows(right, world_from_camera_up, ahead, from).inverse();
}

bool is_usable(const Matrix4d& matrix) {
  // Beyond these, single precision holds neither the matrix nor its inverse.
  constexpr double kLargest = 1e30;
  constexpr double kSmallestVolume = 1e-12;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      if (!(std::abs(matrix[i][j]) <= kLargest)) return false;
    }
    if (matrix[i][3] != (i == 3 ? 1 : 0)) return false;
  }
  // The volume that unit vectors along the images of the axes span, whatever the scale is.
  Vec3d axes[3];
  for (int i = 0; i < 3; ++i) {
    const Vec3d row = row_of(matrix, i);
    const double length = row.length();
    if (!(length >= 1 / kLargest)) return false;
    axes[i] = row / length;
  }
  return std::abs(axes[0].dot(axes[1].cross(axes[2]))) > kSmallestVolume;
}

}  // namespace freepath
