#pragma once
/// @file Light that a smooth sphere refracts, from a point outside to one inside.

#include <optional>

#include "freepath/base/vector.h"

namespace freepath {

/// Where light from outside enters a sphere on its way to a point inside.
struct SphereEntry {
  Vec3d position;
  Vec3d normal;       ///< Unit, outward.
  double cosine = 0;  ///< Cosine of the refracted ray to the normal, inside.
  double spread = 0;  ///< Area at the point outside, across the ray, over solid angle at the point
                      ///< inside; the square of the distance if nothing is refracted.
};

/// A sphere filled with one refractive index.
///
/// Rays from a point inside stay in the plane through it, the centre and the axis that joins them,
/// hence the place where they leave is the root of a function of one angle. Of several ways between
/// two points only one is told: the one that leaves on the side of the point inside, before the
/// angle of incidence is largest or reflection total, if there is one, where that function grows;
/// else the one beyond, if the point outside lies further round than all that is seen by rays at
/// the beginning of that part, which has one root then.
class RefractingSphere {
 public:
  /// @param eta refractive index inside, relative to outside
  RefractingSphere(const Vec3d& center, double radius, double eta)
      : center_(center), radius_(radius), eta_(eta) {}

  const Vec3d& center() const { return center_; }
  double radius() const { return radius_; }
  double eta() const { return eta_; }
  /// Whether a point is inside, by more than rounding.
  bool holds(const Vec3d& point) const {
    constexpr double kRounding = 1e-6;
    return (point - center_).length() < radius_ * (1 - kRounding);
  }

  /// Finds where light enters, for a point that the sphere holds and one that is outside.
  std::optional<SphereEntry> find(const Vec3d& inside, const Vec3d& outside) const;
  /// The same for a place on the sphere where it is known to enter, if it is the one that `find`
  /// finds.
  std::optional<SphereEntry> at(const Vec3d& inside, const Vec3d& outside,
                                const Vec3d& entry) const;

 private:
  class Plane;

  Vec3d center_;
  double radius_, eta_;
};

}  // namespace freepath
