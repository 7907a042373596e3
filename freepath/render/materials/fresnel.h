#pragma once
/// @file Reflection and refraction at a smooth interface [Born99, Sec. 1.5].

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>

#include "freepath/base/vector.h"

namespace freepath {

/// Share of unpolarised light that the interface to a dielectric reflects; 1 beyond the critical
/// angle.
/// @param cosine of the angle to the normal, on the side of the light, ≥ 0
/// @param eta refractive index of the far side relative to that of the side of the light
inline float fresnel_dielectric(float cosine, float eta) {
  const float cosine_i = std::clamp(cosine, 0.0F, 1.0F);
  const float sine2_t = (1.0F - cosine_i * cosine_i) / (eta * eta);
  if (sine2_t >= 1.0F) return 1.0F;
  const float cosine_t = std::sqrt(1.0F - sine2_t);
  const float parallel = (eta * cosine_i - cosine_t) / (eta * cosine_i + cosine_t);
  const float perpendicular = (cosine_i - eta * cosine_t) / (cosine_i + eta * cosine_t);
  return 0.5F * (parallel * parallel + perpendicular * perpendicular);
}

/// The same of a conductor with the refractive index eta + i k, relative to outside. An index of 0
/// reflects all.
inline float fresnel_conductor(float cosine, float eta, float k) {
  if (eta == 0.0F && k == 0.0F) return 1.0F;
  const std::complex<double> index(eta, k);
  const double c = std::clamp(cosine, 0.0F, 1.0F);
  const std::complex<double> cosine_t = std::sqrt(1.0 - (1.0 - c * c) / (index * index));
  const double parallel = std::norm(index * c - cosine_t) / std::norm(index * c + cosine_t);
  const double perpendicular = std::norm(c - index * cosine_t) / std::norm(c + index * cosine_t);
  return static_cast<float>(0.5 * (parallel + perpendicular));
}

/// Mirrors a direction about a normal; both point away from the surface.
inline Vec3f reflected(const Vec3f& out, const Vec3f& normal) {
  return normal * (2.0F * out.dot(normal)) - out;
}

/// The refracted direction, pointing away from the surface on the far side; nothing beyond the
/// critical angle.
/// @param normal unit, on the side of `out`
/// @param eta refractive index of the far side relative to that of the side of `out`
inline std::optional<Vec3f> refracted(const Vec3f& out, const Vec3f& normal, float eta) {
  const float cosine_i = out.dot(normal);
  const float sine2_t = std::max(0.0F, 1.0F - cosine_i * cosine_i) / (eta * eta);
  if (sine2_t >= 1.0F) return std::nullopt;
  const float cosine_t = std::sqrt(1.0F - sine2_t);
  return out * (-1.0F / eta) + normal * (cosine_i / eta - cosine_t);
}

}  // namespace freepath
