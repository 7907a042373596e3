#pragma once
/// @file Homogeneous media in closed form.

#include <span>

#include "freepath/tracking/method.h"
#include "freepath/tracking/reference/real_collision.h"

namespace freepath {

/// The densities of a homogeneous medium: the bounds of its first segment. No voxel is read.
template <ReferenceMedium Medium>
typename Medium::Densities homogeneous_densities(const Medium& medium,
                                                 const typename Medium::Path& path,
                                                 WalkStatistics& statistics) {
  typename Medium::Segment segment;
  if (!medium.segments(path).next(segment)) return {};
  ++statistics.super_voxel_steps;
  return segment.maximum;
}

/// t = -ln(1-u)/mu_t. Unbiased in homogeneous media, the only ones it is let into.
struct ClosedForm {
  static constexpr MethodInfo kInfo = {
      "closed-form",
      "the logarithm: homogeneous media alone, no voxel is read",
      "the same densities everywhere within its bounds, and interpolation 'nearest'",
      "always",
      "[Novak18, Sec. 4]",
      {}};

  explicit ClosedForm(std::span<const float> /*options*/) {}

  template <int kN, ReferenceMedium Medium>
  void fly(const Medium& medium, const typename Medium::Path& path, const WalkModes& modes,
           RandomStream& random, ReferenceFlight<kN>& flight, WalkStatistics& statistics) {
    const auto densities = homogeneous_densities(medium, path, statistics);
    const double sigma_t = mean_extinction<kN>(medium, densities);
    const double tau = exponential_double(random);
    if (!(tau < sigma_t * path.length)) return;
    flight.t = tau / sigma_t;
    collide(medium, densities, modes, random, flight);
  }
};

/// exp(-mu_t · length), exact.
struct ClosedFormTransmittance {
  static constexpr MethodInfo kInfo = {
      "closed-form",           "exp(-sigma_t length): homogeneous media alone",
      ClosedForm::kInfo.needs, "always: it is exact",
      "[Novak18, Sec. 5]",     {},
      /*chromatic=*/true};

  explicit ClosedFormTransmittance(std::span<const float> /*options*/) {}

  template <int kN, ReferenceMedium Medium>
  void fly(const Medium& medium, const typename Medium::Path& path, const WalkModes& /*modes*/,
           RandomStream& /*random*/, ReferenceFlight<kN>& flight, WalkStatistics& statistics) {
    const auto sigma_t = extinction<kN>(medium, homogeneous_densities(medium, path, statistics));
    double depth[kN];
    for (int channel = 0; channel < kN; ++channel) depth[channel] = sigma_t[channel] * path.length;
    attenuate(depth, flight);
  }
};

}  // namespace freepath
