#pragma once
/// @file Scatterings in media as compiled for one target.

#include <array>
#include <cstddef>
#include <cstdint>

#include "freepath/transport/scattering_stream.h"

namespace freepath {

struct DirectionDisc;
struct FlightStream;
struct RayStream;
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
  /// balance heuristic [Veach97] and says which shadow rays are cast; draws next directions, by the
  /// numbers that were drawn.
  void (*scatter)(ScatteringStream& scatterings, const ShadowRoulette& roulette) = nullptr;
  /// Writes rays that begin at scatterings into a stream, one behind the other: all but their
  /// length and weights.
  /// @param some of the scatterings, as many as there is room for from `first` on
  /// @param direction of the rays
  /// @param stream_step from the stream of a scattering's random numbers to that of its ray's
  void (*send)(const ScatteringStream& scatterings, ScatteringStream::Set some,
               const std::array<ScatteringStream::Row<float>, 3>& direction, uint32_t stream_step,
               RayStream& rays, std::size_t first) = nullptr;
};

}  // namespace freepath
