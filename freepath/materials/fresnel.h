#pragma once
/// @file Reflection and refraction at a smooth interface [Born99, Sec. 1.5].

#include <algorithm>
#include <cmath>
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

/// The reflectance of a conductor with the refractive index eta + i k, relative to outside. An
/// index of 0 reflects all.
inline float fresnel_conductor(float cosine, float eta, float k) {
  if (eta == 0.0F && k == 0.0F) return 1.0F;
  // (a + i b)² = (eta + i k)² - sin² is the square of the index times the refracted cosine. In
  // double, since for large k the shares come very near 1.
  const double c = std::clamp(cosine, 1e-6F, 1.0F);
  const double sine2 = 1.0 - c * c;
  const double real = static_cast<double>(eta) * eta - static_cast<double>(k) * k - sine2;
  const double half_imaginary = static_cast<double>(eta) * k;
  const double modulus = std::sqrt(real * real + 4.0 * half_imaginary * half_imaginary);
  // The larger of a and b by the root, so that nothing cancels in the other.
  const double larger = std::sqrt(0.5 * (modulus + std::abs(real)));
  const double a = real >= 0 ? larger : half_imaginary / larger;
  const double perpendicular = (modulus + c * c - 2.0 * a * c) / (modulus + c * c + 2.0 * a * c);
  const double sum = c * c * modulus + sine2 * sine2;
  const double ratio = (sum - 2.0 * a * c * sine2) / (sum + 2.0 * a * c * sine2);
  return static_cast<float>(0.5 * perpendicular * (1.0 + ratio));
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
