#include "freepath/lights/light_bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freepath {
namespace {

float sine_of(float cosine) { return std::sqrt(std::max(0.0F, 1.0F - cosine * cosine)); }

double angle_of(float cosine) {
  return std::acos(std::clamp(static_cast<double>(cosine), -1.0, 1.0));
}

/// An angle between 0 and π by its cosine and sine.
struct Angle {
  float cosine, sine;
};

/// a - b, or 0 where b is larger.
Angle subtract(const Angle& a, const Angle& b) {
  if (a.cosine > b.cosine) return {1, 0};
  return {a.cosine * b.cosine + a.sine * b.sine, a.sine * b.cosine - a.cosine * b.sine};
}

}  // namespace

DirectionCone unite(const DirectionCone& a, const DirectionCone& b) {
  const DirectionCone& wide = a.cosine <= b.cosine ? a : b;
  const DirectionCone& narrow = a.cosine <= b.cosine ? b : a;
  const double wide_angle = angle_of(wide.cosine);
  const double narrow_angle = angle_of(narrow.cosine);
  // By the chord, since the cosine has no digits left for small angles.
  const double chord = (Vec3d(wide.axis) - Vec3d(narrow.axis)).length();
  const double between = 2 * std::asin(std::min(1.0, 0.5 * chord));
  if (std::min(between + narrow_angle, std::numbers::pi) <= wide_angle) return wide;
  const double angle = 0.5 * (wide_angle + between + narrow_angle);
  const Vec3d across =
      Vec3d(narrow.axis) - Vec3d(wide.axis) * Vec3d(wide.axis).dot(Vec3d(narrow.axis));
  if (angle >= std::numbers::pi || across.length() < 1e-12) return {wide.axis, -1};
  const double turn = angle - wide_angle;
  const Vec3d axis = Vec3d(wide.axis) * std::cos(turn) + across.normalized() * std::sin(turn);
  return {Vec3f(axis.normalized()), static_cast<float>(std::cos(angle))};
}

LightBounds unite(const LightBounds& a, const LightBounds& b) {
  LightBounds both = a;
  both.box.extendBy(b.box);
  both.normals = unite(a.normals, b.normals);
  both.cosine_reach = std::min(a.cosine_reach, b.cosine_reach);
  both.two_sided = a.two_sided || b.two_sided;
  both.power = a.power + b.power;
  return both;
}

float importance(const LightBounds& bounds, const Vec3f& position) {
  const Vec3f centre = bounds.box.center();
  const float radius2 = 0.25F * bounds.box.size().length2();
  const Vec3f away = position - centre;
  const float distance2 = away.length2();
  constexpr float kLeastDistance2 = 1e-20F;
  const float attenuation =
      static_cast<float>(bounds.power) / std::max({distance2, radius2, kLeastDistance2});
  if (distance2 <= std::max(radius2, kLeastDistance2)) return attenuation;  // any angle is possible
  float cosine = bounds.normals.axis.dot(away) / std::sqrt(distance2);
  if (bounds.two_sided) cosine = std::abs(cosine);
  cosine = std::clamp(cosine, -1.0F, 1.0F);
  // The angle from the axis, less that of the cone, less that of the box as seen from the point.
  const float seen_sine2 = radius2 / distance2;
  const Angle beyond =
      subtract({cosine, sine_of(cosine)}, {bounds.normals.cosine, sine_of(bounds.normals.cosine)});
  const Angle least = subtract(beyond, {std::sqrt(1.0F - seen_sine2), std::sqrt(seen_sine2)});
  constexpr float kRounding = 1e-4F;
  if (least.cosine < bounds.cosine_reach - kRounding) return 0;
  // Where the cosine is next to 0 rounding must not make it none.
  constexpr float kLeastCosine = 1e-2F;
  return attenuation * std::max(least.cosine, kLeastCosine);
}

double orientation_cost(const LightBounds& bounds) {
  const double spread = angle_of(bounds.normals.cosine);
  const double reach = std::min(spread + angle_of(bounds.cosine_reach), std::numbers::pi);
  return 2 * std::numbers::pi * (1 - std::cos(spread)) +
         0.5 * std::numbers::pi *
             (2 * reach * std::sin(spread) - std::cos(spread - 2 * reach) -
              2 * spread * std::sin(spread) + std::cos(spread));
}

}  // namespace freepath
