#pragma once
/// @file Drawing directions and table entries from uniform numbers in [0, 1).

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "freepath/base/random.h"
#include "freepath/base/turn.h"
#include "freepath/base/vector.h"

namespace freepath {

/// Mirrors an angle that is not negative, whole - angle, or leaves it as it is; without a branch:
/// directions are random, so that each second one would be guessed wrong.
inline float mirrored_if(bool is_mirrored, float whole, float angle) {
  const uint32_t mask = 0U - static_cast<uint32_t>(is_mirrored);
  const auto chosen = [](uint32_t bits) { return std::bit_cast<float>(bits); };
  return chosen(std::bit_cast<uint32_t>(whole) & mask) +
         chosen(std::bit_cast<uint32_t>(angle) ^ (mask & 0x80000000U));
}

/// atan(t)/t in t² as an interpolant through the Chebyshev nodes of [0, 1], good to 5e-7.
inline constexpr float kArctangent[8] = {0.999999882F,  -0.333318127F,  0.199669618F,
                                         -0.140032902F, 0.0986886546F,  -0.0588297531F,
                                         0.0237805186F, -0.00455979199F};

/// atan2(y, x) to within 5e-7, and 0 for the origin; several times as fast as the library's, which
/// the look-up of an environment would spend half its time in. The lanes compute the same in the
/// same order (base/lat_long-inl.h).
inline float fast_atan2(float y, float x) {
  const float ax = std::abs(x);
  const float ay = std::abs(y);
  const float t = std::min(ax, ay) / std::max({ax, ay, std::numeric_limits<float>::min()});
  const float s = t * t;
  const float(&c)[8] = kArctangent;
  const float low = (c[0] + c[1] * s) + (c[2] + c[3] * s) * (s * s);
  const float high = (c[4] + c[5] * s) + (c[6] + c[7] * s) * (s * s);
  const float angle = t * (low + high * (s * s) * (s * s));
  const float quarter = mirrored_if(ay > ax, 0.5F * std::numbers::pi_v<float>, angle);
  return std::copysign(mirrored_if(x < 0, std::numbers::pi_v<float>, quarter), y);
}

/// Density of a uniform direction on the sphere [1/sr].
inline constexpr float kUniformSpherePdf = 0.25F * std::numbers::inv_pi_v<float>;

/// A uniformly distributed unit vector.
inline Vec3f sample_sphere(float u0, float u1) {
  const float sine = 2.0F * std::sqrt(u0 * (1.0F - u0));
  const SinCos azimuth = sincos_of_turn(u1);
  return {sine * azimuth.cosine, 1.0F - 2.0F * u0, sine * azimuth.sine};
}

/// One column of an alias table (the method of Walker, 1977, built as by Vose, 1991): itself with
/// probability `threshold`, else `alias`.
struct AliasEntry {
  float threshold;
  uint32_t alias;
};

/// The alias table of a discrete distribution.
/// @param weights not negative, finite, their sum positive
std::vector<AliasEntry> make_alias_table(std::span<const double> weights);

/// An entry drawn from an alias table, and what is left of the uniform number.
struct AliasChoice {
  uint32_t index;
  float remainder;  ///< Uniform in [0, 1).
};

/// Draws an entry in constant time.
inline AliasChoice choose(std::span<const AliasEntry> table, float u) {
  const float scaled = u * static_cast<float>(table.size());
  const uint32_t column =
      std::min(static_cast<uint32_t>(scaled), static_cast<uint32_t>(table.size() - 1));
  const float fraction = std::min(scaled - static_cast<float>(column), kOneMinusEpsilon);
  const AliasEntry entry = table[column];
  if (fraction < entry.threshold) {
    return {column, std::min(fraction / entry.threshold, kOneMinusEpsilon)};
  }
  return {entry.alias,
          std::min((fraction - entry.threshold) / (1.0F - entry.threshold), kOneMinusEpsilon)};
}

}  // namespace freepath
