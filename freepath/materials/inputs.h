#pragma once
/// @file From the parameters of a material to what they are at a point.

#include "freepath/base/sampled_spectrum.h"
#include "freepath/materials/conductor_lobe.h"
#include "freepath/materials/material_kinds.h"
#include "freepath/materials/trowbridge_reitz.h"

namespace freepath {

TrowbridgeReitz microfacets_at(const Roughness& roughness, const SurfacePoint& point,
                               const SurfaceContext& context);

/// The reflectance at a point, clipped to [0, 1] as by pbrt-v4.
SampledSpectrum reflectance_at(const SpectrumInput& reflectance, const SurfacePoint& point,
                               const SurfaceContext& context);

/// @param outside refractive index of what lies on the conductor
ConductorLobe conductor_at(const ConductorIndex& index, const Roughness& roughness, float outside,
                           const SurfacePoint& point, const SurfaceContext& context);

/// A refractive index in the channels of a path.
struct DielectricIndex {
  SampledSpectrum eta;
  float hero = 1;      ///< That of the hero's channel.
  bool parts = false;  ///< Whether channels that are in use differ.
};
/// An index of 0, as a sampled spectrum has beyond its ends, counts as 1.
DielectricIndex dielectric_index(SpectrumId eta, const SurfaceContext& context);

/// A value in the hero's channel alone, which stands for all of them.
SampledSpectrum hero_alone(float value, const SurfaceContext& context);

}  // namespace freepath
