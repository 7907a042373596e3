// Options of renderings as Python gives them.

#include "python/src/render_options.h"

#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include "freepath/base/error.h"
#include "freepath/paths/time_target.h"
#include "freepath/scene/assembly/scene_settings.h"
#include "freepath/transport/auto_tracker.h"
#include "python/src/bindings.h"

namespace nb = nanobind;

namespace freepath::python {

ColorMode color_mode(const PythonScene& scene, const RenderOptions& options) {
  const std::string color = options.color.value_or(scene.is_of_file ? "spectral" : "rgb");
  if (color == "rgb") return ColorMode::kRgb;
  if (color == "spectral") return ColorMode::kSpectral;
  fail("color '{}' is unknown; there are: rgb, spectral", color);
}

RenderSettings render_settings(const PythonScene& scene, const RenderOptions& options) {
  RenderSettings settings;
  WalkOptions walk = options.walk;
  walk.interpolation = options.interpolation.value_or(walk.interpolation);
  settings.walk = walk_settings(walk);
  settings.time_limit = options.time_limit;
  settings.wavelengths = options.wavelengths;
  settings.threads = options.threads;
  settings.shadow_roulette = options.shadow_roulette;
  settings.near_light_lines = options.near_light_lines;
  settings.lobe_splitting = options.lobe_splitting;
  settings.light_through_glass = options.light_through_glass;
  settings.adaptive =
      options.adaptive && (options.time_limit == 0 || options.time_limit >= kShortestPlannedTime);
  RenderWishes wishes{.samples = options.samples,
                      .seed = options.seed,
                      .max_scatterings = options.max_scatterings,
                      .tracker = options.tracker,
                      .transmittance = options.estimator,
                      .interpolation = {},
                      .crop = {},
                      .layers = {}};
  if (options.interpolation) wishes.interpolation = settings.walk.interpolation;
  if (options.layers) wishes.layers = parse_layers(*options.layers);
  if (options.crop) {
    const auto& [x0, y0, x1, y1] = *options.crop;
    wishes.crop = Crop{x0, y0, x1, y1, false};
  }
  if (scene.is_of_file) return settle_settings(scene.built, wishes, settings);
  // Of a medium alone, what the program's standards are.
  if (!wishes.samples && options.time_limit == 0) wishes.samples = RenderSettings{}.samples;
  settings.samples = wishes.samples.value_or(0);
  settings.max_scatterings = wishes.max_scatterings.value_or(settings.max_scatterings);
  settings.crop = wishes.crop;
  settings.layers = wishes.layers.value_or(settings.layers);
  settings.walk.seed = wishes.seed.value_or(0);
  const std::string tracker = wishes.tracker.value_or("delta");
  settings.walk.tracker =
      settle_picture_tracker(to_string(parse_method(tracker, tracker_choices()), tracker_choices()),
                             *scene.built.scene.media[0].medium())
          .tracker;
  settings.walk.transmittance =
      to_string(parse_method(wishes.transmittance.value_or("ratio"), transmittance_infos()),
                transmittance_infos());
  return settings;
}

void bind_render_options(nb::module_& module) {
  nb::class_<RenderOptions>(module, "RenderOptions")
      .def(nb::init<>())
      .def_rw("walk", &RenderOptions::walk)
      .def_rw("tracker", &RenderOptions::tracker, nb::for_setter(nb::arg("tracker").none()))
      .def_rw("estimator", &RenderOptions::estimator, nb::for_setter(nb::arg("estimator").none()))
      .def_rw("interpolation", &RenderOptions::interpolation,
              nb::for_setter(nb::arg("interpolation").none()))
      .def_rw("layers", &RenderOptions::layers, nb::for_setter(nb::arg("layers").none()))
      .def_rw("color", &RenderOptions::color, nb::for_setter(nb::arg("color").none()))
      .def_rw("samples", &RenderOptions::samples, nb::for_setter(nb::arg("samples").none()))
      .def_rw("max_scatterings", &RenderOptions::max_scatterings,
              nb::for_setter(nb::arg("max_scatterings").none()))
      .def_rw("seed", &RenderOptions::seed, nb::for_setter(nb::arg("seed").none()))
      .def_rw("time_limit", &RenderOptions::time_limit)
      .def_rw("noise", &RenderOptions::noise)
      .def_rw("crop", &RenderOptions::crop, nb::for_setter(nb::arg("crop").none()))
      .def_rw("range", &RenderOptions::range, nb::for_setter(nb::arg("range").none()))
      .def_rw("tile", &RenderOptions::tile, nb::for_setter(nb::arg("tile").none()))
      .def_rw("wavelengths", &RenderOptions::wavelengths)
      .def_rw("threads", &RenderOptions::threads)
      .def_rw("shadow_roulette", &RenderOptions::shadow_roulette)
      .def_rw("near_light_lines", &RenderOptions::near_light_lines)
      .def_rw("lobe_splitting", &RenderOptions::lobe_splitting)
      .def_rw("light_through_glass", &RenderOptions::light_through_glass)
      .def_rw("adaptive", &RenderOptions::adaptive);
}

}  // namespace freepath::python
