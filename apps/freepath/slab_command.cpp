// freepath slab: reflectance and transmittance of plane-parallel layers.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "apps/freepath/commands.h"
#include "apps/freepath/console.h"
#include "apps/freepath/estimates.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/progress_bar.h"
#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/media/phase/parse_phase_function.h"
#include "freepath/paths/slab.h"

namespace freepath::program {
namespace {

constexpr const char* kSlabFooter =
    R"(Light falls on the top of the first layer; all results are fractions of its flux, each with its
standard error. The layers have no lateral bounds and no surfaces (a refractive index of 1); paths
through them take the same walk as a renderer's. --tau, --albedo and --g are lists, from the top down;
a single value is for all layers. --mua, --mus and --thickness, in one unit of length, say the same as
--tau and --albedo; --phase, given once for all or once for each layer, is in place of --g. In thick
layers that absorb, paths split on their way down, so that even 1e-9 of the light has an answer. Where
no path came through, an upper limit at a confidence of 95 % is given instead. The result does not
depend on --threads or --batch. With --error a first 65536 paths tell how many it takes, and have no
part in the result. Ctrl-C ends early, with the paths traced so far, and exit status 75.

Methods take options after their name: weighted-delta:rate-scale=2

Examples:
  freepath slab --tau 2 --albedo 0.9 --g 0.75
  freepath slab --tau 0.25,0.25 --albedo 0.5,0.3 --g 0 --json
  freepath slab --tau 4 --albedo 0.99 --error 1e-3
  freepath slab --tau inf --albedo 0.99 --diffuse          (white-sky albedo of a half-space)
  freepath slab --tau 20 --albedo 0.5                      (a transmittance of some 1e-9)
  freepath slab --mua 0.1,0.03 --mus 10,20 --thickness 0.5,2 --g 0.9        (tissue; 1/mm and mm)
  freepath slab --tau 10 --albedo 0.9999 --phase droplets:diameter=20
  freepath slab --tau 1,inf --albedo 1,0.9 --g 0.85,0 --mu0 0.5 --paths 1e7
  freepath slab --tau 8 --albedo 0.8 --tracker weighted-delta:rate-scale=2 --absorption analog)";

/// The options as they were typed; read_* turn them into what the library takes.
struct SlabOptions {
  std::string tau, albedo, g = "0";
  std::string mua, mus, thickness;
  std::vector<std::string> phases;
  double mu0 = SlabSettings{}.mu0;
  bool diffuse = false;
  std::string paths, error;
  std::string tracker = WalkSettings{}.tracker, absorption = "weighted", simd = "best";
  uint64_t seed = 0;
  int threads = 0;
  std::size_t batch = SlabSettings{}.batch;
  int super_voxel = 0;
  double bound_scale = 1;
  bool json = false;
};

/// "1,2,inf": infinity is a number here.
std::vector<double> read_thicknesses(const std::string& text, std::string_view option) {
  std::vector<double> values;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string item = text.substr(begin, end - begin);
    const bool last = end == text.size();
    if (item != "inf") {
      values.push_back(parse_numbers(item, option)[0]);
    } else if (last) {
      values.push_back(std::numeric_limits<double>::infinity());
    } else {
      fail("{}: '{}' has inf before other layers; only the last layer can be a half-space", option,
           text);
    }
    begin = end + 1;
  }
  return values;
}

/// A value for each layer.
/// @param counted the option that says how many layers there are
std::vector<double> read_layer_values(const std::string& text, std::string_view option,
                                      std::size_t layers, std::string_view counted) {
  std::vector<double> values = parse_numbers(text, option);
  if (values.size() == 1) values.resize(layers, values[0]);
  if (values.size() != layers) {
    fail("{}: '{}' has {} values, but {} has {}; give one for each layer, or one for all", option,
         text, values.size(), counted, layers);
  }
  return values;
}

/// Layers by optical thickness and albedo.
std::vector<SlabLayer> read_optical_layers(const SlabOptions& options) {
  const std::vector<double> taus = read_thicknesses(options.tau, "--tau");
  const std::string albedo = options.albedo.empty() ? "1" : options.albedo;
  const std::vector<double> albedos = read_layer_values(albedo, "--albedo", taus.size(), "--tau");
  std::vector<SlabLayer> layers;
  for (std::size_t i = 0; i < taus.size(); ++i) layers.push_back({taus[i], albedos[i], 0});
  return layers;
}

/// Layers by coefficients and thickness.
std::vector<SlabLayer> read_physical_layers(const SlabOptions& options) {
  if (options.thickness.empty() || options.mua.empty() || options.mus.empty()) {
    fail("--mua, --mus and --thickness belong together; give all three, or --tau and --albedo");
  }
  if (!options.albedo.empty()) {
    fail("--albedo says again what --mua and --mus say; give one or the other");
  }
  const std::vector<double> thicknesses = read_thicknesses(options.thickness, "--thickness");
  const std::size_t count = thicknesses.size();
  const auto muas = read_layer_values(options.mua, "--mua", count, "--thickness");
  const auto muss = read_layer_values(options.mus, "--mus", count, "--thickness");
  std::vector<SlabLayer> layers;
  for (std::size_t i = 0; i < count; ++i) {
    const double mut = muas[i] + muss[i];
    if (!(muas[i] >= 0 && muss[i] >= 0 && mut > 0)) {
      fail("layer {} has --mua {} and --mus {}; neither may be negative, nor both 0", i + 1,
           muas[i], muss[i]);
    }
    if (!(thicknesses[i] > 0)) {
      fail("--thickness of layer {} is {}; it must be above 0", i + 1, thicknesses[i]);
    }
    layers.push_back({mut * thicknesses[i], muss[i] / mut, 0});
  }
  return layers;
}

void read_phases(const SlabOptions& options, std::vector<SlabLayer>& layers) {
  std::vector<std::shared_ptr<const PhaseFunction>> phases;
  for (const std::string& text : options.phases) {
    phases.push_back(read_option(
        "--phase", [&] { return std::make_shared<PhaseFunction>(parse_phase_function(text)); }));
  }
  if (phases.size() != 1 && phases.size() != layers.size()) {
    fail("--phase: it is given {} for {}; give it once, or once for each layer",
         counted(phases.size(), "time"), counted(layers.size(), "layer"));
  }
  for (std::size_t i = 0; i < layers.size(); ++i) {
    layers[i].phase = phases[phases.size() == 1 ? 0 : i];
  }
}

std::vector<SlabLayer> read_layers(const SlabOptions& options) {
  const bool is_physical =
      !options.mua.empty() || !options.mus.empty() || !options.thickness.empty();
  if (!is_physical && options.tau.empty()) {
    fail("no layers are given; give --tau, or --mua, --mus and --thickness");
  }
  if (is_physical && !options.tau.empty()) {
    fail("--tau says again what --mua, --mus and --thickness say; give one or the other");
  }
  std::vector<SlabLayer> layers =
      is_physical ? read_physical_layers(options) : read_optical_layers(options);
  if (!options.phases.empty()) {
    read_phases(options, layers);
    return layers;
  }
  const std::vector<double> gs =
      read_layer_values(options.g, "--g", layers.size(), is_physical ? "--thickness" : "--tau");
  for (std::size_t i = 0; i < layers.size(); ++i) layers[i].g = gs[i];
  return layers;
}

SlabSettings read_settings(const SlabOptions& options) {
  SlabSettings settings;
  settings.mu0 = options.mu0;
  settings.diffuse = options.diffuse;
  if (!options.paths.empty()) settings.paths = parse_count(options.paths, "--paths", 1, 1e15);
  settings.threads = settle_threads(options.threads);
  settings.batch = options.batch;
  settings.super_voxel = options.super_voxel;
  settings.bound_scale = static_cast<float>(options.bound_scale);
  settings.walk.tracker = options.tracker;
  settings.walk.absorption = parse_absorption(options.absorption);
  settings.walk.simd = parse_simd(options.simd);
  settings.walk.seed = options.seed;
  return settings;
}

/// Absorptance: the light that is neither reflected nor transmitted.
Estimate absorptance_of(const SlabResult& result) {
  return {1 - result.total.mean, result.total.error, {}};
}

void print_json(const SlabResult& result, const SlabSettings& settings) {
  nlohmann::ordered_json json;
  put_estimate(json, "reflectance", result.reflectance);
  put_estimate(json, "transmittance", result.transmittance);
  put_estimate(json, "unscattered", result.unscattered);
  put_estimate(json, "absorptance", absorptance_of(result));
  json["paths"] = result.paths;
  json["tracker"] = result.tracker;
  json["seed"] = settings.walk.seed;
  print_json_text(json);
}

void print_table(const SlabResult& result) {
  print_estimate("reflectance", result.reflectance, result.paths);
  print_estimate("transmittance", result.transmittance, result.paths);
  print_estimate("  unscattered", result.unscattered, result.paths);
  print_estimate("absorptance", absorptance_of(result), result.paths);
  print("{}, tracker {}\n", counted(result.paths, "path"), result.tracker);
  if (!result.tracker_reason.empty()) {
    print("auto: {}, since {}\n", result.tracker, result.tracker_reason);
  }
}

/// Number of paths that an error takes, by a few that have no part in the result.
uint64_t paths_for(double error, std::span<const SlabLayer> layers, SlabSettings settings,
                   const FluxProgress& progress) {
  settings.paths = kPilotPaths;
  settings.walk.seed = pilot_seed(settings.walk.seed);
  const SlabResult pilot = trace_slab(layers, settings, progress);
  const double largest =
      std::max({pilot.reflectance.error, pilot.transmittance.error, pilot.total.error});
  return paths_for_error(error, largest, "--error");
}

void run(const SlabOptions& options) {
  if (!options.paths.empty() && !options.error.empty()) {
    fail("--paths and --error both say when to end; give one or the other");
  }
  const std::vector<SlabLayer> layers = read_layers(options);
  SlabSettings settings = read_settings(options);
  const StopOnInterrupt stop;
  PathProgress progress(stop);
  const FluxProgress show = [&](uint64_t done, uint64_t total) {
    return progress.show(done, total);
  };
  if (!options.error.empty()) {
    settings.paths = paths_for(parse_error(options.error, "--error"), layers, settings, show);
  }
  if (stop.requested()) fail("interrupted before any path of the result: wait longer");
  const SlabResult result = trace_slab(layers, settings, show);
  progress.finish();
  if (result.paths == 0) fail("interrupted before any path of the result: wait longer");
  if (result.paths < settings.paths) {
    warn("interrupted after {} of {}", result.paths, counted(settings.paths, "path"));
    note_partial_result();
  }
  warn_if_biased(result.tracker);
  if (options.json) {
    print_json(result, settings);
  } else {
    print_table(result);
  }
}

void add_layer_options(CLI::App& command, SlabOptions& o) {
  command.add_option("--tau", o.tau,
                     "Optical thickness of each layer, T,T,...; the last may be inf");
  command.add_option("--albedo", o.albedo, "Single-scattering albedo of each layer, 0 to 1 [1]");
  command.add_option("--mua", o.mua, "In place of both: absorption coefficients [1/length],");
  command.add_option("--mus", o.mus, "scattering coefficients [1/length] and");
  command.add_option("--thickness", o.thickness, "thicknesses [length]; the last may be inf");
  CLI::Option* const g =
      command.add_option("--g", o.g, "Mean cosine of each layer's phase function, -1 to 1")
          ->capture_default_str();
  command
      .add_option("--phase", o.phases,
                  "Phase function in place of --g, as `freepath render --phase` takes it")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->excludes(g);
  CLI::Option* const mu0 =
      command.add_option("--mu0", o.mu0, "Cosine of incidence, 1 being along the normal")
          ->capture_default_str();
  command.add_flag("--diffuse", o.diffuse, "The same radiance from all directions above")
      ->excludes(mu0);
}

void add_method_options(CLI::App& command, SlabOptions& o) {
  std::string trackers;
  for (const MethodInfo& info : tracker_infos()) {
    trackers += (trackers.empty() ? "" : ", ") + std::string(info.name);
  }
  command.add_option("--tracker", o.tracker, "Free-path sampling: " + trackers + ", auto")
      ->capture_default_str();
  command.add_option("--absorption", o.absorption, "analog or weighted")->capture_default_str();
  command
      .add_option("--super-voxel", o.super_voxel,
                  "Edge of a super-voxel [voxels]: 4, 8, 16, 32, 64, or 0 for automatic")
      ->capture_default_str();
  command
      .add_option("--bound-scale", o.bound_scale,
                  "Looser bounds: under tight ones, 1, every collision in a layer is real")
      ->capture_default_str()
      ->check(kFiniteNumber);
}

void add_result_options(CLI::App& command, SlabOptions& o) {
  command.add_option("--paths", o.paths, "Paths to trace [1e6]");
  command.add_option("--error", o.error,
                     "In place of it the standard error to reach, of each of the three fluxes");
  add_run_options(command, {o.seed, o.threads, o.batch, o.simd});
  command.add_flag("--json", o.json, "Print one JSON object instead of a table");
}

}  // namespace

void add_slab_command(CLI::App& program) {
  CLI::App* const command = program.add_subcommand(
      "slab", "Reflectance and transmittance of plane-parallel layers, with standard errors");
  const auto options = std::make_shared<SlabOptions>();
  add_layer_options(*command, *options);
  add_method_options(*command, *options);
  add_result_options(*command, *options);
  command->footer(kSlabFooter);
  command->callback([options] { run(*options); });
}

}  // namespace freepath::program
