#pragma once
/// @file What a wavefront of paths is made for.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "freepath/paths/flux_meter.h"
#include "freepath/paths/flux_tally.h"
#include "freepath/paths/glass_spheres.h"
#include "freepath/paths/near_lights.h"
#include "freepath/paths/path_job.h"
#include "freepath/paths/path_scene.h"
#include "freepath/paths/sample_spectra.h"
#include "freepath/paths/shadow_guide.h"

namespace freepath {

/// Settings, and parts of the scene, that all paths of a picture share.
struct PathSetup {
  const PathScene* scene = nullptr;
  const WavelengthSampler* factory = nullptr;
  uint64_t seed = 0;
  Absorption absorption = Absorption::kWeighted;
  uint32_t max_scatterings = UINT32_MAX;  ///< Most scatterings at surfaces and in media together.
  bool transparent = false;               ///< RenderSettings::transparent
  /// Russian roulette is played where no channel's throughput reaches this.
  float roulette_threshold = 0.25F;
  /// Whether scatterings in emissive media also look for their light along lines of its own; where
  /// nothing is said, if little of the medium glows.
  std::optional<bool> samples_emission = {};
  /// Says which shadow rays are cast and where paths split; null: all are, and none does.
  const ShadowGuide* shadow_guide = nullptr;
  /// Lights in or near media whose light lines bring; null: scatterings alone do.
  const NearLights* near_lights = nullptr;
  /// Glass through which scatterings see lamps; null: paths find their light by chance.
  const GlassSpheres* glass_spheres = nullptr;
  std::size_t slots = kPathsInFlight;
  /// Pixels of the camera along the edge of a pixel of the film.
  float pixel_edge = 1;
  /// Number of the film's first pixel for random numbers.
  uint32_t first_random_pixel = 0;
  /// Spectra of the sets of wavelengths that samples of a pass may have, from first_set on.
  std::vector<std::shared_ptr<const SampleSpectra>> colors;
  uint32_t first_set = 0;
  /// The meter where paths begin, as light does, if not at the camera, and
  /// who sums what they bring. Such paths carry one channel, and lights have no part in it.
  const FluxMeter* meter = nullptr;
  FluxTally* tally = nullptr;
};

}  // namespace freepath
