#pragma once
/// @file A flight as the reference methods make it, and the random numbers they draw.

#include <cmath>
#include <cstdint>

#include "freepath/base/random.h"
#include "freepath/tracking/statistics.h"

namespace freepath {

/// What a method fills in; it comes with the ray's weights and the end of the medium in it.
template <int kN>
struct ReferenceFlight {
  double t = 0;  ///< Distance from where the ray enters the medium [world].
  Event event = Event::kEscape;
  uint8_t component = 0;
  double weight[kN];
  double emitted[kN] = {};
};

/// exp(-depth) is 0 beyond, for any weight that a float can hold.
inline constexpr double kOpaque = 850;

/// [0,1) with 53 bits, the first 32 of which are the stream's next word.
inline double uniform_double(RandomStream& random) {
  const uint64_t high = random.bits();
  const uint64_t low = random.bits();
  return static_cast<double>((high << 32 | low) >> 11) * 0x1p-53;
}

/// An optical depth, exponential with mean 1, as far out as 37. Its leading digits are those of
/// RandomStream::exponential().
inline double exponential_double(RandomStream& random) {
  return -std::log(uniform_double(random) + 0x1p-54);
}

/// Multiplies the weights, which ends a flight of which nothing is left.
template <int kN>
void scale(const double (&factor)[kN], ReferenceFlight<kN>& flight) {
  bool left = false;
  for (int channel = 0; channel < kN; ++channel) {
    flight.weight[channel] *= factor[channel];
    left = left || static_cast<float>(flight.weight[channel]) != 0;
  }
  if (!left) flight.event = Event::kAbsorb;
}

/// Multiplies the weights by exp(-depth).
template <int kN>
void attenuate(const double (&depth)[kN], ReferenceFlight<kN>& flight) {
  double factor[kN];
  for (int channel = 0; channel < kN; ++channel) factor[channel] = std::exp(-depth[channel]);
  scale(factor, flight);
}

}  // namespace freepath
