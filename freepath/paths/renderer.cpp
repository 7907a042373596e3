#include "freepath/paths/renderer.h"

#include <algorithm>

#include "freepath/base/error.h"
#include "freepath/paths/pass_renderer.h"
#include "freepath/transport/weight_growth.h"

namespace freepath {
namespace {

PathSetup make_setup(const Medium& medium, const Camera& camera, const Lights& lights,
                     const RenderSettings& settings) {
  PathSetup setup;
  setup.medium = &medium;
  setup.camera = &camera;
  setup.lights = &lights;
  setup.absorption = settings.walk.absorption;
  setup.seed = settings.walk.seed;
  setup.max_scatterings = settings.max_scatterings;
  setup.slots = std::max<std::size_t>(settings.batch, 1);
  setup.origin = medium.world_bounds().center();
  WalkSettings walk = settings.walk;
  walk.origin = setup.origin;
  if (shares_paths(medium, settings.walk)) {
    setup.walkers.emplace_back(medium, walk);
  } else {
    for (int channel = 0; channel < kChannels; ++channel) {
      setup.walkers.emplace_back(medium, walk, channel);
    }
  }
  return setup;
}

/// @throws Error where weights of paths would grow at every scattering
void check_weights(const Medium& medium, const RenderSettings& settings) {
  if (settings.studies_unbounded_weights) return;
  const int channel = shares_paths(medium, settings.walk) ? Walker::kAllChannels : 0;
  require_bounded_weights(weight_growth(channels_of(medium, channel), settings.walk),
                          settings.max_scatterings);
  require_bounded_weights(shadow_weight_growth(settings.walk), settings.max_scatterings);
}

}  // namespace

RenderResult render(const Medium& medium, const Camera& camera, const Lights& lights,
                    const RenderSettings& settings, const ProgressFunction& progress) {
  if (settings.samples == 0 && settings.time_limit <= 0) {
    fail("nothing to render: neither samples nor a time limit is given");
  }
  check_weights(medium, settings);
  const PixelWindow window = pixel_window(settings.crop, camera.width(), camera.height());
  RenderResult result{.film = Film(window, settings.layers), .free_paths = {}, .shadow_rays = {}};
  const PathSetup setup = make_setup(medium, camera, lights, settings);
  PassRenderer<PathWavefront> passes([&] { return PathWavefront(setup); }, settings, progress,
                                     result.film);
  passes.run();
  finish_result(passes, settings, result);
  return result;
}

}  // namespace freepath
