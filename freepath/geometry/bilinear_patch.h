#pragma once
/// @file A bilinear patch in double precision.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "freepath/base/vector.h"

namespace freepath {

/// Where a line meets a patch.
struct PatchRoot {
  double t, u, v;
};
struct PatchRoots {
  std::array<PatchRoot, 2> root{};
  int count = 0;
};

/// The surface (1-u)(1-v) p00 + u (1-v) p10 + (1-u) v p01 + u v p11.
struct BilinearPatch {
  Vec3d p00, p10, p01, p11;

  Vec3d at(double u, double v) const {
    return (p00 * (1 - u) + p10 * u) * (1 - v) + (p01 * (1 - u) + p11 * u) * v;
  }
  Vec3d dpdu(double v) const { return (p10 - p00) * (1 - v) + (p11 - p01) * v; }
  Vec3d dpdv(double u) const { return (p01 - p00) * (1 - u) + (p11 - p10) * u; }
  Vec3d normal(double u, double v) const { return dpdu(v).cross(dpdv(u)); }

  /// Where the line meets it, on both sides of its origin and in ascending order. As [Reshetov19]:
  /// the line meets the straight segment of a u where both lie in a plane, a quadratic in u.
  PatchRoots intersect(const Vec3d& origin, const Vec3d& direction) const {
    const Vec3d to_p00 = p00 - origin;
    const Vec3d along_u = p10 - p00;
    const Vec3d left = p01 - p00;
    const Vec3d right = p11 - p10;
    const double at_0 = to_p00.cross(direction).dot(left);
    const double at_1 = (p10 - origin).cross(direction).dot(right);
    const double square = along_u.cross(direction).dot(right - left);
    const double linear = at_1 - at_0 - square;
    const double discriminant = linear * linear - 4 * square * at_0;
    PatchRoots roots;
    if (!(discriminant >= 0)) return roots;
    const double q = -0.5 * (linear + std::copysign(std::sqrt(discriminant), linear));
    const std::array<double, 2> us = {at_0 / q, q / square};  // not finite where there is no root
    for (const double u : us) {
      if (!(u >= -kSlack && u <= 1 + kSlack)) continue;
      const Vec3d from = to_p00 + along_u * u;
      const Vec3d segment = left + (right - left) * u;
      const Vec3d across = segment.cross(direction);
      const double v = -from.cross(direction).dot(across) / across.length2();
      if (!(v >= -kSlack && v <= 1 + kSlack)) continue;
      const double t = (from + segment * v).dot(direction) / direction.length2();
      roots.root[roots.count++] = {t, std::clamp(u, 0.0, 1.0), std::clamp(v, 0.0, 1.0)};
    }
    if (roots.count == 2 && roots.root[1].t < roots.root[0].t) {
      std::swap(roots.root[0], roots.root[1]);
    }
    return roots;
  }

 private:
  static constexpr double kSlack = 1e-12;  // so that no ray slips through between two patches
};

}  // namespace freepath
