#pragma once
/// @file The media of the certifying suite, each with a ray through it.

#include <memory>
#include <string>
#include <vector>

#include "tests/certify/ray_profile.h"

namespace freepath::testing {

/// A medium to certify methods on.
struct CertifiedMedium {
  std::string name;
  std::shared_ptr<const Medium> tight;  ///< With the bounds that super-voxels give.
  std::shared_ptr<const Medium> loose;  ///< With maxima times 4 and minima divided by 4.
  MediumChannels channels;
  CertifiedRay ray;

  const Medium& with_bounds(bool tight_ones) const { return tight_ones ? *tight : *loose; }
};

/// All of them, made once.
const std::vector<CertifiedMedium>& certified_media();

/// Radiance that a scattering by a component at a distance sends back along the ray, and that of
/// the background is 1: what turns flights into an estimate of collected radiance.
double scattered_radiance(int component, int channel, double t);

}  // namespace freepath::testing
