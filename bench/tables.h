#pragma once
/// @file The larger tables of tracker_bench.

#include <string>
#include <vector>

#include "freepath/media/medium.h"
#include "freepath/tracking/streams.h"

namespace freepath::bench {

/// Each method's scalar loop (trilinear and stochastic) against its lanes (stochastic), timed in
/// turn; tests that they do the same. The lanes should take a third of either scalar time.
/// @param cloud of one component
/// @return whether all agree
bool compare_with_scalar_loops(const Medium& cloud, const std::vector<RayStream>& rays);

/// What lights the paths of a comparison. Directions of scattered light are uniform.
enum class Light {
  /// The height in the medium at each scattering (0 at the bottom, 1 at the top), 1 for what
  /// escapes: so smooth that hardly anything but the weights makes noise.
  kHeight,
  /// A sun through shadow rays of `ratio` tracking, its irradiance 4π; a sky of 0.8, whose
  /// irradiance is a fifth of that, and a ground of 0.2 for what escapes: what a picture is made
  /// of.
  kDaylight,
};

/// Trackers that carry all channels in one path against a path for each channel: variance times
/// time of the radiance that paths of up to `scatterings` scatterings bring back, timed in turn;
/// tests that their means are the same.
/// @return whether all agree
bool compare_spectral_costs(const std::string& title, const Medium& medium,
                            const std::vector<RayStream>& rays, Light light, int scatterings);

}  // namespace freepath::bench
