#include "freepath/render/paths/scene_renderer.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "freepath/base/error.h"
#include "freepath/render/pass_renderer.h"
#include "freepath/render/paths/scene_wavefront.h"

namespace freepath {
namespace {

/// Of a job whose samples need walkers of their own: their flights are walked apart, and fewer
/// would leave lanes idle.
constexpr std::size_t kPixelsOfSplitJobs = 1024;

}  // namespace

std::string standard_tracker(const PathScene& scene) {
  const SpectrumValues rgb = scene.spectra->in_rgb();
  const bool grey = std::all_of(
      scene.media.begin(), scene.media.end(),
      [&](const SceneMedium& medium) { return medium.bind(rgb).channels.has_grey_extinction(); });
  return grey || !scene.surfaces ? "delta" : "spectral";
}

RenderResult render_scene(const PathScene& scene, ColorMode mode, const RenderSettings& settings,
                          const ProgressFunction& progress) {
  if (settings.samples == 0 && settings.time_limit <= 0) {
    fail("nothing to render: neither samples nor a time limit is given");
  }
  const PixelWindow window =
      pixel_window(settings.crop, scene.camera->width(), scene.camera->height());
  const bool spectral = mode == ColorMode::kSpectral;
  RenderResult result{
      .film = Film(window, settings.layers, spectral ? settings.buckets : WavelengthBuckets{}),
      .free_paths = {},
      .shadow_rays = {}};
  const ColorFactory factory(scene, mode, settings.wavelengths, settings.walk);
  SceneSetup setup;
  setup.scene = &scene;
  setup.factory = &factory;
  setup.seed = settings.walk.seed;
  setup.max_scatterings = settings.max_scatterings;
  setup.slots = std::max<std::size_t>(settings.batch, 1);
  const auto prepare = [&](uint32_t first, uint32_t count) {
    setup.first_sample = first;
    setup.colors.assign(count, nullptr);
    tbb::parallel_for(0U, count,
                      [&](uint32_t i) { setup.colors[i] = factory.colors_of_sample(first + i); });
  };
  PassRenderer<SceneWavefront> passes([&] { return SceneWavefront(setup); }, settings, progress,
                                      result.film, prepare,
                                      factory.depends_on_sample() ? kPixelsOfSplitJobs : 1);
  passes.run();
  finish_result(passes, settings, result);
  return result;
}

}  // namespace freepath
