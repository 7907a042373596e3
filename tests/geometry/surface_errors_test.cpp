// Shapes that can't be.

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "freepath/base/error.h"
#include "freepath/geometry/surfaces.h"
#include "tests/geometry/surface_rays.h"

namespace freepath::testing {
namespace {

std::string message_of(const SurfaceShape& shape) {
  try {
    surfaces_of(shape);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Surfaces, BadGeometryIsRefusedWithWhatAndWhere) {
  TriangleMesh mesh = cube(1);
  mesh.indices[7] = 8;
  EXPECT_EQ(message_of(shape_of(mesh, Matrix4d(), 4)),
            "shape 4: triangle 2 refers to vertex 8, but there are only vertices 0 to 7");
  mesh = cube(1);
  mesh.indices.pop_back();
  EXPECT_NE(message_of(shape_of(mesh)).find("no multiple of 3"), std::string::npos);
  mesh = cube(1);
  mesh.positions[3].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message_of(shape_of(mesh)).find("positions of vertex 3"), std::string::npos);
  mesh = cube(1);
  mesh.normals.resize(7, Vec3f(1));
  EXPECT_NE(message_of(shape_of(mesh)).find("7 normals"), std::string::npos);
  EXPECT_NE(message_of(shape_of(Sphere{0})).find("radius is 0"), std::string::npos);
  EXPECT_NE(message_of(shape_of(Sphere{1, 0.5, 0.5})).find("zmin < zmax"), std::string::npos);
  EXPECT_NE(message_of(shape_of(Sphere{1, 2, 3})).find("holds nothing"), std::string::npos);
  EXPECT_NE(message_of(shape_of(Cylinder{1, 1, -1})).find("zmin < zmax"), std::string::npos);
  EXPECT_NE(message_of(shape_of(Disk{0, 1, 1})).find("innerradius"), std::string::npos);
  EXPECT_NE(message_of(shape_of(Disk{0, 1, 0, 0})).find("phimax"), std::string::npos);
  Matrix4d flat;
  flat.setScale(Vec3d(1, 1, 0));
  EXPECT_NE(message_of(shape_of(Sphere{}, flat)).find("no inverse"), std::string::npos);
  SurfaceScene scene;
  scene.instances.push_back({3, Matrix4d()});
  EXPECT_THROW(Surfaces(scene, Vec3d(0)), Error);
}

}  // namespace
}  // namespace freepath::testing
