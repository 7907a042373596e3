#include <algorithm>
#include <cmath>

#include "freepath/materials/dielectric_interface.h"
#include "freepath/materials/diffuse_lobe.h"
#include "freepath/materials/fresnel.h"
#include "freepath/materials/inputs.h"
#include "freepath/materials/layered_lobe.h"
#include "freepath/materials/material_kinds.h"

namespace freepath {

namespace {

template <class Bottom>
LayeredLobe<Bottom> layered(const Coating& coating, float eta, const Bottom& bottom,
                            const SurfacePoint& point, const SurfaceContext& context) {
  constexpr float kLargestG = 0.99F;  // the peak of a larger one is too narrow to connect to
  const LayerMedium medium{
      context.textures.evaluate(coating.thickness, point),
      reflectance_at(coating.albedo, point, context),
      std::clamp(context.textures.evaluate(coating.g, point), -kLargestG, kLargestG)};
  return {DielectricInterface(eta, microfacets_at(coating.roughness, point, context)),
          bottom,
          medium,
          {coating.max_depth, coating.samples}};
}

/// Where the channels part in the layers, the walk is the hero's.
std::optional<LobeSample> left_to_hero(std::optional<LobeSample> drawn,
                                       const DielectricIndex& index,
                                       const SurfaceContext& context) {
  if (drawn && index.parts) {
    drawn->weight = hero_alone(drawn->weight[context.hero], context);
    drawn->hero_only = true;
  }
  return drawn;
}

MaterialValue left_to_hero(MaterialValue found, const DielectricIndex& index,
                           const SurfaceContext& context) {
  if (index.parts) found.value = hero_alone(found.value[context.hero], context);
  return found;
}

}  // namespace

std::optional<LobeSample> CoatedDiffuseMaterial::sample(const Vec3f& out, RandomStream& random,
                                                        const SurfacePoint& point,
                                                        const SurfaceContext& context) const {
  const DielectricIndex index = dielectric_index(coating.eta, context);
  const DiffuseLobe bottom(reflectance_at(reflectance, point, context));
  return left_to_hero(layered(coating, index.hero, bottom, point, context).sample(out, random),
                      index, context);
}

MaterialValue CoatedDiffuseMaterial::evaluate(const Vec3f& out, const Vec3f& in,
                                              RandomStream& random, const SurfacePoint& point,
                                              const SurfaceContext& context) const {
  const DielectricIndex index = dielectric_index(coating.eta, context);
  const DiffuseLobe bottom(reflectance_at(reflectance, point, context));
  return left_to_hero(
      layered(coating, index.hero, bottom, point, context).evaluate(out, in, random), index,
      context);
}

/// All reflections between a smooth coating and a diffuse bottom: what the coating reflects of
/// diffuse light from within is the fit of [Jensen01, Sec. 2.1].
SampledSpectrum CoatedDiffuseMaterial::albedo(const Vec3f& out, const SurfacePoint& point,
                                              const SurfaceContext& context) const {
  const float eta = std::max(1.0F, dielectric_index(coating.eta, context).hero);
  const float within =
      std::max(0.0F, -1.440F / (eta * eta) + 0.710F / eta + 0.668F + 0.0636F * eta);
  const float first = fresnel_dielectric(std::abs(out.z), eta);
  SampledSpectrum result = reflectance_at(reflectance, point, context);
  for (int i = 0; i < kMaxChannels; ++i) {
    result[i] = first + (1.0F - first) * (1.0F - within) * result[i] / (1.0F - within * result[i]);
  }
  return result;
}

bool CoatedConductorMaterial::is_specular() const {
  // A medium may scatter; which one does is known at a point only.
  return false;
}

std::optional<LobeSample> CoatedConductorMaterial::sample(const Vec3f& out, RandomStream& random,
                                                          const SurfacePoint& point,
                                                          const SurfaceContext& context) const {
  const DielectricIndex parted = dielectric_index(coating.eta, context);
  const ConductorLobe bottom = conductor_at(index, roughness, parted.hero, point, context);
  return left_to_hero(layered(coating, parted.hero, bottom, point, context).sample(out, random),
                      parted, context);
}

MaterialValue CoatedConductorMaterial::evaluate(const Vec3f& out, const Vec3f& in,
                                                RandomStream& random, const SurfacePoint& point,
                                                const SurfaceContext& context) const {
  const DielectricIndex parted = dielectric_index(coating.eta, context);
  const ConductorLobe bottom = conductor_at(index, roughness, parted.hero, point, context);
  return left_to_hero(
      layered(coating, parted.hero, bottom, point, context).evaluate(out, in, random), parted,
      context);
}

/// All reflections between a smooth coating and a smooth conductor.
SampledSpectrum CoatedConductorMaterial::albedo(const Vec3f& out, const SurfacePoint& point,
                                                const SurfaceContext& context) const {
  const float eta = dielectric_index(coating.eta, context).hero;
  const float cosine = std::abs(out.z);
  const float first = fresnel_dielectric(cosine, eta);
  const float below = std::sqrt(std::max(0.0F, 1.0F - (1.0F - cosine * cosine) / (eta * eta)));
  const SampledSpectrum metal =
      conductor_at(index, roughness, eta, point, context).reflectance(below);
  SampledSpectrum result;
  for (int i = 0; i < kMaxChannels; ++i) {
    result[i] = first + (1.0F - first) * (1.0F - first) * metal[i] /
                            std::max(1e-6F, 1.0F - first * metal[i]);
  }
  return result;
}

}  // namespace freepath
