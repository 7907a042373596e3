#include <algorithm>

#include "freepath/materials/inputs.h"
#include "freepath/materials/material_kinds.h"

namespace freepath {
namespace {

/// What a surface scatters to its sides, and how often a path is sent to each.
struct Sides {
  SampledSpectrum reflectance, transmittance;
  float reflected = 0;  ///< Probability.
  bool is_black = false;
};

SampledSpectrum scaled(const SpectrumInput& input, float scale, const SurfacePoint& point,
                       const SurfaceContext& context) {
  SampledSpectrum result = context.textures.evaluate(input, point, context.spectra) * scale;
  for (int i = 0; i < kMaxChannels; ++i) result[i] = std::clamp(result[i], 0.0F, 1.0F);
  return result;
}

float largest_of(const SampledSpectrum& channels, const SurfaceContext& context) {
  float largest = 0;
  for (int i = 0; i < context.spectra.channels(); ++i) largest = std::max(largest, channels[i]);
  return largest;
}

Sides sides_of(const DiffuseTransmissionMaterial& material, const SurfacePoint& point,
               const SurfaceContext& context) {
  Sides sides{scaled(material.reflectance, material.scale, point, context),
              scaled(material.transmittance, material.scale, point, context)};
  const float reflectance = largest_of(sides.reflectance, context);
  const float sum = reflectance + largest_of(sides.transmittance, context);
  sides.is_black = sum == 0;
  if (!sides.is_black) sides.reflected = reflectance / sum;
  return sides;
}

}  // namespace

std::optional<LobeSample> DiffuseTransmissionMaterial::sample(const Vec3f& out,
                                                              RandomStream& random,
                                                              const SurfacePoint& point,
                                                              const SurfaceContext& context) const {
  const Sides sides = sides_of(*this, point, context);
  if (sides.is_black) return std::nullopt;
  const bool reflects = random.uniform() < sides.reflected;
  Vec3f in = sample_cosine_hemisphere(random);
  if (in.z <= 0) return std::nullopt;
  const float probability = reflects ? sides.reflected : 1 - sides.reflected;
  const float pdf = cosine_hemisphere_pdf(in.z) * probability;
  if (reflects == (out.z < 0)) in.z = -in.z;
  return LobeSample{in, (reflects ? sides.reflectance : sides.transmittance) * (1.0F / probability),
                    pdf};
}

MaterialValue DiffuseTransmissionMaterial::evaluate(const Vec3f& out, const Vec3f& in,
                                                    RandomStream& /*random*/,
                                                    const SurfacePoint& point,
                                                    const SurfaceContext& context) const {
  const Sides sides = sides_of(*this, point, context);
  const float pdf = cosine_hemisphere_pdf(in.z);
  if (same_hemisphere(out, in)) return {sides.reflectance * pdf, pdf * sides.reflected};
  return {sides.transmittance * pdf, pdf * (1 - sides.reflected)};
}

SampledSpectrum DiffuseTransmissionMaterial::albedo(const Vec3f& /*out*/, const SurfacePoint& point,
                                                    const SurfaceContext& context) const {
  const Sides sides = sides_of(*this, point, context);
  return sides.reflectance + sides.transmittance;
}

}  // namespace freepath
