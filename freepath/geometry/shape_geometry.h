#pragma once
/// @file Shapes of a scene as plain data, with the parameterisation and the sides of pbrt-v4.
///
/// Everything is in the shape's object space. A point of it is a row: `point * object_to_world`.
/// Angles are in degrees, lengths in units of the object space.
///
/// The outside is where the geometric normal points:
///   - quadrics: dp/du x dp/dv of the object space, the outward side of spheres and cylinders and
///     +z of disks. ReverseOrientation flips it, and so does an object_to_world that swaps
///     handedness (a mirrored sphere is inside out);
///   - meshes without normals: the side that sees the vertices counterclockwise, patches that of
///     dp/du x dp/dv, both as in the object space: a mirror does not turn them over.
///     ReverseOrientation does;
///   - meshes with normals: the side of the interpolated normals, which ReverseOrientation negates.
/// The transform of an instance never flips a side.

#include <Imath/ImathVec.h>

#include <cstdint>
#include <limits>
#include <variant>
#include <vector>

#include "freepath/base/vector.h"

namespace freepath {

using Vec2f = Imath::V2f;

/// Triangles. Without uvs the corners of each have (0,0), (1,0), (1,1).
struct TriangleMesh {
  std::vector<Vec3d> positions;
  std::vector<Vec3f> normals;  ///< One for each position, or none; a longer one counts for more.
  std::vector<Vec2f> uvs;      ///< One for each position, or none.
  std::vector<int> indices;    ///< Three for each triangle.
};

/// Bilinear patches. The corners of each are at (u, v) = (0,0), (1,0), (0,1), (1,1), in this order.
struct BilinearMesh {
  std::vector<Vec3d> positions;
  std::vector<Vec3f> normals;  ///< One for each position, or none; a longer one counts for more.
  std::vector<Vec2f> uvs;      ///< One for each position, or none: those of the patch then.
  std::vector<int> indices;    ///< Four for each patch.
};

/// A sphere around the origin, or a part of it. u grows with the azimuth from +x to +y, v from
/// z_min to z_max with the angle.
struct Sphere {
  double radius = 1;
  double z_min = -std::numeric_limits<double>::infinity();  ///< Clamped to [-radius, radius].
  double z_max = std::numeric_limits<double>::infinity();
  double phi_max = 360;
};

/// A disk or ring in the plane z = height. v is 0 at the rim, 1 at inner_radius.
struct Disk {
  double height = 0;
  double radius = 1;
  double inner_radius = 0;
  double phi_max = 360;
};

/// A cylinder around the z axis, open at both ends. v grows linearly with z.
struct Cylinder {
  double radius = 1;
  double z_min = -1;
  double z_max = 1;
  double phi_max = 360;
};

using ShapeGeometry = std::variant<TriangleMesh, BilinearMesh, Sphere, Disk, Cylinder>;

/// A shape in its place.
struct SurfaceShape {
  ShapeGeometry geometry;
  Matrix4d object_to_world;  ///< Leads to the space of the group, if the shape is in one.
  bool reverse_orientation = false;
  /// Whether nothing happens there but a change of medium: pbrt's material "interface".
  bool is_boundary = false;
  uint32_t shape = 0;  ///< Number among the scene's shapes; several may bear the same.
  /// Number of the first triangle or patch, where a shape is made of more than one mesh.
  uint32_t first_primitive = 0;
  /// Whether its texture coordinates are read. Otherwise quadrics, which take two inverse
  /// trigonometric functions for them, leave them 0.
  bool needs_uv = true;
};

/// A copy of a group. A point of it goes through the shape's object_to_world first and then through
/// this instance_to_world.
struct SurfaceInstance {
  uint32_t group = 0;
  Matrix4d instance_to_world;
};

/// All shapes of a scene.
struct SurfaceScene {
  std::vector<SurfaceShape> shapes;
  std::vector<std::vector<SurfaceShape>> groups;  ///< Seen only in instances.
  std::vector<SurfaceInstance> instances;
};

/// The number of triangles or patches; 1 for a quadric.
uint32_t primitive_count(const ShapeGeometry& geometry);

/// @throws Error that names what is wrong and where: counts that do not fit, indices out of range,
///   positions that are not finite, a radius of 0, an empty range, a transform without an inverse
void check(const SurfaceShape& shape);

}  // namespace freepath
