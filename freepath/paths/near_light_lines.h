#pragma once
/// @file Points of the rays of paths from which light of near lights is scattered into them.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "freepath/base/random.h"
#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/vector.h"
#include "freepath/lights/light_sample.h"
#include "freepath/paths/path_state.h"
#include "freepath/paths/walk_batches.h"

namespace freepath {

/// Estimates, for points that NearLights draws along rays, what arrives at the rays' origins of
/// what is scattered there: transmittance times scattering coefficient, by a walk that collides
/// with nothing and one look-up. Its memory is used again.
class NearLightLines {
 public:
  explicit NearLightLines(std::size_t slots) : batches_(slots, false) { batches_.clear(); }

  /// Random numbers for the line of a path's flight, that no other part of the path draws.
  static RandomStream numbers(uint64_t seed, const ScenePath& path);

  /// A point of a ray.
  struct Line {
    uint32_t slot = 0;    ///< Of the path whose ray it is.
    float t = 0;          ///< From the ray's origin [world].
    float factor = 0;     ///< Of the path's throughput by which it counts [world].
    bool in_rgb = false;  ///< Whether the light is.
    Vec3f position;       ///< [world, relative to the scene's origin]
    Vec3f direction;      ///< Of the ray, unit [world].
    LightSample light = {};
    float light_share = 0;  ///< Probability of that light where lights are drawn for a point.
    SampledSpectrum transmittance = {};
    uint32_t component = 0;  ///< Of the medium, which scatters.
    /// Transmittance from the ray's origin times the component's scattering coefficient over the
    /// probability of its choice [1/m], in the channels of the path.
    SampledSpectrum scattered = {};
  };

  /// Adds a point of a ray through the medium that a path is in.
  void add(const Line& line, const Vec3f& origin, const ScenePath& path);

  /// Walks to all points, calls use(line) for those from which something arrives, and forgets them.
  void trace(std::span<ScenePath> paths, WalkStatistics& statistics,
             const std::function<void(const Line&)>& use);

 private:
  WalkBatches batches_;
  FlightStream flights_;
  std::vector<Line> lines_;
};

}  // namespace freepath
