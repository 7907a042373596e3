#include <cmath>

#include "freepath/materials/fresnel.h"
#include "freepath/materials/inputs.h"
#include "freepath/materials/material_kinds.h"

namespace freepath {

namespace {

/// What a pane reflects: the sum over all reflections within it, R + T² R / (1 - R²).
float pane_reflectance(float cosine, float eta) {
  const float r = fresnel_dielectric(cosine, eta);
  return 2.0F * r / (1.0F + r);
}

}  // namespace

std::optional<LobeSample> ThinDielectricMaterial::sample(const Vec3f& out, RandomStream& random,
                                                         const SurfacePoint& /*point*/,
                                                         const SurfaceContext& context) const {
  if (out.z == 0) return std::nullopt;
  const DielectricIndex index = dielectric_index(eta, context);
  SampledSpectrum reflectance;
  float probability = 0;
  for (int i = 0; i < kMaxChannels; ++i) {
    reflectance[i] = pane_reflectance(std::abs(out.z), index.eta[i]);
    if (i < context.spectra.channels()) probability += reflectance[i];
  }
  probability /= static_cast<float>(context.spectra.channels());
  if (random.uniform() < probability) {
    return LobeSample{{-out.x, -out.y, out.z}, reflectance * (1.0F / probability), 0, true};
  }
  return LobeSample{-out, (SampledSpectrum(1) - reflectance) * (1.0F / (1.0F - probability)), 0,
                    true};
}

MaterialValue ThinDielectricMaterial::evaluate(const Vec3f& /*out*/, const Vec3f& /*in*/,
                                               RandomStream& /*random*/,
                                               const SurfacePoint& /*point*/,
                                               const SurfaceContext& /*context*/) const {
  return {};
}

SampledSpectrum ThinDielectricMaterial::albedo(const Vec3f& /*out*/, const SurfacePoint& /*point*/,
                                               const SurfaceContext& /*context*/) const {
  return SampledSpectrum(1);
}

}  // namespace freepath
