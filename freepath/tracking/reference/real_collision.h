#pragma once
/// @file What happens at a real collision that was found without any null collision.

#include "freepath/tracking/reference/reference_flight.h"
#include "freepath/tracking/reference/reference_medium.h"
#include "freepath/tracking/walk_modes.h"

namespace freepath {

/// Coefficients at the collision [1/m], and their means over the channels.
template <int N>
struct CollisionCoefficients {
  double sigma_a[N] = {};
  double sigma_s[N] = {};
  double emission[N] = {};
  double absorb = 0;
  double scatter = 0;
};

template <int N, ReferenceMedium Medium>
CollisionCoefficients<N> coefficients(const Medium& medium,
                                      const typename Medium::Densities& densities) {
  CollisionCoefficients<N> sigma;
  for (int k = 0; k < medium.component_count(); ++k) {
    const auto& component = medium.component(k);
    for (int channel = 0; channel < N; ++channel) {
      sigma.sigma_a[channel] += densities[k] * component.sigma_a[channel];
      sigma.sigma_s[channel] += densities[k] * component.sigma_s[channel];
      sigma.emission[channel] += densities[k] * component.emission[channel];
    }
  }
  for (int channel = 0; channel < N; ++channel) {
    sigma.absorb += sigma.sigma_a[channel] / N;
    sigma.scatter += sigma.sigma_s[channel] / N;
  }
  return sigma;
}

/// Adds w · emission · share to the tally. No event is needed, so that the mode "collision" counts
/// every real collision: here there are no others.
template <int N>
void tally_emission(const WalkModes& modes, const CollisionCoefficients<N>& sigma, bool absorbed,
                    ReferenceFlight<N>& flight) {
  double share = 1 / (sigma.absorb + sigma.scatter);
  if (modes.emission == EmissionTally::kAnalog && modes.absorption == Absorption::kAnalog) {
    share = absorbed ? 1 / sigma.absorb : 0;
  }
  for (int channel = 0; channel < N; ++channel) {
    flight.emitted[channel] += flight.weight[channel] * sigma.emission[channel] * share;
  }
}

/// Chooses the component that scatters, with probability in proportion to the mean over channels of
/// sigma_s,k, and corrects the weights by sigma_s,k(λ)/(sigma_s(λ) P_k).
template <int N, ReferenceMedium Medium>
void choose_component(const Medium& medium, const typename Medium::Densities& densities,
                      const CollisionCoefficients<N>& sigma, double uniform,
                      ReferenceFlight<N>& flight) {
  double rest = uniform * sigma.scatter;
  double part = 0;
  int chosen = 0;
  // The last component that can scatter takes what rounding leaves over.
  for (int k = 0; k < medium.component_count() && rest >= 0; ++k) {
    double sigma_s = 0;
    for (int channel = 0; channel < N; ++channel) {
      sigma_s += densities[k] * medium.component(k).sigma_s[channel] / N;
    }
    if (sigma_s <= 0) continue;
    chosen = k;
    part = sigma_s;
    rest -= sigma_s;
  }
  flight.component = static_cast<uint8_t>(medium.number(chosen));
  if (N == 1 || part <= 0 || medium.component_count() == 1) return;
  for (int channel = 0; channel < N; ++channel) {
    if (sigma.sigma_s[channel] <= 0) continue;
    const double mine = densities[chosen] * medium.component(chosen).sigma_s[channel];
    flight.weight[channel] *= mine / sigma.sigma_s[channel] * (sigma.scatter / part);
  }
}

/// Absorption or scattering, chosen by the means over channels; the weights take what their channel
/// has of it. Under weighted absorption every collision scatters and the weights take the albedo.
/// @param densities of the components, not all 0
template <int N, ReferenceMedium Medium>
void collide(const Medium& medium, const typename Medium::Densities& densities,
             const WalkModes& modes, RandomStream& random, ReferenceFlight<N>& flight) {
  const CollisionCoefficients<N> sigma = coefficients<N>(medium, densities);
  const double real = sigma.absorb + sigma.scatter;
  const bool weighted = modes.absorption == Absorption::kWeighted;
  const bool absorbed = !weighted && uniform_double(random) * real < sigma.absorb;
  if (modes.emits) tally_emission(modes, sigma, absorbed, flight);
  flight.event = absorbed ? Event::kAbsorb : Event::kScatter;
  const double mean = weighted ? real : absorbed ? sigma.absorb : sigma.scatter;
  for (int channel = 0; channel < N; ++channel) {
    flight.weight[channel] *= (absorbed ? sigma.sigma_a : sigma.sigma_s)[channel] / mean;
  }
  if (!absorbed) choose_component(medium, densities, sigma, uniform_double(random), flight);
}

}  // namespace freepath
