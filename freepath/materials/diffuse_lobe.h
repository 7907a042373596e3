#pragma once
/// @file Diffuse reflection.

#include <optional>

#include "freepath/materials/lobe_sample.h"

namespace freepath {

/// Reflects the same radiance to all directions on the side where the light comes from.
class DiffuseLobe {
 public:
  explicit DiffuseLobe(const SampledSpectrum& reflectance) : reflectance_(reflectance) {}

  static constexpr bool is_specular() { return false; }

  std::optional<LobeSample> sample(const Vec3f& out, RandomStream& random) const {
    Vec3f in = sample_cosine_hemisphere(random);
    if (in.z <= 0) return std::nullopt;
    const float pdf = cosine_hemisphere_pdf(in.z);
    if (out.z < 0) in.z = -in.z;
    return LobeSample{in, reflectance_, pdf};
  }

  MaterialValue evaluate(const Vec3f& out, const Vec3f& in) const {
    if (!same_hemisphere(out, in)) return {};
    const float pdf = cosine_hemisphere_pdf(in.z);
    return {reflectance_ * pdf, pdf};
  }

  const SampledSpectrum& albedo() const { return reflectance_; }

 private:
  SampledSpectrum reflectance_;
};

}  // namespace freepath
