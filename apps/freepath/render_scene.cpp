#include "apps/freepath/render_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/freepath/console.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/progress_bar.h"
#include "apps/freepath/render_output.h"
#include "apps/freepath/render_run.h"
#include "freepath/base/error.h"
#include "freepath/io/image.h"
#include "freepath/paths/renderer.h"
#include "freepath/scene/assembly/scene_settings.h"

namespace freepath::program {
namespace {

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::vector<std::string> outputs_of(const ScenePlan& plan, const BuiltScene& built) {
  std::vector<std::string> outputs = plan.outputs;
  if (outputs.empty()) {
    if (built.picture.file_name.empty()) {
      fail("{}: neither its film nor -o names a picture to write", plan.file);
    }
    outputs.push_back(built.picture.file_name);
  }
  for (const std::string& output : outputs) check_output(output);
  return outputs;
}

}  // namespace

RenderSettings settle(const ScenePlan& plan, const BuiltScene& built) {
  return settle_settings(built,
                         {.samples = plan.samples,
                          .seed = plan.seed,
                          .max_scatterings = plan.max_scatterings,
                          .tracker = plan.tracker,
                          .transmittance = plan.transmittance,
                          .interpolation = plan.interpolation,
                          .crop = plan.film.crop,
                          .layers = plan.film.layers},
                         plan.settings);
}

bool is_scene_file(const std::string& file) {
  return ends_with(file, ".pbrt") || ends_with(file, ".pbrt.gz");
}

void render_scene_file(const ScenePlan& plan) {
  check_statistics_file(plan.stats, plan.outputs, {plan.file});
  RenderReport report;
  Stopwatch watch;
  const InputFileLog log;
  Diagnostics diagnostics;
  BuiltScene built = load_scene(plan.file, diagnostics, plan.build);
  for (const std::string& warning : diagnostics.warnings()) {
    warn("{}", warning);
  }
  const std::vector<std::string> outputs = outputs_of(plan, built);
  if (plan.run.skip_existing && is_rendered(outputs, plan.stats)) {
    tell("{}: is there already\n", fmt::join(outputs, ", "));
    return;
  }
  if (!plan.run.checkpoint.empty()) {
    read_option("--checkpoint", [&] { check_file_target(plan.run.checkpoint); });
  }
  report.settings = settle(plan, built);
  report.threads = plan.settings.threads;
  report.volumes.push_back({plan.file, {}});
  report.seconds_load = watch.lap();
  if (report.settings.buckets.count > 0 && plan.color == ColorMode::kRgb) {
    warn(
        "the film is of type 'spectral', but with --color rgb there are no "
        "wavelengths: R, G and B alone are written");
    report.settings.buckets = {};
  }
  warn_if_biased(report.settings.walk.tracker);

  FilmPlan film = plan.film;
  if (!film.layers && built.picture.all_layers) film.layers = LayerSet::all();
  const StopOnInterrupt stop;
  const RenderOutcome outcome = render_and_write({.scene = built.scene,
                                                  .color = plan.color,
                                                  .film = film,
                                                  .run = plan.run,
                                                  .look = plan.look,
                                                  .outputs = outputs,
                                                  .stats = plan.stats,
                                                  .checkpoint = plan.run.checkpoint,
                                                  .resume = plan.run.resume,
                                                  .files = log},
                                                 report, stop);
  print_summary(outcome.written, outcome.result, report);
}

}  // namespace freepath::program
