#pragma once
/// @file Transforms of the scene language. Points are rows, `point * matrix`, so the sixteen
/// numbers of a Transform directive are the rows of the matrix, and a directive's matrix stands to
/// the left of what was there before: it is applied to points first.

#include "freepath/base/vector.h"

namespace freepath {

/// A transform at the beginning and at the end of the time that it moves in.
struct TransformPair {
  Matrix4d start;
  Matrix4d end;

  bool is_animated() const { return start != end; }
  TransformPair inverse() const { return {start.inverse(), end.inverse()}; }
  bool operator==(const TransformPair&) const = default;
};

Matrix4d translation(const Vec3d& offset);
Matrix4d scaling(const Vec3d& factors);

/// Rotation by the right-hand rule.
/// @param angle [degrees]
/// @param axis of any length but 0
Matrix4d rotation(double angle, const Vec3d& axis);

/// The world seen by a camera: x to its right, y up, z ahead (left-handed).
/// @param up need not be perpendicular to the view, but may not be parallel to it
Matrix4d look_at(const Vec3d& from, const Vec3d& at, const Vec3d& up);

/// Whether a matrix is finite, affine and has an inverse that is finite too.
bool is_usable(const Matrix4d& matrix);

}  // namespace freepath
