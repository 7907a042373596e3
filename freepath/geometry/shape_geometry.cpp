#include "freepath/geometry/shape_geometry.h"

#include <cmath>
#include <cstddef>
#include <string_view>

#include "freepath/base/counted.h"
#include "freepath/base/error.h"

namespace freepath {

namespace {

bool is_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool is_finite(const Vec3f& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool is_finite(const Vec2f& v) { return std::isfinite(v.x) && std::isfinite(v.y); }

template <class Values>
void check_vertices(const Values& values, std::size_t positions, std::string_view what) {
  if (!values.empty() && values.size() != positions) {
    fail("a mesh of {} has {}; give one for each position, or none", counted(positions, "position"),
         counted(values.size(), what.substr(0, what.size() - 1)));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!is_finite(values[i])) fail("the {} of vertex {} are not finite; mend the mesh", what, i);
  }
}

template <class Mesh>
void check_mesh(const Mesh& mesh, std::size_t corners, const char* face) {
  if (mesh.positions.empty()) fail("the mesh has no positions; give it at least one {}", face);
  if (mesh.indices.empty()) fail("the mesh has no indices; give it at least one {}", face);
  if (mesh.indices.size() % corners != 0) {
    fail("{} indices are no multiple of {}, so the last {} is incomplete; complete or remove it",
         mesh.indices.size(), corners, face);
  }
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const int vertex = mesh.indices[i];
    if (vertex < 0 || static_cast<std::size_t>(vertex) >= mesh.positions.size()) {
      fail("{} {} refers to vertex {}, but there are only vertices 0 to {}", face, i / corners,
           vertex, mesh.positions.size() - 1);
    }
  }
  check_vertices(mesh.positions, mesh.positions.size(), "positions");
  check_vertices(mesh.normals, mesh.positions.size(), "normals");
  check_vertices(mesh.uvs, mesh.positions.size(), "uvs");
}

void check_positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value)) {
    fail("the {} is {}; it has to be positive and finite", what, value);
  }
}

void check_range(double z_min, double z_max) {
  if (!(z_min < z_max)) fail("the range of z from {} to {} is empty; zmin < zmax", z_min, z_max);
}

void check_geometry(const TriangleMesh& mesh) { check_mesh(mesh, 3, "triangle"); }
void check_geometry(const BilinearMesh& mesh) { check_mesh(mesh, 4, "patch"); }

void check_geometry(const Sphere& sphere) {
  check_positive(sphere.radius, "radius");
  check_positive(sphere.phi_max, "phimax");
  check_range(sphere.z_min, sphere.z_max);
  if (sphere.z_min >= sphere.radius || sphere.z_max <= -sphere.radius) {
    fail("the range of z from {} to {} holds nothing of a sphere of radius {}", sphere.z_min,
         sphere.z_max, sphere.radius);
  }
}

void check_geometry(const Disk& disk) {
  check_positive(disk.radius, "radius");
  check_positive(disk.phi_max, "phimax");
  if (!std::isfinite(disk.height)) fail("the height is {}; it has to be finite", disk.height);
  if (!(disk.inner_radius >= 0 && disk.inner_radius < disk.radius)) {
    fail("the innerradius is {}; it has to be at least 0 and less than the radius, {}",
         disk.inner_radius, disk.radius);
  }
}

void check_geometry(const Cylinder& cylinder) {
  check_positive(cylinder.radius, "radius");
  check_positive(cylinder.phi_max, "phimax");
  check_range(cylinder.z_min, cylinder.z_max);
  if (!std::isfinite(cylinder.z_min) || !std::isfinite(cylinder.z_max)) {
    fail("zmin is {} and zmax {}; they have to be finite", cylinder.z_min, cylinder.z_max);
  }
}

struct Count {
  uint32_t operator()(const TriangleMesh& mesh) const {
    return static_cast<uint32_t>(mesh.indices.size() / 3);
  }
  uint32_t operator()(const BilinearMesh& mesh) const {
    return static_cast<uint32_t>(mesh.indices.size() / 4);
  }
  template <class Quadric>
  uint32_t operator()(const Quadric& /*quadric*/) const {
    return 1;
  }
};

}  // namespace

uint32_t primitive_count(const ShapeGeometry& geometry) { return std::visit(Count(), geometry); }

void check(const SurfaceShape& shape) {
  const Matrix4d& m = shape.object_to_world;
  bool usable = m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) usable = usable && std::isfinite(m[row][column]);
  }
  const double determinant = usable ? m.determinant() : 0;
  if (!(std::abs(determinant) > 0)) {
    fail("the transform of the shape is not affine or has no inverse; scale by nothing but 0");
  }
  std::visit([](const auto& geometry) { check_geometry(geometry); }, shape.geometry);
}

}  // namespace freepath
