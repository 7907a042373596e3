#include "freepath/materials/inputs.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace freepath {

bool Roughness::is_smooth() const {
  const float* const along_u = std::get_if<float>(&u);
  const float* const along_v = std::get_if<float>(&v);
  if (along_u == nullptr || along_v == nullptr) return false;
  const float largest = std::max(*along_u, *along_v);
  return TrowbridgeReitz(remap ? TrowbridgeReitz::alpha_of_roughness(largest) : largest, 0)
      .is_smooth();
}

TrowbridgeReitz microfacets_at(const Roughness& roughness, const SurfacePoint& point,
                               const SurfaceContext& context) {
  const float u = context.textures.evaluate(roughness.u, point);
  const float v = context.textures.evaluate(roughness.v, point);
  if (!roughness.remap) return {u, v};
  return {TrowbridgeReitz::alpha_of_roughness(u), TrowbridgeReitz::alpha_of_roughness(v)};
}

SampledSpectrum reflectance_at(const SpectrumInput& reflectance, const SurfacePoint& point,
                               const SurfaceContext& context) {
  SampledSpectrum result = context.textures.evaluate(reflectance, point, context.spectra);
  for (int i = 0; i < kMaxChannels; ++i) result[i] = std::clamp(result[i], 0.0F, 1.0F);
  return result;
}

ConductorLobe conductor_at(const ConductorIndex& index, const Roughness& roughness, float outside,
                           const SurfacePoint& point, const SurfaceContext& context) {
  const TrowbridgeReitz facets = microfacets_at(roughness, point, context);
  const float scale = 1.0F / outside;
  if (const auto* const complex = std::get_if<ComplexIndex>(&index)) {
    return {facets, context.textures.evaluate(complex->eta, point, context.spectra) * scale,
            context.textures.evaluate(complex->k, point, context.spectra) * scale};
  }
  const auto& given = *std::get_if<NormalReflectance>(&index);
  SampledSpectrum k = reflectance_at(given.reflectance, point, context);
  constexpr float kLargest = 0.9999F;  // as in pbrt-v4: k would be infinite for 1
  for (int i = 0; i < kMaxChannels; ++i) {
    // F = k² / (4 + k²) at normal incidence for eta = 1.
    const float r = std::min(k[i], kLargest);
    k[i] = 2.0F * std::sqrt(r / (1.0F - r));
  }
  return {facets, SampledSpectrum(scale), k * scale};
}

DielectricIndex dielectric_index(SpectrumId eta, const SurfaceContext& context) {
  DielectricIndex index{context.spectra[eta]};
  for (int i = 0; i < kMaxChannels; ++i) {
    if (!(index.eta[i] > 0)) index.eta[i] = 1;
  }
  index.hero = index.eta[context.hero];
  for (int i = 0; i < context.spectra.channels(); ++i) {
    index.parts = index.parts || index.eta[i] != index.hero;
  }
  return index;
}

SampledSpectrum hero_alone(float value, const SurfaceContext& context) {
  SampledSpectrum result;
  result[context.hero] = value * context.hero_factor();
  return result;
}

}  // namespace freepath
