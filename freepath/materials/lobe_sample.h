#pragma once
/// @file What lobes of materials give, in the frame of the surface: z is the normal, `out` points
/// to where a path came from, the sampled direction to where it goes on.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "freepath/base/random.h"
#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/turn.h"
#include "freepath/base/vector.h"

namespace freepath {

/// A direction drawn by a lobe.
struct LobeSample {
  Vec3f direction;
  SampledSpectrum weight;  ///< f |cosine| / density
  float pdf = 0;           ///< [1/sr]; 0 of a specular event.
  bool specular = false;   ///< The direction had no choice.
  bool hero_only = false;  ///< Only the hero channel is left.
};

/// The value of lobes for two directions.
struct MaterialValue {
  SampledSpectrum value;  ///< f |cosine| of the direction that follows [1/sr]
  float pdf = 0;          ///< Density of sampling that direction [1/sr].
};

inline bool same_hemisphere(const Vec3f& a, const Vec3f& b) { return a.z * b.z > 0; }

/// A direction with the density |z| / π on the side of +z: the projection of a point of a disk.
inline Vec3f sample_cosine_hemisphere(RandomStream& random) {
  const float radius2 = random.uniform();
  const SinCos azimuth = sincos_of_turn(random.uniform());
  const float radius = std::sqrt(radius2);
  return {radius * azimuth.cosine, radius * azimuth.sine, std::sqrt(1.0F - radius2)};
}

inline float cosine_hemisphere_pdf(float cosine) {
  return std::abs(cosine) * std::numbers::inv_pi_v<float>;
}

}  // namespace freepath
