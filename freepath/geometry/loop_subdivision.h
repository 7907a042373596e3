#pragma once
/// @file Loop's subdivision surfaces, for loopsubdiv.

#include <span>
#include <vector>

#include "freepath/geometry/shape_geometry.h"

namespace freepath {

/// Refines a mesh of triangles by Loop's rules [Loop87], with the weights of pbrt-v4 (3/16 at
/// vertices of three edges, 3/(8n) at others), moves the vertices to the limit surface and gives
/// them its normals, the longer the larger the triangles around. Edges of one triangle are the
/// boundary, which becomes a cubic B-spline of its vertices alone.
///
/// As in pbrt-v4 the normals, and with them the outside, are on the side that sees the triangles
/// clockwise: the other one than that of the mesh itself.
/// @param indices three for each triangle; neighbours go around in the same sense
/// @param levels each of which makes four triangles of one
/// @throws Error for indices out of range, an edge of more than two triangles, neighbours of
///   opposite sense, levels not in [0, 12]
TriangleMesh subdivide_loop(std::span<const Vec3d> positions, std::span<const int> indices,
                            int levels);

}  // namespace freepath
