#include "freepath/geometry/quadric.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freepath {

namespace {
// Stands for the distance from the axis where there is no azimuth.
constexpr double kPoleOffset = 1e-5;

double radians(double degrees) { return std::min(degrees, 360.0) * (std::numbers::pi / 180); }

double azimuth(const Vec3d& p) {
  const double phi = std::atan2(p.y, p.x);
  return phi < 0 ? phi + 2 * std::numbers::pi : phi;
}

/// Where a line meets the set of points at `radius` from the origin; for a cylinder without z.
/// From the point of closest approach, which keeps the digits that b² - 4ac loses far away.
QuadricRoots circle_roots(const Vec3d& origin, const Vec3d& direction, double radius) {
  const double length2 = direction.length2();
  if (!(length2 > 0)) return {};
  const double closest = -origin.dot(direction) / length2;
  const double distance = (origin + direction * closest).length();
  if (!(distance <= radius)) return {};
  const double half = std::sqrt((radius - distance) * (radius + distance) / length2);
  return {{closest - half, closest + half}, half > 0 ? 2 : 0};
}

}  // namespace

Quadric::Quadric(const Sphere& sphere)
    : kind_(QuadricKind::kSphere),
      radius_(sphere.radius),
      z_min_(std::clamp(sphere.z_min, -radius_, radius_)),
      z_max_(std::clamp(sphere.z_max, -radius_, radius_)),
      theta_min_(std::acos(z_min_ / radius_)),
      theta_max_(std::acos(z_max_ / radius_)),
      phi_max_(radians(sphere.phi_max)) {}

Quadric::Quadric(const Disk& disk)
    : kind_(QuadricKind::kDisk),
      radius_(disk.radius),
      inner_radius_(disk.inner_radius),
      z_min_(disk.height),
      z_max_(disk.height),
      phi_max_(radians(disk.phi_max)) {}

Quadric::Quadric(const Cylinder& cylinder)
    : kind_(QuadricKind::kCylinder),
      radius_(cylinder.radius),
      z_min_(cylinder.z_min),
      z_max_(cylinder.z_max),
      phi_max_(radians(cylinder.phi_max)) {}

std::optional<Quadric> Quadric::from(const ShapeGeometry& geometry) {
  if (const auto* sphere = std::get_if<Sphere>(&geometry)) return Quadric(*sphere);
  if (const auto* disk = std::get_if<Disk>(&geometry)) return Quadric(*disk);
  if (const auto* cylinder = std::get_if<Cylinder>(&geometry)) return Quadric(*cylinder);
  return std::nullopt;
}

bool Quadric::keeps(const Vec3d& p) const {
  switch (kind_) {
    case QuadricKind::kSphere:
      if (z_min_ > -radius_ && p.z < z_min_) return false;
      if (z_max_ < radius_ && p.z > z_max_) return false;
      break;
    case QuadricKind::kDisk: {
      const double distance2 = p.x * p.x + p.y * p.y;
      if (distance2 > radius_ * radius_ || distance2 < inner_radius_ * inner_radius_) return false;
      break;
    }
    case QuadricKind::kCylinder:
      if (p.z < z_min_ || p.z > z_max_) return false;
      break;
  }
  return phi_max_ >= kFullTurn || azimuth(p) <= phi_max_;
}

QuadricRoots Quadric::intersect(const Vec3d& origin, const Vec3d& direction) const {
  QuadricRoots all;
  switch (kind_) {
    case QuadricKind::kSphere:
      all = circle_roots(origin, direction, radius_);
      break;
    case QuadricKind::kCylinder:
      all = circle_roots({origin.x, origin.y, 0}, {direction.x, direction.y, 0}, radius_);
      break;
    case QuadricKind::kDisk:
      if (direction.z != 0) all = {{(z_min_ - origin.z) / direction.z, 0}, 1};
      break;
  }
  QuadricRoots kept;
  for (int i = 0; i < all.count; ++i) {
    if (keeps(origin + direction * all.t[i])) kept.t[kept.count++] = all.t[i];
  }
  return kept;
}

QuadricPoint Quadric::describe(const Vec3d& near_surface, bool needs_uv) const {
  QuadricPoint point;
  Vec3d p = near_surface;
  const double axis_distance = std::sqrt(p.x * p.x + p.y * p.y);
  if (needs_uv) point.u = azimuth(p) / phi_max_;
  switch (kind_) {
    case QuadricKind::kSphere:
      p *= radius_ / p.length();
      point.normal = p / radius_;
      if (needs_uv) {
        point.v = (std::acos(std::clamp(p.z / radius_, -1.0, 1.0)) - theta_min_) /
                  (theta_max_ - theta_min_);
      }
      break;
    case QuadricKind::kDisk:
      p.z = z_min_;
      point.normal = {0, 0, 1};
      point.v = (radius_ - axis_distance) / (radius_ - inner_radius_);
      break;
    case QuadricKind::kCylinder:
      p.x *= radius_ / axis_distance;
      p.y *= radius_ / axis_distance;
      point.normal = {p.x / radius_, p.y / radius_, 0};
      point.v = (p.z - z_min_) / (z_max_ - z_min_);
      break;
  }
  point.position = p;
  point.dpdu = axis_distance > 0 ? Vec3d(-p.y, p.x, 0) : Vec3d(0, kPoleOffset * radius_, 0);
  point.dpdu *= phi_max_;
  return point;
}

Box3d Quadric::bounds() const { return {{-radius_, -radius_, z_min_}, {radius_, radius_, z_max_}}; }

bool Quadric::may_meet(const std::array<Vec3d, 8>& corners) const {
  // The box around the corners is as near to the centre as anything within them, and the farthest
  // point of a convex body is a corner.
  Box3d box;
  double farthest = 0;
  const bool whole = kind_ == QuadricKind::kSphere;
  for (const Vec3d& corner : corners) {
    box.extendBy(corner);
    farthest = std::max(farthest, whole ? corner.length() : std::hypot(corner.x, corner.y));
  }
  Vec3d nearest(std::max({box.min.x, 0.0, -box.max.x}), std::max({box.min.y, 0.0, -box.max.y}),
                whole ? std::max({box.min.z, 0.0, -box.max.z}) : 0);
  if (box.max.z < z_min_ || box.min.z > z_max_) return false;
  if (kind_ == QuadricKind::kDisk) {
    return nearest.length() <= radius_ && farthest >= inner_radius_;
  }
  return nearest.length() <= radius_ && farthest >= radius_;
}

double Quadric::area() const {
  if (kind_ == QuadricKind::kDisk) {
    return 0.5 * phi_max_ * (radius_ * radius_ - inner_radius_ * inner_radius_);
  }
  return phi_max_ * radius_ * (z_max_ - z_min_);
}

Vec3d Quadric::sample(double u0, double u1) const {
  const double phi = u0 * phi_max_;
  double distance = radius_;
  double z = z_min_;
  switch (kind_) {
    case QuadricKind::kDisk:
      distance =
          std::sqrt(radius_ * radius_ + u1 * (inner_radius_ * inner_radius_ - radius_ * radius_));
      break;
    case QuadricKind::kSphere:  // by Archimedes, z is uniform
      z += u1 * (z_max_ - z_min_);
      distance = std::sqrt(std::max(0.0, (radius_ - z) * (radius_ + z)));
      break;
    case QuadricKind::kCylinder:
      z += u1 * (z_max_ - z_min_);
      break;
  }
  // In single precision: what is drawn is put onto the surface by describe().
  const auto angle = static_cast<float>(phi);
  return {distance * std::cos(angle), distance * std::sin(angle), z};
}

}  // namespace freepath
