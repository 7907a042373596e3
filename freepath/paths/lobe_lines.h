#pragma once
/// @file Flights in the lobe of a phase function around a light from outside of the scene.

#include <cstdint>
#include <functional>
#include <vector>

#include "freepath/base/random.h"
#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/vector.h"
#include "freepath/paths/path_state.h"
#include "freepath/paths/walk_batches.h"

namespace freepath {

/// Flies, for scatterings of paths, lines from them whose directions are drawn about that to a
/// light, as the phase function would scatter light that comes from there; where a line collides,
/// the light is looked for. It is the path's next scattering, drawn from the light's end: where a
/// path happens to fly towards the sun, next-event estimation alone brings as much as the phase
/// function has forwards, which are the peaks of its variance. Both together, by the balance
/// heuristic [Veach97], bring no more than the smaller of the two lobes. What follows of the path
/// is left as it is, so that weights of many scatterings don't multiply ([Buras11] draws such
/// directions for the paths themselves; [Georgiev13] of two scatterings together).
///
/// Its memory is used again.
class LobeLines {
 public:
  explicit LobeLines(std::size_t slots) : batches_(slots, true) { batches_.clear(); }

  /// Random numbers of the line of a path's last scattering, that no other part of the path draws.
  static RandomStream numbers(uint64_t seed, const ScenePath& path);

  struct Line {
    uint32_t slot = 0;    ///< Of the path.
    bool in_rgb = false;  ///< Whether the light is.
    float number = 0;     ///< In (0, 1), for the roulette of its shadow ray.
    Vec3f direction;      ///< Of the flight, unit [world].
    Vec3f to_light;       ///< Direction of the light, unit [world].
    /// What it brings if it collides and nothing is in between, but for the weight of the flight.
    SampledSpectrum radiance;
    Vec3f position{0};  ///< Where it collides [world, relative to the scene's origin].
  };

  /// Adds a line through the medium that a path is in.
  /// @param length of the line, up to a surface; may be infinite
  void add(const Line& line, const Vec3f& origin, float length, const ScenePath& path);

  /// Flies all lines, calls use(line) for those that scatter, with what their flights leave of
  /// their radiances, and forgets them.
  void trace(std::vector<ScenePath>& paths, WalkStatistics& statistics,
             const std::function<void(const Line&)>& use);

 private:
  WalkBatches batches_;
  FlightStream flights_;
  std::vector<Line> lines_;
};

}  // namespace freepath
