#pragma once
/// @file Scatterings in media as compiled for one target.

#include <cstdint>

namespace freepath {

struct DirectionDisc;
struct FlightStream;
struct RayStream;
struct ScatteringStream;
struct ShadowRoulette;

/// Steps of scatterings in media, as compiled for one target; the same bits on all of them.
struct ScatteringKernels {
  /// Takes positions, directions and the places of random numbers from the flights that ended in
  /// scatterings: those at ScatteringStream::ray.
  void (*gather)(const RayStream& rays, const FlightStream& flights,
                 ScatteringStream& scatterings) = nullptr;
  /// Draws the numbers of scatterings: uniform in (0,1), as RandomStream draws them.
  /// @param blocks the first ones of kScatteringBlocks
  void (*draw_numbers)(ScatteringStream& scatterings, uint64_t seed, uint32_t blocks) = nullptr;
  /// Says with what probability paths go on, whose magnitudes are known; all branches do, which
  /// play later.
  /// @param threshold magnitude from which on paths don't play
  void (*play)(ScatteringStream& scatterings, float threshold) = nullptr;
  /// Draws directions to a light whose draws all lie in one disc, by the numbers that were drawn.
  void (*aim)(ScatteringStream& scatterings, const DirectionDisc& disc) = nullptr;
  /// Evaluates the phase function of Henyey and Greenstein towards the lights, weighs these by the
  /// balance heuristic [Veach97] and says how likely their shadow rays are to be cast; draws next
  /// directions, by the numbers that were drawn.
  void (*scatter)(ScatteringStream& scatterings, const ShadowRoulette& roulette) = nullptr;
};

}  // namespace freepath
