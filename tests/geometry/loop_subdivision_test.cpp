#include "freepath/geometry/loop_subdivision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "freepath/base/error.h"

namespace freepath::testing {

namespace {

const std::vector<Vec3d> kOctahedron = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                        {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
const std::vector<int> kOctahedronFaces = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                           2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};

TEST(LoopSubdivision, MakesFourTrianglesOfOne) {
  for (int level = 0; level < 4; ++level) {
    const TriangleMesh mesh = subdivide_loop(kOctahedron, kOctahedronFaces, level);
    const std::size_t faces = std::size_t{8} << (2 * level);
    EXPECT_EQ(mesh.indices.size(), 3 * faces);
    EXPECT_EQ(mesh.positions.size(), faces / 2 + 2);  // Euler
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
  }
}

TEST(LoopSubdivision, VerticesLieWhereTheLimitMaskPutsThem) {
  // A vertex of n edges moves to (1 - n w) p + w Σ neighbours with w = 1 / (n + 3 / (8 β)). Of the
  // octahedron: n = 4, β = 3/32, w = 1/8; the neighbours sum to 0, which leaves half.
  const TriangleMesh octahedron = subdivide_loop(kOctahedron, kOctahedronFaces, 0);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_LT((octahedron.positions[i] - kOctahedron[i] * 0.5).length(), 1e-15);
  }
  // Of a tetrahedron around 0: n = 3, β = 3/16, w = 1/5; the neighbours sum to -p, and
  // 1 - 3/5 - 1/5 = 1/5.
  const std::vector<Vec3d> corners = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  const std::vector<int> faces = {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2};
  const TriangleMesh tetrahedron = subdivide_loop(corners, faces, 0);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT((tetrahedron.positions[i] - corners[i] * 0.2).length(), 1e-15);
  }
}

TEST(LoopSubdivision, LimitPositionsDoNotDependOnTheLevel) {
  const TriangleMesh coarse = subdivide_loop(kOctahedron, kOctahedronFaces, 1);
  const TriangleMesh fine = subdivide_loop(kOctahedron, kOctahedronFaces, 5);
  for (std::size_t i = 0; i < coarse.positions.size(); ++i) {
    EXPECT_LT((coarse.positions[i] - fine.positions[i]).length(), 1e-14) << i;
  }
}

TEST(LoopSubdivision, NormalsArePerpendicularAndOnTheClockwiseSide) {
  const TriangleMesh mesh = subdivide_loop(kOctahedron, kOctahedronFaces, 5);
  std::vector<Vec3d> flat(mesh.positions.size(), Vec3d(0));
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vec3d& p0 = mesh.positions[mesh.indices[i]];
    const Vec3d cross =
        (mesh.positions[mesh.indices[i + 1]] - p0).cross(mesh.positions[mesh.indices[i + 2]] - p0);
    for (int k = 0; k < 3; ++k) flat[mesh.indices[i + k]] += cross;
  }
  for (std::size_t i = 0; i < flat.size(); ++i) {
    EXPECT_LT(flat[i].normalized().dot(Vec3d(mesh.normals[i]).normalized()), -0.999);
    EXPECT_LT(mesh.positions[i].dot(Vec3d(mesh.normals[i])), 0);  // inwards
  }
}

TEST(LoopSubdivision, BoundaryIsTheCubicSplineOfItsVerticesAlone) {
  // A square of 3 x 3 vertices in a plane, its middle raised: the boundary stays in the plane.
  std::vector<Vec3d> positions;
  std::vector<int> faces;
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 3; ++x) positions.emplace_back(x, y, x == 1 && y == 1 ? 5 : 0);
  }
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 2; ++x) {
      const int a = 3 * y + x;
      faces.insert(faces.end(), {a, a + 1, a + 4, a, a + 4, a + 3});
    }
  }
  const TriangleMesh limit = subdivide_loop(positions, faces, 0);
  // Weights 1/5, 3/5, 1/5 along the boundary.
  EXPECT_LT((limit.positions[1] - Vec3d(1, 0, 0)).length(), 1e-15);
  EXPECT_LT((limit.positions[0] - Vec3d(0.2, 0.2, 0)).length(), 1e-15);
  const TriangleMesh fine = subdivide_loop(positions, faces, 4);
  int on_rim = 0;
  for (std::size_t i = 0; i < fine.positions.size(); ++i) {
    EXPECT_LT(fine.normals[i].z, 0);  // the triangles go counterclockwise around +z
    if (fine.positions[i].z == 0) ++on_rim;
  }
  EXPECT_EQ(on_rim, 8 * 16);
}

TEST(LoopSubdivision, BadMeshesAreRefused) {
  const auto message_of = [](const std::vector<int>& faces, int levels) -> std::string {
    try {
      subdivide_loop(kOctahedron, faces, levels);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(message_of({0, 2, 4, 0, 2, 5}, 1).find("from vertex 0 to vertex 2"), std::string::npos);
  EXPECT_NE(message_of({0, 2, 6}, 1).find("vertex 6"), std::string::npos);
  EXPECT_NE(message_of({0, 2}, 1).find("no multiple of 3"), std::string::npos);
  EXPECT_NE(message_of({0, 2, 4}, -1).find("-1 levels"), std::string::npos);
  EXPECT_EQ(message_of({0, 2, 4}, 2), "no error");
}

}  // namespace

}  // namespace freepath::testing
