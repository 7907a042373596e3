// Rendering scenes to pictures.

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/memory_budget.h"
#include "freepath/base/version.h"
#include "freepath/io/image.h"
#include "freepath/paths/noise_target.h"
#include "freepath/paths/renderer.h"
#include "freepath/sensors/tile.h"
#include "python/src/arrays.h"
#include "python/src/bindings.h"
#include "python/src/interruptible.h"
#include "python/src/pictures.h"
#include "python/src/ray_arrays.h"
#include "python/src/render_options.h"
#include "python/src/scenes.h"

namespace freepath::python {
namespace {

void check_film_memory(const PixelWindow& window, const RenderSettings& settings) {
  std::size_t channels = 4 + settings.buckets.count + channels_of(settings.layers).size();
  const auto bytes = static_cast<double>(Film::bytes_per_pixel(settings.layers, settings.buckets) +
                                         channels * sizeof(float));
  check_memory_present("the picture", fmt::format("{} x {} pixels", window.width, window.height),
                       bytes * window.width * window.height);
}

/// What the rendering threads tell the one that waits.
class ProgressDesk {
 public:
  /// @param samples of each pixel that there will be, 0 if that is not known
  /// @param wants_picture whether to keep the picture of each pass that was asked for
  ProgressDesk(uint32_t samples, bool wants_picture)
      : wants_picture_(wants_picture), progress_{.samples_total = static_cast<double>(samples)} {}

  void put(const RenderProgress& progress) {
    const std::lock_guard lock(gate_);
    progress_ = progress;
  }
  void put(const Film& film) {
    const std::lock_guard lock(gate_);
    if (wants_picture_ && !picture_) picture_ = film.to_image({});
  }
  std::pair<RenderProgress, std::optional<Image>> take() {
    const std::lock_guard lock(gate_);
    return {progress_, std::exchange(picture_, std::nullopt)};
  }

 private:
  std::mutex gate_;
  bool wants_picture_;
  RenderProgress progress_;
  std::optional<Image> picture_;
};

/// Calls callback(samples done, samples in all, seconds, picture of the last pass or None).
bool tell_progress(const nb::object& callback, ProgressDesk& desk) {
  auto [progress, picture] = desk.take();
  nb::object pixels = nb::none();
  if (picture) {
    const std::size_t channels = picture->channels.size();
    pixels =
        to_numpy(std::move(picture->values), {static_cast<std::size_t>(picture->height),
                                              static_cast<std::size_t>(picture->width), channels});
  }
  const nb::object answer =
      callback(progress.samples_done, progress.samples_total, progress.seconds, std::move(pixels));
  return !answer.is(nb::bool_(false));
}

/// The number of samples that the noise takes that is asked for.
uint32_t samples_for(const PythonScene& scene, ColorMode color, const RenderOptions& options,
                     RenderSettings settings, const std::atomic<bool>& stop) {
  if (!options.samples) settings.samples = 0;
  const NoisePlan plan = plan_noise(scene.built.scene, color, settings, *options.noise,
                                    [&](const RenderProgress&) { return !stop; });
  if (plan.interrupted) fail("ended before it was known how many samples the noise takes");
  return plan.samples;
}

/// What tells a film of these settings from others, but for what is to be told of the scene.
FilmHeader film_header(const RenderSettings& settings, ColorMode color) {
  FilmHeader header;
  header.identity = {version(), settings.walk.seed, {}};
  header.identity.add_methods(settings, color == ColorMode::kSpectral ? "spectral" : "rgb");
  header.wanted_samples = settings.samples;
  return header;
}

PythonPicture picture_of_result(RenderResult result, FilmHeader header) {
  header.counts = result.counts;
  header.seconds = result.seconds;
  describe(header, result.film);
  PythonPicture picture =
      picture_of({{}, std::move(header), std::make_shared<const Film>(std::move(result.film))});
  picture.interrupted = result.interrupted;
  return picture;
}

PythonPicture render(const PythonScene& scene, const RenderOptions& options,
                     const nb::object& callback, bool wants_pictures) {
  const ColorMode color = color_mode(scene, options);
  RenderSettings settings = render_settings(scene, options);
  const PathScene& path_scene = scene.built.scene;
  if (color != ColorMode::kSpectral) settings.buckets = {};
  const auto window = [&] {
    return pixel_window(settings.crop, path_scene.camera->width(), path_scene.camera->height());
  };
  const PixelWindow region = window();
  if (options.tile) settings.crop = tile_of(region, {options.tile->first, options.tile->second});
  if (options.range) {
    settings.first_sample = options.range->first;
    settings.samples = options.range->second - options.range->first;
  }
  check_film_memory(window(), settings);
  FilmHeader header = film_header(settings, color);
  header.region = region;
  ProgressDesk desk(settings.samples, wants_pictures);
  settings.on_pass = [&](const Film& film) { desk.put(film); };
  Poll poll;
  if (!callback.is_none()) poll = [&] { return tell_progress(callback, desk); };
  PythonPicture picture;
  run_interruptibly(
      [&](const std::atomic<bool>& stop) {
        const std::shared_lock no_other_camera(scene.camera_gate);
        if (options.noise) {
          settings.samples = samples_for(scene, color, options, settings, stop);
          header.wanted_samples = settings.samples;
        }
        picture = picture_of_result(render_scene(path_scene, color, settings,
                                                 [&](const RenderProgress& progress) {
                                                   desk.put(progress);
                                                   return !stop;
                                                 }),
                                    std::move(header));
      },
      poll);
  if (poll) poll();
  return picture;
}

/// The number of samples that render() would take where no noise is asked for.
uint32_t settled_samples(const PythonScene& scene, const RenderOptions& options) {
  return render_settings(scene, options).samples;
}

/// Seed and samples of the first pilot of a picture, and the most samples that it may have, 0: any.
std::array<uint64_t, 3> first_pilot(const PythonScene& scene, const RenderOptions& options) {
  const RenderSettings settings = render_settings(scene, options);
  return {pilot_seed(settings.walk.seed), kFirstPilot, options.samples ? settings.samples : 0};
}

/// The samples that a noise takes by a pilot, and whether it knows.
std::pair<uint32_t, bool> samples_by_pilot(const PythonFilm& pilot, double noise, uint32_t most) {
  const NoisePlan plan = plan_of_pilot(*pilot.film, noise, most);
  return {plan.samples, plan.is_known};
}

/// A scene that is seen along given rays, for as long as it lives.
class OwnSensor {
 public:
  OwnSensor(PythonScene& scene, Camera camera)
      : lock_(scene.camera_gate),
        scene_(scene.built.scene),
        camera_(std::exchange(scene_.camera, std::move(camera))),
        // Within the pixel, where rounding leads to no other one.
        filter_(std::exchange(scene_.filter, PixelFilter(BoxFilter{0.25, 0.25}))) {}
  OwnSensor(const OwnSensor&) = delete;
  OwnSensor& operator=(const OwnSensor&) = delete;
  ~OwnSensor() {
    scene_.camera = std::move(camera_);
    scene_.filter = std::move(filter_);
  }

 private:
  std::unique_lock<std::shared_mutex> lock_;
  PathScene& scene_;
  std::optional<Camera> camera_;
  PixelFilter filter_;
};

/// Radiance along rays, as pictures of `width` columns whose last row may have more pixels than
/// rays: those repeat the last ray.
PythonPicture radiance(PythonScene& scene, const RenderOptions& options, const VectorArray& origins,
                       const VectorArray& directions, const NumberArray& t_max, int width) {
  const RayArrays source(origins, directions, t_max);
  const int height = static_cast<int>((source.size() + width - 1) / width);
  std::vector<CameraRay> rays(static_cast<std::size_t>(width) * height);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i] = source.ray(std::min(i, source.size() - 1));
  }
  const ColorMode color = color_mode(scene, options);
  RenderSettings settings = render_settings(scene, options);
  settings.crop.reset();
  settings.buckets = {};
  const PixelWindow window = PixelWindow::whole(width, height);
  check_film_memory(window, settings);
  FilmHeader header = film_header(settings, color);
  header.region = window;
  return result_interruptibly([&](const std::atomic<bool>& stop) {
    const OwnSensor sensor(scene, Camera::of_rays(std::move(rays), width, height));
    return picture_of_result(render_scene(scene.built.scene, color, settings,
                                          [&](const RenderProgress&) { return !stop; }),
                             std::move(header));
  });
}

}  // namespace

void bind_rendering(nb::module_& module) {
  module.def("radiance", &radiance, nb::arg("scene"), nb::arg("options"), nb::arg("origins"),
             nb::arg("directions"), nb::arg("t_max"), nb::arg("width"));
  module.def("first_pilot", &first_pilot, nb::arg("scene"), nb::arg("options"));
  module.def("samples_by_pilot", &samples_by_pilot, nb::arg("pilot"), nb::arg("noise"),
             nb::arg("most"));
  module.def("settled_samples", &settled_samples, nb::arg("scene"), nb::arg("options"));
  module.def("render", &render, nb::arg("scene"), nb::arg("options"), nb::arg("callback").none(),
             nb::arg("wants_pictures"));
}

}  // namespace freepath::python
