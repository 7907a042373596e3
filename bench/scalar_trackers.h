#pragma once
/// @file Every null-collision tracker and transmittance estimator as another renderer would write
/// it: one ray after the other, in scalars, through a NanoVDB grid.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "freepath/media/medium.h"
#include "freepath/tracking/streams.h"

namespace freepath::bench {

/// What became of a ray.
struct ScalarFlight {
  float t = 0;  ///< Distance flown [world].
  Event event = Event::kEscape;
  std::array<float, kChannels> weight{};  ///< As many as there are channels.
  uint32_t collisions = 0;                ///< Tentative collisions.
  uint32_t lookups = 0;                   ///< Densities read at them.
};

/// Which loop, and how it reads the density.
struct ScalarSettings {
  std::string method = "delta";  ///< By the name of the registry's; see has_scalar_loop().
  bool free_paths = true;        ///< A tracker; otherwise a transmittance estimator.
  Interpolation interpolation = Interpolation::kTrilinear;  ///< Or kStochastic.
  int channels = 1;                                         ///< 1 or kChannels.
};

/// Whether there is a loop for the method. All have one of one channel, the spectral trackers also
/// one of kChannels. With one channel `hero-wavelength` and `per-wavelength` are `delta` itself.
bool has_scalar_loop(const std::string& method, bool free_paths, int channels);

/// The densities of a medium as NanoVDB grids; components that share a field share the grid.
struct ScalarMedium;
/// @param medium must outlive the result
std::shared_ptr<const ScalarMedium> make_scalar_medium(const Medium& medium);

/// A scalar walk: read accessor, majorants and minima of the medium's super-voxels visited cell by
/// cell [Amanatides87], PCG random numbers, std::log. Absorption is weighted, Russian roulette ends
/// transmittances below 0.1, and options have the values that are standard in the registry.
class ScalarWalk {
 public:
  /// @param medium of one component, but for `multi-volume`
  /// @throws Error where there is no such loop, or too many components
  ScalarWalk(std::shared_ptr<const ScalarMedium> medium, const ScalarSettings& settings);

  /// Walks the rays. @param flights gets a slot for each of them
  void run(const RayStream& rays, std::vector<ScalarFlight>& flights) const;

 private:
  using Function = void (*)(const ScalarMedium&, const RayStream&, std::vector<ScalarFlight>&);

  std::shared_ptr<const ScalarMedium> medium_;
  Function function_;
};

}  // namespace freepath::bench
