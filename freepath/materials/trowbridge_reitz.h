#pragma once
/// @file The distribution of the normals of the facets of a rough surface.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "freepath/base/turn.h"
#include "freepath/base/vector.h"

namespace freepath {

/// The ellipsoid distribution of normals [Trowbridge75], also called GGX [Walter07], with Smith's
/// masking for facets whose height and slope are independent, and correlated heights of the two
/// directions [Heitz14]. Directions are in the frame whose z axis is the mean normal.
class TrowbridgeReitz {
 public:
  /// pbrt-v4's: the roughness of a scene file is more even to the eye than alpha.
  static float alpha_of_roughness(float roughness) { return std::sqrt(std::max(0.0F, roughness)); }

  /// Smaller alphas are a smooth surface, as in pbrt-v4.
  static constexpr float kSmooth = 1e-3F;

  TrowbridgeReitz(float alpha_x, float alpha_y) : alpha_x_(alpha_x), alpha_y_(alpha_y) {
    if (is_smooth()) return;
    // One alpha may be smooth; the square of it must not underflow.
    constexpr float kSmallest = 1e-4F;
    alpha_x_ = std::max(alpha_x_, kSmallest);
    alpha_y_ = std::max(alpha_y_, kSmallest);
  }

  bool is_smooth() const { return !(std::max(alpha_x_, alpha_y_) >= kSmooth); }
  float alpha_x() const { return alpha_x_; }
  float alpha_y() const { return alpha_y_; }

  /// Area of facets per area of the surface and solid angle of their normals [1/sr].
  float density(const Vec3f& facet) const {
    const float x = facet.x / alpha_x_;
    const float y = facet.y / alpha_y_;
    const float length2 = x * x + y * y + facet.z * facet.z;
    return 1.0F / (std::numbers::pi_v<float> * alpha_x_ * alpha_y_ * length2 * length2);
  }

  /// Share of the facets that a direction sees, of those that face it.
  float masking(const Vec3f& direction) const { return 1.0F / (1.0F + lambda(direction)); }
  /// Share of the facets that `b` sees, too, of those that `a` sees.
  float masking_of_other(const Vec3f& a, const Vec3f& b) const {
    const float seen = 1.0F + lambda(a);
    return seen / (seen + lambda(b));
  }

  /// Density of the normals that a direction with z > 0 sees, which sample_visible draws [1/sr].
  float visible_density(const Vec3f& direction, const Vec3f& facet) const {
    return masking(direction) / direction.z * density(facet) * std::max(0.0F, direction.dot(facet));
  }

  /// Draws the normal of a facet that a direction with z > 0 sees: stretched to a hemisphere, the
  /// visible normals are halfway to a uniform point of a spherical cap [Dupuy23].
  Vec3f sample_visible(const Vec3f& direction, float u0, float u1) const {
    const Vec3f stretched =
        Vec3f(direction.x * alpha_x_, direction.y * alpha_y_, direction.z).normalized();
    const SinCos azimuth = sincos_of_turn(u0);
    const float z = (1.0F - u1) * (1.0F + stretched.z) - stretched.z;
    const float sine = std::sqrt(std::clamp(1.0F - z * z, 0.0F, 1.0F));
    const Vec3f half = Vec3f(sine * azimuth.cosine, sine * azimuth.sine, z) + stretched;
    return Vec3f(half.x * alpha_x_, half.y * alpha_y_, std::max(half.z, 1e-12F)).normalized();
  }

 private:
  float lambda(const Vec3f& direction) const {
    const float x = direction.x * alpha_x_;
    const float y = direction.y * alpha_y_;
    const float z2 = direction.z * direction.z;
    // At grazing angles infinite, which the maskings turn into 0.
    return 0.5F * (std::sqrt(1.0F + (x * x + y * y) / z2) - 1.0F);
  }

  float alpha_x_, alpha_y_;
};

}  // namespace freepath
