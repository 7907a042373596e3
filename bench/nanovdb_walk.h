#pragma once
/// @file The walk as other renderers do it: one ray after the other through a NanoVDB grid.

#include <cstdint>
#include <memory>

#include "bench/tally.h"
#include "freepath/media/medium.h"
#include "freepath/tracking/streams.h"

namespace freepath::bench {

/// What is estimated along a ray.
enum class Estimate {
  kFreePath,       ///< Delta tracking [Woodcock65]: to the first real collision.
  kTransmittance,  ///< Ratio tracking [Novak14], with Russian roulette below a weight of 0.1.
};

/// The walk over a NanoVDB float grid with a read accessor, the majorants of the medium's
/// super-voxels visited cell by cell [Amanatides87], PCG random numbers and std::log.
class NanovdbWalk {
 public:
  /// Copies the medium's one density. @param medium must outlive the walk
  explicit NanovdbWalk(const Medium& medium);
  ~NanovdbWalk();
  NanovdbWalk(NanovdbWalk&&) noexcept;

  /// @param interpolation kTrilinear or kStochastic
  Tally run(Estimate estimate, Interpolation interpolation, const RayStream& rays) const;

  struct Data;

 private:
  std::unique_ptr<Data> data_;
};

}  // namespace freepath::bench
