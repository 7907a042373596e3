#pragma once
/// @file Spheres, disks and cylinders in double precision, in their object space. Doubles, because
/// then a hit is off by less than the rounding of a float position, however far the ray comes from.

#include <array>
#include <optional>

#include "freepath/base/vector.h"
#include "freepath/geometry/shape_geometry.h"

namespace freepath {

/// Where a line meets a quadric, in ascending order.
struct QuadricRoots {
  std::array<double, 2> t{};
  int count = 0;
};

/// A point of a quadric [object].
struct QuadricPoint {
  Vec3d position;
  Vec3d normal;  ///< dp/du x dp/dv, unit.
  Vec3d dpdu;    ///< Not 0, even at a pole.
  double u = 0, v = 0;
};

enum class QuadricKind { kSphere, kDisk, kCylinder };

/// A sphere, disk or cylinder with its clipping.
class Quadric {
 public:
  explicit Quadric(const Sphere& sphere);
  explicit Quadric(const Disk& disk);
  explicit Quadric(const Cylinder& cylinder);
  /// Nothing for a mesh.
  static std::optional<Quadric> from(const ShapeGeometry& geometry);

  QuadricKind kind() const { return kind_; }
  double radius() const { return radius_; }
  /// Normal at a point of it, of any length but not 0, to the same side as QuadricPoint::normal.
  Vec3d gradient(const Vec3d& point) const {
    if (kind_ == QuadricKind::kDisk) return {0, 0, 1};
    return {point.x, point.y, kind_ == QuadricKind::kSphere ? point.z : 0};
  }
  /// Whether it is a sphere that is not cut.
  bool is_whole_sphere() const {
    return kind_ == QuadricKind::kSphere && phi_max_ >= kFullTurn && z_min_ <= -radius_ &&
           z_max_ >= radius_;
  }

  /// Where the line meets the part of the quadric that is there, on both sides of its origin.
  QuadricRoots intersect(const Vec3d& origin, const Vec3d& direction) const;
  /// What is known of a point near the surface, moved onto it.
  /// @param needs_uv or else u and v are left 0
  QuadricPoint describe(const Vec3d& near_surface, bool needs_uv = true) const;
  Box3d bounds() const;
  /// Whether the surface may meet a parallelepiped; false only if it does not.
  bool may_meet(const std::array<Vec3d, 8>& corners) const;

  /// [object, squared]
  double area() const;
  /// The point of a pair of uniform numbers: uniform in the area of the object space.
  Vec3d sample(double u0, double u1) const;

 private:
  static constexpr double kFullTurn = 6.283185307179586;

  bool keeps(const Vec3d& position) const;

  QuadricKind kind_;
  double radius_;
  double inner_radius_ = 0;  // of a disk
  double z_min_, z_max_;     // the height of a disk, both
  double theta_min_ = 0;     // of a sphere: polar angles of z_min_ and z_max_
  double theta_max_ = 0;
  double phi_max_;  // [radians]
};

}  // namespace freepath
