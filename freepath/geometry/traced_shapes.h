#pragma once
/// @file Shapes as rays meet them, in the space of their part of the scene: the world relative to
/// the origin of the rays, or a group relative to its middle. Internal to this folder.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/geometry/affine_transform.h"
#include "freepath/geometry/bilinear_patch.h"
#include "freepath/geometry/quadric.h"
#include "freepath/geometry/shape_geometry.h"

namespace freepath {

/// A ray in the space of a part.
struct LocalRay {
  Vec3d origin, direction;
};

/// A point of a surface in the space of a part. Vectors have any length.
struct LocalPoint {
  Vec3d position;
  Vec3d normal;
  Vec3d shading_normal;
  Vec3d dpdu;
  Vec2f uv;
};

/// Where a line meets a surface.
struct LinePoint {
  double t = 0;       ///< Not finite where the surface is parallel to the line.
  Vec3d normal{0};    ///< Normal of any length, to either side [part].
  double across = 0;  ///< normal · direction
};

/// Members that all kinds of traced shapes share.
struct TracedShape {
  uint32_t shape = 0;
  uint32_t first_primitive = 0;
  bool is_boundary = false;
  bool is_reversed = false;  ///< The outside is not where the normal of the coordinates points.
  bool needs_uv = true;      ///< SurfaceShape::needs_uv
  Box3d box{};               ///< Box around it [part], once it is in a TracedPart.
};

/// Vertices rounded to floats, which are what the surface is from there on.
struct TracedVertices : TracedShape {
  /// Positions, and one more: what traces them reads four floats at each.
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;  ///< Normals to the outside, of any length.
  std::vector<Vec2f> uvs;
  std::vector<uint32_t> indices;

  Vec3d position(std::size_t corner) const { return Vec3d(positions[indices[corner]]); }
  /// The box around all positions.
  /// @param looked_at counts them
  Box3d bounds(uint64_t& looked_at) const;
};

struct TracedTriangles : TracedVertices {
  uint32_t count() const { return static_cast<uint32_t>(indices.size() / 3); }
  /// The normal along (p1 - p0) x (p2 - p0), twice as long as the area.
  Vec3d plane_normal(uint32_t triangle) const;
  /// The normal to the outside at these barycentric coordinates of the second and third corner.
  Vec3d normal(uint32_t triangle, float u, float v) const;
  /// Where a line meets the plane of a triangle. In doubles, so that a ray that starts a few
  /// roundings off the plane never meets it again.
  LinePoint meet_plane(uint32_t triangle, const LocalRay& ray) const;
  LocalPoint describe(uint32_t triangle, float u, float v) const;
  /// Describes a point, by its position on the ray where that does not graze the triangle: it has
  /// more digits than the barycentric coordinates.
  LocalPoint describe(uint32_t triangle, float u, float v, const LocalRay& ray) const;
};

struct TracedPatches : TracedVertices {
  uint32_t count() const { return static_cast<uint32_t>(indices.size() / 4); }
  BilinearPatch patch(uint32_t index) const;
  /// The normal to the outside.
  Vec3d normal(uint32_t index, double u, double v) const;
  /// @param u, v of the patch, which need not be the texture coordinates
  LocalPoint describe(uint32_t index, double u, double v) const;
};

struct TracedQuadric : TracedShape {
  Quadric quadric;
  AffineTransform object_to_part, part_to_object;

  LocalRay to_object(const LocalRay& ray) const {
    return {part_to_object.point(ray.origin), part_to_object.vector(ray.direction)};
  }
  LocalPoint describe(const Vec3d& near_surface) const;
  Box3d bounds() const;
};

/// @param origin of the part's space
TracedTriangles trace_triangles(const SurfaceShape& shape, const Vec3d& origin);
TracedPatches trace_patches(const SurfaceShape& shape, const Vec3d& origin);
TracedQuadric trace_quadric(const SurfaceShape& shape, const Vec3d& origin);

}  // namespace freepath
