#pragma once
/// @file Points of the rays of paths from which light of near lights is scattered into them.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/vector.h"
#include "freepath/paths/near_lights.h"
#include "freepath/paths/path_state.h"
#include "freepath/paths/walk_batches.h"

namespace freepath {

/// Estimates, for points that NearLights draws along rays, what arrives at the rays' origins of
/// what is scattered there: transmittance times scattering coefficient, by a walk that collides
/// with nothing and one look-up. Its memory is used again.
class NearLightLines {
 public:
  /// Random numbers for the line of a path's flight, that no other part of the path draws.
  static RandomStream numbers(uint64_t seed, const ScenePath& path);

  explicit NearLightLines(std::size_t slots) : batches_(slots, false) { batches_.clear(); }

  /// A point of a ray.
  struct Line {
    uint32_t slot = 0;  ///< Of the path whose ray it is.
    uint32_t light = 0;
    float weight = 0;  ///< NearLights::Point::weight, and the factor of the throughput.
    Vec3f position;    ///< [world, relative to the scene's origin]
    Vec3f direction;   ///< Of the ray, unit [world].
    std::array<float, 2> u{};           ///< Numbers for a draw of the light.
    SampledSpectrum transmittance = {};
    uint32_t component = 0;  ///< Of the medium, which scatters.
    /// Transmittance from the ray's origin times the component's scattering coefficient over the
    /// probability of its choice [1/m], in the channels of the path.
    SampledSpectrum scattered = {};
  };

  /// Adds a point of a ray through the medium that a path is in, if there is one.
  /// @param factor of the path's throughput by which it counts
  /// @param random of the path and flight, for a draw of the light
  void add(uint32_t slot, const ScenePath& path, const Vec3f& origin, const Vec3f& direction,
           const std::optional<NearLights::Point>& point, float factor, RandomStream& random);

  /// Walks to all points, calls use(line) for those from which something arrives, and forgets them.
  void trace(std::vector<ScenePath>& paths, WalkStatistics& statistics,
             const std::function<void(const Line&)>& use);

 private:
  WalkBatches batches_;
  FlightStream flights_;
  std::vector<Line> lines_;
};

}  // namespace freepath
