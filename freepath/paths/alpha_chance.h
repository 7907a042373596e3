#pragma once
/// @file The chance by which rays meet surfaces that are there in part.

#include <array>
#include <cstdint>

#include "freepath/base/random.h"
#include "freepath/geometry/surfaces.h"

namespace freepath {

/// A straight way through a scene, from where a direction begins to where it ends, whatever
/// boundaries lie between: with the random numbers of its surfaces.
struct AlphaChance {
  uint64_t seed = 0;
  uint32_t pixel = 0, sample = 0;
  uint32_t stream = 0;

  /// Whether the way meets a surface of this alpha. A function of the surface, so that one that is
  /// looked at again, from farther along the way, is still what it was; those of others are
  /// independent.
  bool meets(const SurfaceKey& surface, float alpha) const {
    if (alpha >= 1) return true;
    if (!(alpha > 0)) return false;
    const std::array<uint32_t, 4> key =
        philox({surface.instance, surface.geometry, surface.primitive, surface.root},
               {static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)});
    const std::array<uint32_t, 4> words = philox({key[2], stream, sample, pixel}, {key[0], key[1]});
    return uniform_from_words(words[0], words[1]) < alpha;
  }
};

}  // namespace freepath
