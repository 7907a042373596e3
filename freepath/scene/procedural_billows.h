#pragma once
/// @file Round bumps upon round bumps, the surface of cauliflowers and cumuli.

#include <cstdint>

#include "freepath/scene/procedural_noise.h"

namespace freepath::procedural {

/// A sum of octaves of billow noise, each of about half the size and height of the one before.
class Billows {
 public:
  /// @param size of the largest bumps [world]
  /// @param steepness height of bumps over their size
  /// @param smallest bumps smaller than this are left out [world]
  Billows(float size, float steepness, float smallest, uint32_t seed)
      : size_(size), steepness_(steepness), smallest_(smallest), seed_(seed) {
    for (float s = size_; s >= smallest_; s *= kLacunarity) total_ += s * steepness_;
  }

  /// Height of the surface over its mean [world].
  float height(const Vec3f& point) const {
    float sum = 0;
    uint32_t seed = seed_;
    for (float size = size_; size >= smallest_; size *= kLacunarity) {
      sum += size * steepness_ * (billow_noise(point / size, seed++) - kMean);
    }
    return sum;
  }
  /// Bounds of the height: -inward() to outward().
  float outward() const { return total_ * (1 - kMean); }
  float inward() const { return total_ * kMean; }

 private:
  static constexpr float kLacunarity = 0.47F;
  static constexpr float kMean = 0.7F;  // about the mean of billow noise
  float size_, steepness_, smallest_;
  uint32_t seed_;
  float total_ = 0;
};

}  // namespace freepath::procedural
