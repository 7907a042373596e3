#pragma once
/// @file One shape of each kind, whole and cut, with its parameterisation.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "freepath/geometry/shape_geometry.h"

namespace freepath::testing {

/// A shape and its parameterisation in the object space, written down from pbrt's documentation.
struct ShapeReference {
  ShapeGeometry geometry;
  Vec3d (*at)(const ShapeGeometry&, double u, double v);
};

inline Vec3d at_sphere(const ShapeGeometry& geometry, double u, double v) {
  const auto& s = std::get<Sphere>(geometry);
  const double theta_min = std::acos(std::clamp(s.z_min / s.radius, -1.0, 1.0));
  const double theta_max = std::acos(std::clamp(s.z_max / s.radius, -1.0, 1.0));
  const double theta = theta_min + v * (theta_max - theta_min);
  const double phi = u * s.phi_max * std::numbers::pi / 180;
  return Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)) *
         s.radius;
}

inline Vec3d at_disk(const ShapeGeometry& geometry, double u, double v) {
  const auto& d = std::get<Disk>(geometry);
  const double r = d.radius + v * (d.inner_radius - d.radius);
  const double phi = u * d.phi_max * std::numbers::pi / 180;
  return {r * std::cos(phi), r * std::sin(phi), d.height};
}

inline Vec3d at_cylinder(const ShapeGeometry& geometry, double u, double v) {
  const auto& c = std::get<Cylinder>(geometry);
  const double phi = u * c.phi_max * std::numbers::pi / 180;
  return {c.radius * std::cos(phi), c.radius * std::sin(phi), c.z_min + v * (c.z_max - c.z_min)};
}

inline Vec3d at_patch(const ShapeGeometry& geometry, double u, double v) {
  const auto& p = std::get<BilinearMesh>(geometry).positions;
  return (p[0] * (1 - u) + p[1] * u) * (1 - v) + (p[2] * (1 - u) + p[3] * u) * v;
}

inline Vec3d at_triangle(const ShapeGeometry& geometry, double u, double v) {
  // The default texture coordinates of the corners are (0,0), (1,0), (1,1).
  const auto& p = std::get<TriangleMesh>(geometry).positions;
  return p[0] * (1 - u) + p[1] * (u - v) + p[2] * v;
}

inline std::vector<ShapeReference> references() {
  TriangleMesh triangle;
  triangle.positions = {{-1, -0.8, 0.1}, {1.2, -0.7, -0.2}, {0.3, 1.1, 0.4}};
  triangle.indices = {0, 1, 2};
  BilinearMesh patch;
  patch.positions = {{-1, -1, 0}, {1, -1, 0.5}, {-1, 1, 0.4}, {1.2, 1, -0.6}};
  patch.indices = {0, 1, 2, 3};
  return {{Sphere{}, at_sphere},     {Sphere{1.2, -0.7, 0.9, 250}, at_sphere},
          {Disk{}, at_disk},         {Disk{0.3, 1.1, 0.4, 200}, at_disk},
          {Cylinder{}, at_cylinder}, {Cylinder{0.9, -0.5, 1.3, 300}, at_cylinder},
          {patch, at_patch},         {triangle, at_triangle}};
}

}  // namespace freepath::testing
