#include "freepath/paths/renderer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/threads.h"
#include "freepath/paths/noise_target.h"
#include "freepath/paths/pass_renderer.h"
#include "freepath/paths/path_wavefront.h"
#include "freepath/paths/sample_plan.h"
#include "freepath/paths/shadow_guide.h"

namespace freepath {
namespace {

/// Paths of a set of wavelengths in a job whose sets need walkers of their own: their flights are
/// walked apart, and fewer would leave lanes idle.
constexpr std::size_t kPathsOfSet = 1024;
/// But so many jobs there shall be, for all threads to have some.
constexpr std::size_t kFewestJobs = 16;

/// Pixels of a job of a picture that has so many.
std::size_t fewest_pixels(const WavelengthSampler& factory, std::size_t pixels, uint32_t samples) {
  if (!factory.depends_on_wavelengths()) return 1;
  const std::size_t wanted = kPathsOfSet * factory.sets_per_block() / samples;
  return std::max(kPathsOfSet, std::min(wanted, pixels / kFewestJobs));
}

/// Makes the colours of the sets that samples may have; those that are there already stay.
void prepare_colors(PathSetup& setup, uint32_t first_round, uint32_t rounds) {
  const uint32_t block = setup.factory->sets_per_block();
  const uint32_t first = first_round / block * block;
  const uint32_t count = (first_round + rounds - 1) / block * block + block - first;
  std::vector<std::shared_ptr<const SampleSpectra>> colors(count);
  for (std::size_t i = 0; i < setup.colors.size(); ++i) {
    const std::size_t set = setup.first_set + i;
    if (set >= first && set < std::size_t{first} + count) colors[set - first] = setup.colors[i];
  }
  setup.colors = std::move(colors);
  setup.first_set = first;
  tbb::parallel_for(0U, count, [&](uint32_t i) {
    if (!setup.colors[i]) setup.colors[i] = setup.factory->colors_of_set(first + i);
  });
}

/// An empty film, or that of what is gone on with.
Film begin_film(const PixelWindow& window, ColorMode mode, const RenderSettings& settings) {
  const bool spectral = mode == ColorMode::kSpectral;
  const WavelengthBuckets buckets = spectral ? settings.buckets : WavelengthBuckets{};
  if (!settings.before) return Film(window, settings.layers, buckets, settings.first_sample);
  Film film = std::move(settings.before->film);
  if (film.window() != window || film.layers() != settings.layers || film.buckets() != buckets ||
      film.first_sample() != settings.first_sample) {
    fail("what was rendered before has other pixels, layers, buckets or samples");
  }
  const uint32_t most = film.sample_counts().most;
  if (settings.samples > 0 && most > settings.samples) {
    fail("what was rendered before has {} samples of a pixel already, and {} are asked for", most,
         settings.samples);
  }
  return film;
}

/// A coarse picture by few samples.
struct Pilot {
  PilotGrid grid;
  Film film;
  double seconds = 0;
  bool is_stopped = false;
};

/// Renders the pilot of a picture, all of it whatever is cropped: parts of a picture have the same.
Pilot render_pilot(PathSetup setup, const RenderSettings& settings,
                   const ProgressFunction& progress) {
  const Camera& camera = *setup.scene->camera;
  const PilotGrid grid = PilotGrid::over(camera.width(), camera.height());
  Pilot pilot{grid, Film(PixelWindow::whole(grid.width, grid.height), {})};
  setup.pixel_edge = static_cast<float>(grid.edge);
  setup.first_random_pixel = kFirstPilotPixel;
  RenderSettings few = pilot_settings(settings);
  few.samples = kPilotSamples;
  const ProgressFunction wait = [&](const RenderProgress& now) {
    return progress({0, double(settings.samples), now.seconds});
  };
  const auto prepare = [&](uint32_t first, uint32_t count) {
    prepare_colors(setup, first, count);
    return std::size_t{1};
  };
  const ProgressFunction reported = progress ? wait : ProgressFunction();
  PassRenderer passes([&] { return PathWavefront(setup); }, few, reported, pilot.film, prepare);
  passes.run();
  pilot.seconds = passes.seconds();
  pilot.is_stopped = passes.stop_is_wished();
  return pilot;
}

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
  RenderResult result{.film = begin_film(window, mode, settings)};
  const RgbColorSpace& space = scene.spectra->space();
  const RgbChromaticities chromaticities{space.primaries(), space.white()};
  if (!are_same(chromaticities, RgbChromaticities())) {
    result.film.set_chromaticities(chromaticities);
  }
  std::optional<WavelengthSampler> made;  // by the threads that are asked for
  Threads(settings.threads).execute([&] {
    // Spectral films look at wavelengths that R, G and B hardly see.
    made.emplace(
        scene, mode, settings.wavelengths, settings.walk, settings.chooses_transmittance,
        settings.buckets.count > 0 ? WavelengthDensity::kVisible : WavelengthDensity::kFilm);
  });
  const WavelengthSampler& factory = *made;
  if (!settings.studies_unbounded_weights) {
    require_bounded_weights(factory.weight_growth(), settings.max_scatterings);
    if (!scene.media.empty()) {
      require_bounded_weights(shadow_weight_growth(settings.walk), settings.max_scatterings);
    }
  }
  std::optional<NearLights> near_lights;
  if (settings.near_light_lines) near_lights.emplace(factory, settings.walk.seed);
  std::optional<ShadowGuide> shadow_guide;
  if (settings.shadow_roulette || settings.lobe_splitting) {
    const ShadowGuide::Wanted wanted{.roulette = settings.shadow_roulette,
                                     .lobes = settings.lobe_splitting};
    Threads(settings.threads).execute([&] {
      shadow_guide.emplace(factory, wanted, settings.walk.seed);
    });
  }
  std::optional<GlassSpheres> glass_spheres;
  if (settings.light_through_glass) glass_spheres.emplace(scene);
  PathSetup setup;
  setup.glass_spheres = glass_spheres && !glass_spheres->is_empty() ? &*glass_spheres : nullptr;
  setup.near_lights = near_lights && !near_lights->is_empty() ? &*near_lights : nullptr;
  setup.shadow_guide = shadow_guide ? &*shadow_guide : nullptr;
  setup.scene = &scene;
  setup.factory = &factory;
  setup.seed = settings.walk.seed;
  setup.absorption = settings.walk.absorption;
  setup.max_scatterings = settings.max_scatterings;
  setup.transparent = settings.transparent;
  // Paths of different channels are walked apart.
  setup.slots = std::max<std::size_t>(settings.batch, 1) * factory.paths_per_sample();
  const std::size_t pixels = static_cast<std::size_t>(window.width) * window.height;
  const auto prepare = [&](uint32_t first, uint32_t count) {
    prepare_colors(setup, first, count);
    return fewest_pixels(factory, pixels, count);
  };
  RenderSettings rest = settings;
  bool is_stopped = false;
  const ProgressFunction go_on = [&](const RenderProgress& now) {
    return progress(now) && !is_stopped;
  };
  if (settings.adaptive && !settings.before) {
    const Pilot pilot = render_pilot(setup, settings, progress);
    is_stopped = pilot.is_stopped;
    give_shares(shares_of_pilot(pilot.film), pilot.grid, result.film);
    constexpr double kLeast = 1e-3;
    if (settings.time_limit > 0) {
      rest.time_limit = std::max(kLeast, settings.time_limit - pilot.seconds);
    }
  }
  const ProgressFunction reported = progress ? go_on : ProgressFunction();
  PassRenderer passes([&] { return PathWavefront(setup); }, rest, reported, result.film, prepare);
  passes.run();
  finish_result(passes, rest, result);
  return result;
}

}  // namespace freepath
