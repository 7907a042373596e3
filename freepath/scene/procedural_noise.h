#pragma once
/// @file Noise made of hashes: a function of position and seed alone, without tables or state,
/// hence the same on any number of threads.

#include <cmath>
#include <cstdint>

#include "freepath/base/vector.h"

namespace freepath::procedural {

/// Mixes 32 bits so that each of the result depends on all.
constexpr uint32_t mix(uint32_t bits) {
  bits = (bits ^ bits >> 16) * 0x7FEB352DU;
  bits = (bits ^ bits >> 15) * 0x846CA68BU;
  return bits ^ bits >> 16;
}

/// 32 random bits of a lattice point.
constexpr uint32_t hash(int x, int y, int z, uint32_t seed) {
  return mix((static_cast<uint32_t>(x) * 0x8DA6B343U ^ static_cast<uint32_t>(y) * 0xD8163841U ^
              static_cast<uint32_t>(z) * 0xCB1AB31FU) +
             seed * 0x9E3779B1U);
}

/// [0,1) of the bits.
constexpr float unit(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24F; }

/// Gradient noise after Perlin: about -1 to 1, mean 0, features of size 1.
float gradient_noise(const Vec3f& point, uint32_t seed);

/// Sum of octaves of gradient noise, each of twice the frequency and `gain` times the amplitude of
/// the one before, about -1 to 1.
float fractal_noise(const Vec3f& point, int octaves, float gain, uint32_t seed);

/// Inverted cellular noise after Worley: round bumps, 1 at the feature points of a jittered grid of
/// unit cells and falling with the squared distance, to 0 at distance 1.
float billow_noise(const Vec3f& point, uint32_t seed);

/// A velocity field without sources: the curl of a vector of three gradient noises.
Vec3f curl_noise(const Vec3f& point, uint32_t seed);

/// A sequence of random numbers for placing things.
class Sequence {
 public:
  explicit Sequence(uint64_t seed)
      : seed_(static_cast<uint32_t>(seed ^ seed >> 32)), high_(static_cast<int>(seed >> 32)) {}
  float uniform() { return unit(hash(count_++, high_, 0, seed_)); }
  float uniform(float low, float high) { return low + (high - low) * uniform(); }
  /// Uniform over directions.
  Vec3f direction();

 private:
  uint32_t seed_;
  int high_;
  int count_ = 0;
};

/// 0 below `low`, 1 above `high`, smooth between.
inline float smooth_step(float low, float high, float value) {
  const float t = std::fmin(std::fmax((value - low) / (high - low), 0.0F), 1.0F);
  return t * t * (3 - 2 * t);
}

}  // namespace freepath::procedural
