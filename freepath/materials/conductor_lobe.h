#pragma once
/// @file Reflection by a metal.

#include <optional>

#include "freepath/materials/lobe_sample.h"
#include "freepath/materials/trowbridge_reitz.h"

namespace freepath {

/// Single reflection by the facets of a conductor, the same on both sides: light that would meet a
/// second facet is lost, as in pbrt-v4.
class ConductorLobe {
 public:
  /// @param eta,k refractive index relative to what is outside
  ConductorLobe(const TrowbridgeReitz& facets, const SampledSpectrum& eta, const SampledSpectrum& k)
      : facets_(facets), eta_(eta), k_(k) {}

  bool is_specular() const { return facets_.is_smooth(); }

  /// Draws a visible normal [Heitz18].
  std::optional<LobeSample> sample(const Vec3f& out, RandomStream& random) const;
  MaterialValue evaluate(const Vec3f& out, const Vec3f& in) const;

  /// What a facet reflects at a cosine to its normal.
  SampledSpectrum reflectance(float cosine) const;

 private:
  TrowbridgeReitz facets_;
  SampledSpectrum eta_, k_;
};

}  // namespace freepath
