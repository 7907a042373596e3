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

  /// Depth below the surface with the bumps on it. A bump reaches as deep as twice its size, so
  /// that deep points, and those that no bump can reach, are not worked out in full.
  /// @param depth below the surface without bumps [world]
  /// @param strength 0 to 1, scales the bumps
  float raise(const Vec3f& point, float depth, float strength) const {
    float left = total_;
    uint32_t seed = seed_;
    for (float size = size_; size >= smallest_; size *= kLacunarity) {
      const float height = size * steepness_;
      if (depth + left * (1 - kMean) <= 0) break;
      left -= height;
      const float reach = 1 - smooth_step(size, 2 * size, depth);
      if (reach > 0) {
        depth += strength * reach * height * (billow_noise(point / size, seed) - kMean);
      }
      ++seed;
    }
    return depth;
  }
  /// How far bumps reach out of the surface, and into it.
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
