#pragma once
/// @file Meshes of PLY files (the Stanford polygon format), for plymesh.

#include <string>
#include <string_view>
#include <vector>

#include "freepath/geometry/shape_geometry.h"

namespace freepath {

/// Vertices, and faces of three and of four of them.
struct PlyMesh {
  std::vector<Vec3d> positions;
  std::vector<Vec3f> normals;  ///< One for each position, or none.
  std::vector<Vec2f> uvs;      ///< One for each position, or none.
  std::vector<int> triangles;  ///< Three indices for each.
  /// Four indices for each, in the order of BilinearMesh: the last two of the file's are swapped.
  std::vector<int> quads;

  /// A mesh of the triangles and one of the quads, each if there are any. As in pbrt the triangles
  /// come first, so that SurfaceShape::first_primitive of the quads is the number of triangles.
  std::vector<ShapeGeometry> shapes() const;
};

/// Reads ASCII and both binary formats, packed by gzip or not, whatever the name: x, y, z of the
/// vertices, nx, ny, nz and u, v (or s, t, texture_u, texture_v, texture_s, texture_t) where they
/// are, and the lists vertex_indices or vertex_index of the faces, with numbers of any type. All
/// else is skipped.
/// @throws Error with the file, the place and what to do
PlyMesh read_ply(const std::string& file);

/// @param content of a file
/// @param name of the file, for messages
PlyMesh parse_ply(std::string_view content, const std::string& name);

}  // namespace freepath
