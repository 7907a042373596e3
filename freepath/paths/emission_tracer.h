#pragma once
/// @file Flights that collect what a medium emits along a direction drawn for it.

#include <cstdint>
#include <span>
#include <vector>

#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/vector.h"
#include "freepath/paths/path_scene.h"
#include "freepath/paths/path_state.h"
#include "freepath/paths/walk_batches.h"

namespace freepath {

/// Next-event estimation of emission by line integration [Simon17]: from a scattering a free path
/// is walked to its next event, or to the first surface, and counts for what it collects on its way
/// alone, which is in the mean what arrives from all the line.
class EmissionTracer {
 public:
  EmissionTracer(const PathScene& scene, std::size_t slots) : scene_(scene), batches_(slots, true) {
    batches_.clear();
  }

  /// Adds a flight through the medium that a path is in.
  /// @param owner the path's slot
  /// @param weight what the path's radiance gets of what is emitted
  void add(uint32_t owner, const ScenePath& path, const Vec3f& position, const Vec3f& direction,
           const SampledSpectrum& weight);

  /// Walks all flights, adds to their paths, and forgets them.
  void trace(std::span<ScenePath> paths, WalkStatistics& statistics);

 private:
  struct Line {
    uint32_t owner;
    SampledSpectrum weight;
  };

  const PathScene& scene_;
  WalkBatches batches_;
  FlightStream flights_;
  std::vector<Line> lines_;
};

}  // namespace freepath
