// Methods measured against each other.

#include "python/src/comparisons.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "freepath/study/comparison_report.h"
#include "freepath/transport/auto_tracker.h"
#include "python/src/bindings.h"
#include "python/src/interruptible.h"
#include "python/src/render_options.h"
#include "python/src/scenes.h"
#include "python/src/step_desk.h"

namespace nb = nanobind;

namespace freepath::python {
namespace {

/// What may be said of a comparison besides what is said of all of its pictures.
struct CompareOptions {
  std::vector<std::string> trackers, estimators;
  std::optional<std::vector<std::string>> interpolations;
  double time = 0;
  uint32_t samples = 0;
  int repeats = 0;
  int first_round = 0, end_round = 0;
  std::string reference, cache;
  double reference_time = 0;
  uint32_t reference_samples = 0;
  std::string digest;  ///< Name for all that the exact picture depends on.
  std::shared_ptr<const PythonReferences> references;
};

std::vector<std::string> methods_of(const std::vector<std::string>& texts,
                                    std::span<const MethodInfo> infos) {
  std::vector<std::string> methods;
  for (const std::string& text : texts)
    methods.push_back(to_string(parse_method(text, infos), infos));
  return methods;
}

std::vector<Configuration> configurations_of(const CompareOptions& options, const PathScene& scene,
                                             bool is_of_file) {
  std::vector<Interpolation> interpolations;
  for (const std::string& word :
       options.interpolations.value_or(std::vector<std::string>{"stochastic"})) {
    WalkOptions walk;
    walk.interpolation = word;
    interpolations.push_back(walk_settings(walk).interpolation);
  }
  const std::string automatic =
      is_of_file ? standard_tracker(scene)
                 : settle_picture_tracker("auto", *scene.media[0].medium()).tracker;
  return all_configurations(methods_of(options.trackers, tracker_choices()),
                            methods_of(options.estimators, transmittance_infos()), interpolations,
                            automatic);
}

/// A scene as a target, and how to compare on it. The scene has to outlive it, and nobody else may
/// use it meanwhile: references spread their samples in another way.
struct Task {
  RenderTarget target;
  ComparisonSettings settings;
};

Task task_of(PythonScene& scene, const RenderOptions& render, const CompareOptions& options) {
  const ColorMode color = color_mode(scene, render);
  PathScene& path_scene = scene.built.scene;
  Task task{.target = target_of({std::shared_ptr<void>(), &path_scene}, color), .settings = {}};
  RenderTarget& target = task.target;
  target.name = "a scene";
  target.digest = options.digest;
  ComparisonSettings& settings = task.settings;
  settings.render = render_settings(scene, render);
  settings.render.buckets = {};  // colours are compared
  const PixelWindow window = pixel_window(settings.render.crop, target.width, target.height);
  target.width = window.width;
  target.height = window.height;
  if (scene.is_of_file) {
    const RgbColorSpace& space = path_scene.spectra->space();
    target.chromaticities = RgbChromaticities{space.primaries(), space.white()};
  }
  settings.configurations = configurations_of(options, path_scene, scene.is_of_file);
  settings.may_interpolate = !options.interpolations;
  settings.time = options.time;
  settings.samples = options.samples;
  settings.repeats = options.repeats;
  settings.first_round = options.first_round;
  settings.end_round = options.end_round;
  settings.seed = settings.render.walk.seed;
  settings.reference = {.file = options.reference,
                        .time = options.reference_time,
                        .samples = options.reference_samples,
                        .cache = options.cache};
  if (options.references) settings.references = options.references->references;
  return task;
}

/// Calls compare() or references_of() of a scene.
template <class Result>
Result study(Result (*work)(const RenderTarget&, const ComparisonSettings&,
                            const ComparisonProgressFunction&),
             PythonScene& scene, const RenderOptions& render, const CompareOptions& options,
             nb::object callback) {
  const Task task = task_of(scene, render, options);
  StepDesk desk(std::move(callback));
  return result_interruptibly(
      [&](const std::atomic<bool>& stop) {
        const std::unique_lock nobody_else(scene.camera_gate);
        return work(task.target, task.settings, [&](const ComparisonProgress& progress) {
          desk.put(progress.step, progress.fraction);
          return !stop;
        });
      },
      desk.poll());
}

ReportContext context_of(const std::string& target, const std::string& machine,
                         const std::string& date) {
  return {.target = target,
          .command = "freepath.compare",
          .machine = machine,
          .date = date,
          .exposure = 0};
}

}  // namespace

void bind_comparisons(nb::module_& module) {
  nb::class_<PythonReferences>(module, "References");
  nb::class_<CompareOptions>(module, "CompareOptions")
      .def(nb::init<>())
      .def_rw("trackers", &CompareOptions::trackers)
      .def_rw("estimators", &CompareOptions::estimators)
      .def_rw("interpolations", &CompareOptions::interpolations,
              nb::for_setter(nb::arg("interpolations").none()))
      .def_rw("time", &CompareOptions::time)
      .def_rw("samples", &CompareOptions::samples)
      .def_rw("repeats", &CompareOptions::repeats)
      .def_rw("first_round", &CompareOptions::first_round)
      .def_rw("end_round", &CompareOptions::end_round)
      .def_rw("reference", &CompareOptions::reference)
      .def_rw("cache", &CompareOptions::cache)
      .def_rw("reference_time", &CompareOptions::reference_time)
      .def_rw("reference_samples", &CompareOptions::reference_samples)
      .def_rw("digest", &CompareOptions::digest)
      .def_rw("references", &CompareOptions::references,
              nb::for_setter(nb::arg("references").none()));
  nb::class_<Comparison>(module, "Comparison")
      .def(
          "json",
          [](const Comparison& self, const std::string& target, const std::string& machine,
             const std::string& date) { return json_of(self, context_of(target, machine, date)); },
          nb::arg("target"), nb::arg("machine"), nb::arg("date"))
      .def(
          "html",
          [](const Comparison& self, const std::string& target, const std::string& machine,
             const std::string& date) {
            return to_html(page_of(self, context_of(target, machine, date)));
          },
          nb::arg("target"), nb::arg("machine"), nb::arg("date"));
  module.def(
      "machine_text",
      [](const RenderOptions& render) {
        RenderSettings settings;
        settings.walk = walk_settings(render.walk);
        settings.threads = render.threads;
        return machine_text(settings);
      },
      nb::arg("options"));
  module.def(
      "compare",
      [](PythonScene& scene, const RenderOptions& render, const CompareOptions& options,
         nb::object callback) {
        return study<Comparison>(&compare, scene, render, options, std::move(callback));
      },
      nb::arg("scene"), nb::arg("options"), nb::arg("compare_options"), nb::arg("callback").none());
  module.def(
      "check_comparison",
      [](PythonScene& scene, const RenderOptions& render, const CompareOptions& options) {
        task_of(scene, render, options);
      },
      nb::arg("scene"), nb::arg("options"), nb::arg("compare_options"));
  module.def(
      "references",
      [](PythonScene& scene, const RenderOptions& render, const CompareOptions& options,
         nb::object callback) {
        return PythonReferences{study<std::vector<Reference>>(&references_of, scene, render,
                                                              options, std::move(callback))};
      },
      nb::arg("scene"), nb::arg("options"), nb::arg("compare_options"), nb::arg("callback").none());
  module.def(
      "merge_rounds",
      [](const std::vector<const Comparison*>& rounds) {
        std::vector<Comparison> copies;
        for (const Comparison* const round : rounds) copies.push_back(*round);
        return merge_rounds(std::move(copies));
      },
      nb::arg("rounds"));
  module.attr("compared_trackers") = kComparedTrackers;
}

}  // namespace freepath::python
