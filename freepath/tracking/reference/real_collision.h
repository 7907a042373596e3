#pragma once
/// @file What happens at a real collision that was found without any null collision.

#include "freepath/tracking/reference/reference_flight.h"
#include "freepath/tracking/reference/reference_medium.h"
#include "freepath/tracking/walk_modes.h"

namespace freepath {

/// Coefficients at the collision [1/m], and their means over the channels.
template <int kN>
struct CollisionCoefficients {
  double sigma_a[kN] = {};
  double sigma_s[kN] = {};
  double emission[kN] = {};
  double absorb = 0;
  double scatter = 0;
};

template <int kN, ReferenceMedium Medium>
CollisionCoefficients<kN> coefficients(const Medium& medium,
                                       const typename Medium::Densities& densities) {
  CollisionCoefficients<kN> sigma;
  for (int k = 0; k < medium.component_count(); ++k) {
    const auto& component = medium.component(k);
    for (int channel = 0; channel < kN; ++channel) {
      sigma.sigma_a[channel] += densities[k] * component.sigma_a[channel];
      sigma.sigma_s[channel] += densities[k] * component.sigma_s[channel];
      sigma.emission[channel] += densities[k] * component.emission[channel];
    }
  }
  for (int channel = 0; channel < kN; ++channel) {
    sigma.absorb += sigma.sigma_a[channel] / kN;
    sigma.scatter += sigma.sigma_s[channel] / kN;
  }
  return sigma;
}

/// Adds w · emission · share to the tally. No event is needed, so that the mode "collision" counts
/// every real collision: here there are no others.
template <int kN>
void tally_emission(const WalkModes& modes, const CollisionCoefficients<kN>& sigma, bool absorbed,
                    ReferenceFlight<kN>& flight) {
  double share = 1 / (sigma.absorb + sigma.scatter);
  if (modes.emission == EmissionTally::kAnalog && modes.absorption == Absorption::kAnalog) {
    share = absorbed ? 1 / sigma.absorb : 0;
  }
  for (int channel = 0; channel < kN; ++channel) {
    flight.emitted[channel] += flight.weight[channel] * sigma.emission[channel] * share;
  }
}

/// Chooses the component that scatters, with probability in proportion to the mean over channels of
/// sigma_s,k, and corrects the weights by sigma_s,k(λ)/(sigma_s(λ) P_k).
template <int kN, ReferenceMedium Medium>
void choose_component(const Medium& medium, const typename Medium::Densities& densities,
                      const CollisionCoefficients<kN>& sigma, double uniform,
                      ReferenceFlight<kN>& flight) {
  double rest = uniform * sigma.scatter;
  double part = 0;
  int chosen = 0;
  // The last component that can scatter takes what rounding leaves over.
  for (int k = 0; k < medium.component_count() && rest >= 0; ++k) {
    double sigma_s = 0;
    for (int channel = 0; channel < kN; ++channel) {
      sigma_s += densities[k] * medium.component(k).sigma_s[channel] / kN;
    }
    if (sigma_s <= 0) continue;
    chosen = k;
    part = sigma_s;
    rest -= sigma_s;
  }
  flight.component = static_cast<uint8_t>(medium.number(chosen));
  if (kN == 1 || part <= 0 || medium.component_count() == 1) return;
  for (int channel = 0; channel < kN; ++channel) {
    if (sigma.sigma_s[channel] <= 0) continue;
    const double mine = densities[chosen] * medium.component(chosen).sigma_s[channel];
    flight.weight[channel] *= mine / sigma.sigma_s[channel] * (sigma.scatter / part);
  }
}

/// Absorption or scattering, chosen by the means over channels; the weights take what their channel
/// has of it. Under weighted absorption every collision scatters and the weights take the albedo.
/// @param densities of the components, not all 0
template <int kN, ReferenceMedium Medium>
void collide(const Medium& medium, const typename Medium::Densities& densities,
             const WalkModes& modes, RandomStream& random, ReferenceFlight<kN>& flight) {
  const CollisionCoefficients<kN> sigma = coefficients<kN>(medium, densities);
  const double real = sigma.absorb + sigma.scatter;
  const bool weighted = modes.absorption == Absorption::kWeighted;
  const bool absorbed = !weighted && uniform_double(random) * real < sigma.absorb;
  if (modes.emits) tally_emission(modes, sigma, absorbed, flight);
  flight.event = absorbed ? Event::kAbsorb : Event::kScatter;
  const double mean = weighted ? real : absorbed ? sigma.absorb : sigma.scatter;
  for (int channel = 0; channel < kN; ++channel) {
    flight.weight[channel] *= (absorbed ? sigma.sigma_a : sigma.sigma_s)[channel] / mean;
  }
  if (!absorbed) choose_component(medium, densities, sigma, uniform_double(random), flight);
}

}  // namespace freepath
