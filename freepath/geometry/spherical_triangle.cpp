#include "freepath/geometry/spherical_triangle.h"

#include <algorithm>
#include <cmath>

namespace freepath {

namespace {

/// The unit vector along the part of v that is perpendicular to a unit vector.
Vec3d perpendicular(const Vec3d& v, const Vec3d& unit) {
  return (v - unit * v.dot(unit)).normalized();
}

double sine(double cosine) { return std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine))); }

}  // namespace

SphericalTriangle::SphericalTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c)
    : a_(a.normalized()), b_(b.normalized()), c_(c.normalized()) {
  solid_angle_ =
      2 * std::atan2(std::abs(a_.dot(b_.cross(c_))), 1 + a_.dot(b_) + b_.dot(c_) + c_.dot(a_));
}

Vec3d SphericalTriangle::sample(double u0, double u1) const {
  // The angle at a, between the planes through b and through c.
  const Vec3d normal_b = a_.cross(b_);
  const Vec3d normal_c = a_.cross(c_);
  const double alpha = std::atan2(normal_b.cross(normal_c).length(), normal_b.dot(normal_c));
  const double cos_alpha = std::cos(alpha);
  const double sin_alpha = std::sin(alpha);
  const double cos_side = a_.dot(b_);
  // The corner on the arc from a to c that cuts off a part u0 of the area.
  const double s = std::sin(u0 * solid_angle_ - alpha);
  const double t = std::cos(u0 * solid_angle_ - alpha);
  const double u = t - cos_alpha;
  const double v = s + sin_alpha * cos_side;
  const double numerator = (v * t - u * s) * cos_alpha - v;
  const double denominator = (v * s + u * t) * sin_alpha;
  const double q = denominator != 0 ? std::clamp(numerator / denominator, -1.0, 1.0) : 1;
  const Vec3d corner = a_ * q + perpendicular(c_, a_) * sine(q);
  // A point of the arc from b to that corner, uniform in the height above b.
  const double z = 1 - u1 * (1 - corner.dot(b_));
  return b_ * z + perpendicular(corner, b_) * sine(z);
}

}  // namespace freepath
