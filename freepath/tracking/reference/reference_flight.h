#pragma once
/// @file A flight as the reference methods make it, and the random numbers they draw.

#include <algorithm>
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

/// 64 bits, the first 32 of which are the stream's next word.
inline uint64_t long_bits(RandomStream& random) {
  const uint64_t high = random.bits();
  return high << 32 | random.bits();
}

/// Uniform in (0,1), with a relative precision of 2^-53 down to 2^-11 and of 2^-(64-n) at 2^-n
/// below.
inline double uniform_double(RandomStream& random) {
  constexpr double kLast = 1 - 0x1p-53;
  return std::min((static_cast<double>(long_bits(random)) + 0.5) * 0x1p-64, kLast);
}

/// An optical depth, exponential with mean 1, from 2^-65 to 45, by the same law as
/// exponential_from_words(), whose leading digits it has.
inline double exponential_double(RandomStream& random) {
  const uint64_t bits = long_bits(random);
  const uint64_t low = bits & ~(uint64_t{1} << 63);
  const double v = (static_cast<double>(low) + 0.5) * 0x1p-64;
  return low != bits ? -std::log(v) : -std::log1p(-v);
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
