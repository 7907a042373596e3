#include "freepath/geometry/traced_shapes.h"

#include <cmath>

#include "freepath/base/box.h"
#include "freepath/base/tangent_frame.h"

namespace freepath {

namespace {

Matrix4d to_part(const SurfaceShape& shape, const Vec3d& origin) {
  Matrix4d to_origin;
  to_origin.setTranslation(-origin);
  return shape.object_to_world * to_origin;
}

TracedShape common(const SurfaceShape& shape) {
  const bool swaps = AffineTransform(shape.object_to_world).determinant() < 0;
  return {shape.shape, shape.first_primitive, shape.is_boundary, shape.reverse_orientation != swaps,
          shape.needs_uv};
}

template <class Mesh>
TracedVertices trace_vertices(const SurfaceShape& shape, const Mesh& mesh, const Vec3d& origin) {
  TracedVertices traced{common(shape), {}, {}, {}, {}};
  const Matrix4d matrix = to_part(shape, origin);
  const AffineTransform map(matrix);
  traced.positions.reserve(mesh.positions.size() + 1);
  for (const Vec3d& p : mesh.positions) traced.positions.emplace_back(map.point(p));
  traced.positions.emplace_back(0.0F);
  const AffineTransform inverse(matrix.inverse());
  const float sign = shape.reverse_orientation ? -1.0F : 1.0F;
  traced.normals.reserve(mesh.normals.size());
  for (const Vec3f& n : mesh.normals) {
    // Not normalised: as in pbrt, longer ones count for more where they are interpolated.
    traced.normals.push_back(Vec3f(inverse.normal_back(Vec3d(n))) * sign);
  }
  traced.uvs = mesh.uvs;
  traced.indices.assign(mesh.indices.begin(), mesh.indices.end());
  return traced;
}

/// Any vector that is perpendicular to a normal.
Vec3d any_tangent(const Vec3d& normal) {
  return Vec3d(TangentFrame(Vec3f(normal.normalized())).tangent);
}

}  // namespace

Box3d TracedVertices::bounds(uint64_t& looked_at) const {
  Box3d around;
  for (std::size_t i = 0; i + 1 < positions.size(); ++i, ++looked_at) {
    around.extendBy(Vec3d(positions[i]));
  }
  return around;
}

Vec3d TracedTriangles::plane_normal(uint32_t triangle) const {
  const std::size_t first = std::size_t{3} * triangle;
  const Vec3d p0 = position(first);
  return (position(first + 1) - p0).cross(position(first + 2) - p0);
}

Vec3d TracedTriangles::normal(uint32_t triangle, float u, float v) const {
  const Vec3d flat = plane_normal(triangle);
  bool flip = is_reversed;
  if (!normals.empty()) {
    const uint32_t* index = &indices[std::size_t{3} * triangle];
    const Vec3f smooth =
        normals[index[0]] * (1 - u - v) + normals[index[1]] * u + normals[index[2]] * v;
    if (smooth.length2() > 0) flip = flat.dot(Vec3d(smooth)) < 0;
  }
  return flip ? -flat : flat;
}

LinePoint TracedTriangles::meet_plane(uint32_t triangle, const LocalRay& ray) const {
  LinePoint point;
  point.normal = plane_normal(triangle);
  point.across = point.normal.dot(ray.direction);
  point.t = point.normal.dot(position(std::size_t{3} * triangle) - ray.origin) / point.across;
  return point;
}

LocalPoint TracedTriangles::describe(uint32_t triangle, float u, float v,
                                     const LocalRay& ray) const {
  LocalPoint point = describe(triangle, u, v);
  const double across = point.normal.dot(ray.direction);
  constexpr double kGrazing = 1e-5;
  if (std::abs(across) > kGrazing * point.normal.length() * ray.direction.length()) {
    const double t = point.normal.dot(point.position - ray.origin) / across;
    point.position = ray.origin + ray.direction * t;
  }
  return point;
}

LocalPoint TracedTriangles::describe(uint32_t triangle, float u, float v) const {
  const std::size_t first = std::size_t{3} * triangle;
  const Vec3d p0 = position(first);
  const Vec3d edge1 = position(first + 1) - p0;
  const Vec3d edge2 = position(first + 2) - p0;
  const uint32_t* index = &indices[first];
  LocalPoint point;
  point.position = p0 + edge1 * u + edge2 * v;
  point.normal = normal(triangle, u, v);
  point.shading_normal = point.normal;
  if (!normals.empty()) {
    const Vec3f smooth =
        normals[index[0]] * (1 - u - v) + normals[index[1]] * u + normals[index[2]] * v;
    if (smooth.length2() > 0) point.shading_normal = Vec3d(smooth);
  }
  Vec2f uv0(0, 0), uv1(1, 0), uv2(1, 1);
  if (!uvs.empty()) {
    uv0 = uvs[index[0]];
    uv1 = uvs[index[1]];
    uv2 = uvs[index[2]];
  }
  point.uv = uv0 * (1 - u - v) + uv1 * u + uv2 * v;
  const Imath::V2d along1(uv1 - uv0);
  const Imath::V2d along2(uv2 - uv0);
  const double determinant = along1.cross(along2);
  if (std::abs(determinant) >= 1e-9) {
    point.dpdu = (edge1 * along2.y - edge2 * along1.y) / determinant;
  } else {
    point.dpdu = any_tangent(point.normal);
  }
  return point;
}

BilinearPatch TracedPatches::patch(uint32_t index) const {
  const std::size_t first = std::size_t{4} * index;
  return {position(first), position(first + 1), position(first + 2), position(first + 3)};
}

Vec3d TracedPatches::normal(uint32_t index, double u, double v) const {
  const Vec3d flat = patch(index).normal(u, v);
  bool flip = is_reversed;
  if (!normals.empty()) {
    const uint32_t* corner = &indices[std::size_t{4} * index];
    const BilinearPatch smooth{Vec3d(normals[corner[0]]), Vec3d(normals[corner[1]]),
                               Vec3d(normals[corner[2]]), Vec3d(normals[corner[3]])};
    const double side = flat.dot(smooth.at(u, v));
    if (side != 0) flip = side < 0;
  }
  return flip ? -flat : flat;
}

LocalPoint TracedPatches::describe(uint32_t index, double u, double v) const {
  const BilinearPatch surface = patch(index);
  const uint32_t* corner = &indices[std::size_t{4} * index];
  LocalPoint point;
  point.position = surface.at(u, v);
  point.normal = normal(index, u, v);
  // A patch with a side of length 0 has no normal there; take it a little farther in.
  if (!(point.normal.length2() > 0)) {
    point.normal = normal(index, 0.999 * u + 0.0005, 0.999 * v + 0.0005);
  }
  point.shading_normal = point.normal;
  point.dpdu = surface.dpdu(v);
  point.uv = Vec2f(static_cast<float>(u), static_cast<float>(v));
  if (!normals.empty()) {
    const BilinearPatch smooth{Vec3d(normals[corner[0]]), Vec3d(normals[corner[1]]),
                               Vec3d(normals[corner[2]]), Vec3d(normals[corner[3]])};
    const Vec3d interpolated = smooth.at(u, v);
    if (interpolated.length2() > 0) point.shading_normal = interpolated;
  }
  if (!uvs.empty()) {
    const auto corner_uv = [&](int i) { return Vec3d(uvs[corner[i]].x, uvs[corner[i]].y, 0); };
    const BilinearPatch texture{corner_uv(0), corner_uv(1), corner_uv(2), corner_uv(3)};
    const Vec3d st = texture.at(u, v);
    point.uv = Vec2f(static_cast<float>(st.x), static_cast<float>(st.y));
    const Vec3d du = texture.dpdu(v);
    const Vec3d dv = texture.dpdv(u);
    const double determinant = du.x * dv.y - dv.x * du.y;
    if (std::abs(determinant) >= 1e-9) {
      point.dpdu = (surface.dpdu(v) * dv.y - surface.dpdv(u) * du.y) / determinant;
    }
  }
  if (!(point.dpdu.length2() > 0)) point.dpdu = any_tangent(point.normal);
  return point;
}

LocalPoint TracedQuadric::describe(const Vec3d& near_surface) const {
  const QuadricPoint p = quadric.describe(near_surface, needs_uv);
  LocalPoint point;
  point.position = object_to_part.point(p.position);
  point.normal = part_to_object.normal_back(is_reversed ? -p.normal : p.normal);
  point.shading_normal = point.normal;
  point.dpdu = object_to_part.vector(p.dpdu);
  point.uv = Vec2f(static_cast<float>(p.u), static_cast<float>(p.v));
  return point;
}

Box3d TracedQuadric::bounds() const {
  Box3d around;
  for (const Vec3d& corner : corners_of(quadric.bounds())) {
    around.extendBy(object_to_part.point(corner));
  }
  return around;
}

TracedTriangles trace_triangles(const SurfaceShape& shape, const Vec3d& origin) {
  return {trace_vertices(shape, std::get<TriangleMesh>(shape.geometry), origin)};
}

TracedPatches trace_patches(const SurfaceShape& shape, const Vec3d& origin) {
  return {trace_vertices(shape, std::get<BilinearMesh>(shape.geometry), origin)};
}

TracedQuadric trace_quadric(const SurfaceShape& shape, const Vec3d& origin) {
  const Matrix4d matrix = to_part(shape, origin);
  return {common(shape), Quadric::from(shape.geometry).value(), AffineTransform(matrix),
          AffineTransform(matrix.inverse())};
}

}  // namespace freepath
