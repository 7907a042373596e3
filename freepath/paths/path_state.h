#pragma once
/// @file A path in flight.

#include <cstdint>
#include <limits>

#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/vector.h"
#include "freepath/paths/media_set_table.h"
#include "freepath/paths/path_scene.h"
#include "freepath/paths/sample_spectra.h"

namespace freepath {

struct GlassSphere;

/// A path. Its first two cache lines are all that a flight between scatterings in a medium
/// touches: thousands of paths are in flight, and most of their events are these.
struct alignas(64) ScenePath {
  const SampleSpectra* colors = nullptr;
  uint64_t lookups = 0;       ///< Look-ups of densities so far.
  MediumId medium = kVacuum;  ///< What the media around are together.
  int channel = -1;           ///< The one channel that it carries, or -1.
  MediaSetId media = 0;       ///< Which media are around: MediaSetTable.
  uint32_t pixel = 0;
  uint32_t sample_key = 0;  ///< Key of its random numbers.
  uint32_t flights = 0;     ///< Rays so far.
  uint32_t scatterings = 0;
  /// Density with which its direction was drawn [1/sr]; 0: it had no choice, or comes from the
  /// camera.
  float pdf = 0;
  /// What its flight collects of emission counts for, the rest being that of EmissionTracer's.
  float emission_share = 1;
  /// Share of the light in the cone around a sun that the path brings, the rest being its
  /// branches'; of a branch, which brings no other light, 1. See LobeBranch.
  float sun_share = 1;
  uint8_t hero : 4 = 0;  ///< The channel that decides where channels part.
  bool only_hero : 1 = false;
  bool is_coloured : 1 = false;  ///< It has met something that may tell wavelengths apart.
  /// The channels of its throughput may differ. Where they don't, most is known by the first.
  bool may_differ : 1 = false;
  bool is_branch : 1 = false;
  bool surfaces_known = false;
  bool ends_at_surface = false;  ///< Once that is known.
  bool is_dead = false;
  bool is_sent = false;     ///< Its next ray lies in a stream, or waits in vacuum.
  bool is_in_rays = false;  ///< Its ray lies in a stream alone: `origin` and so on are of old.

  alignas(64) SampledSpectrum throughput;
  /// The part of the radiance that is known in R, G, B: what a throughput without colour brings of
  /// lights, whose integral over all wavelengths is known. Beside the throughput, since most shadow
  /// rays add to it.
  SampledSpectrum rgb;
  SampledSpectrum radiance;       ///< All else.
  SampledSpectrum density{1.0F};  ///< FlightStream::density of the flights so far.

  uint32_t turned_in = 0;  ///< The flight with which its direction began, if that is asked for.

  Vec3f origin{0};     ///< Origin of its ray [world, relative to the scene's origin].
  Vec3f direction{0};  ///< Direction of its ray, unit [world].
  /// Where the direction began: at the camera, a surface or a collision. Unlike `origin` it stays
  /// where it is when the ray crosses a boundary.
  Vec3f turned_at{0};
  /// Length of its ray up to a side of the domain, or a plane where paths split [world].
  float side = std::numeric_limits<float>::infinity();
  uint32_t job = 0;     ///< Number of its job in OpenJobs.
  uint32_t result = 0;  ///< Place of what it finds in OpenJobs::results.
  float distance = 0;   ///< Flown from the camera, until the first event [world].
  uint32_t sides = 0;   ///< Passed so far.
  uint32_t level = 0;   ///< Planes where paths split that lie above.
  /// Whose glass has refracted its ray once since a medium turned it; null: no such. Its `pdf` has
  /// the share of refraction in it then, and `turned_at` is where the medium turned it.
  const GlassSphere* glass = nullptr;
  bool is_from_medium = false;  ///< A medium turned it last; known where there are GlassSpheres.
  bool line_is_drawn = false;   ///< NearLightLines has the line of its next flight.

  /// The mean over the channels that it carries.
  float mean(const SampledSpectrum& values) const {
    if (channel >= 0) return values[channel];
    const int channels = colors->spectra.channels();
    float sum = 0;
    for (int c = 0; c < channels; ++c) sum += values[c];
    return sum / static_cast<float>(channels);
  }
};

}  // namespace freepath
