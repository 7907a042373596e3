#include "freepath/materials/dielectric_interface.h"
#include "freepath/materials/fresnel.h"
#include "freepath/materials/inputs.h"
#include "freepath/materials/material_kinds.h"

namespace freepath {

namespace {

/// What a reflection of the hero with this value is in all channels, whose directions are the same.
SampledSpectrum reflected_in_all(float value, const DielectricIndex& index, const Vec3f& out,
                                 const Vec3f& in) {
  if (!index.parts) return SampledSpectrum(value);
  const float cosine = DielectricInterface::reflection_cosine(out, in);
  const auto reflectance = [&](float eta) {
    return fresnel_dielectric(cosine, out.z > 0 ? eta : 1.0F / eta);
  };
  const float of_hero = reflectance(index.hero);
  SampledSpectrum result;
  if (!(of_hero > 0)) return result;
  for (int i = 0; i < kMaxChannels; ++i) result[i] = value * (reflectance(index.eta[i]) / of_hero);
  return result;
}

}  // namespace

std::optional<LobeSample> DielectricMaterial::sample(const Vec3f& out, RandomStream& random,
                                                     const SurfacePoint& point,
                                                     const SurfaceContext& context) const {
  const DielectricIndex index = dielectric_index(eta, context);
  const DielectricInterface interface(index.hero, microfacets_at(roughness, point, context));
  const std::optional<InterfaceSample> drawn = interface.sample(out, random);
  if (!drawn) return std::nullopt;
  LobeSample result{drawn->direction, SampledSpectrum(drawn->weight), drawn->pdf,
                    interface.is_specular()};
  if (!drawn->transmitted) {
    result.weight = reflected_in_all(drawn->weight, index, out, drawn->direction);
  } else if (index.parts) {
    result.weight = hero_alone(drawn->weight, context);
    result.hero_only = true;
  }
  return result;
}

MaterialValue DielectricMaterial::evaluate(const Vec3f& out, const Vec3f& in,
                                           RandomStream& /*random*/, const SurfacePoint& point,
                                           const SurfaceContext& context) const {
  const DielectricIndex index = dielectric_index(eta, context);
  const DielectricInterface interface(index.hero, microfacets_at(roughness, point, context));
  const InterfaceValue found = interface.evaluate(out, in);
  if (same_hemisphere(out, in)) return {reflected_in_all(found.value, index, out, in), found.pdf};
  return {index.parts ? hero_alone(found.value, context) : SampledSpectrum(found.value), found.pdf};
}

SampledSpectrum DielectricMaterial::albedo(const Vec3f& /*out*/, const SurfacePoint& /*point*/,
                                           const SurfaceContext& /*context*/) const {
  return SampledSpectrum(1);
}

}  // namespace freepath
