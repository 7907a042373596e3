#pragma once
/// @file Vectors, boxes and affine transforms: Imath's, under the project's names.
/// As in Imath and OpenVDB, points are rows: `point * matrix`.

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

namespace freepath {

using Vec3f = Imath::V3f;
using Vec3d = Imath::V3d;
using Vec3i = Imath::V3i;
using Box3f = Imath::Box3f;
using Box3d = Imath::Box3d;
using Matrix4d = Imath::M44d;

}  // namespace freepath
