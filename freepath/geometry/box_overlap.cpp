#include "freepath/geometry/box_overlap.h"

#include <algorithm>
#include <cmath>

#include "freepath/base/box.h"

namespace freepath {

namespace {

/// Whether projections on an axis overlap, for a box around 0 of this half size.
bool overlaps_along(const Vec3d& axis, const std::array<Vec3d, 3>& corners, const Vec3d& half) {
  const double a = axis.dot(corners[0]);
  const double b = axis.dot(corners[1]);
  const double c = axis.dot(corners[2]);
  const double reach =
      half.x * std::abs(axis.x) + half.y * std::abs(axis.y) + half.z * std::abs(axis.z);
  return std::min({a, b, c}) <= reach && std::max({a, b, c}) >= -reach;
}

Box3d around(std::span<const Vec3d> points, const AffineTransform& map) {
  Box3d box;
  for (const Vec3d& p : points) box.extendBy(map.point(p));
  return box;
}

}  // namespace

bool triangle_meets_box(const std::array<Vec3d, 3>& triangle, const Box3d& box) {
  const Vec3d middle = box.center();
  const Vec3d half = box.size() * 0.5;
  const std::array<Vec3d, 3> corners = {triangle[0] - middle, triangle[1] - middle,
                                        triangle[2] - middle};
  const std::array<Vec3d, 3> sides = {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)};
  const std::array<Vec3d, 3> edges = {corners[1] - corners[0], corners[2] - corners[1],
                                      corners[0] - corners[2]};
  for (const Vec3d& side : sides) {
    if (!overlaps_along(side, corners, half)) return false;
  }
  if (!overlaps_along(edges[0].cross(edges[1]), corners, half)) return false;
  for (const Vec3d& side : sides) {
    for (const Vec3d& edge : edges) {
      if (!overlaps_along(side.cross(edge), corners, half)) return false;
    }
  }
  return true;
}

bool part_meets_box(const TracedPart& part, const AffineTransform& to_box,
                    const AffineTransform& to_part, std::span<const uint32_t> shapes,
                    const Box3d& box) {
  const auto is_wanted = [&](const TracedShape& shape) {
    return std::find(shapes.begin(), shapes.end(), shape.shape) != shapes.end();
  };
  for (const TracedTriangles& mesh : part.triangles) {
    if (!is_wanted(mesh) || !around(corners_of(mesh.box), to_box).intersects(box)) continue;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      if (triangle_meets_box({to_box.point(mesh.position(i)), to_box.point(mesh.position(i + 1)),
                              to_box.point(mesh.position(i + 2))},
                             box)) {
        return true;
      }
    }
  }
  for (const TracedPatches& mesh : part.patches) {
    if (!is_wanted(mesh)) continue;
    for (uint32_t i = 0; i < mesh.count(); ++i) {
      const BilinearPatch p = mesh.patch(i);
      if (around(std::array{p.p00, p.p10, p.p01, p.p11}, to_box).intersects(box)) return true;
    }
  }
  std::array<Vec3d, 8> corners = corners_of(box);
  for (Vec3d& corner : corners) corner = to_part.point(corner);
  return std::any_of(part.quadrics.begin(), part.quadrics.end(), [&](const TracedQuadric& shape) {
    if (!is_wanted(shape)) return false;
    std::array<Vec3d, 8> object;
    for (int i = 0; i < 8; ++i) object[i] = shape.part_to_object.point(corners[i]);
    return shape.quadric.may_meet(object);
  });
}

}  // namespace freepath
