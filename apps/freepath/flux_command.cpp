// freepath flux: what volumes that repeat sideways reflect, transmit and absorb.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/freepath/commands.h"
#include "apps/freepath/console.h"
#include "apps/freepath/estimates.h"
#include "apps/freepath/flux_output.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/picture_options.h"
#include "apps/freepath/progress_bar.h"
#include "apps/freepath/render_output.h"
#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/io/image.h"
#include "freepath/scene/flux_scene.h"
#include "freepath/scene/volume_medium.h"
#include "freepath/transport/auto_tracker.h"

namespace freepath::program {
namespace {

constexpr const char* kFluxFooter =
    R"(Light falls on the top of volumes that repeat sideways, as the domains of atmospheric models do.
Reflectance is what leaves by the top, transmittance what arrives at the bottom, absorptance what
stays in the medium, each as a fraction of what falls in and with its standard error: of the whole
domain, and of each column as a fraction of what falls on one. Over a --ground transmittance is all
that arrives there, however often, and the ground keeps its part of it. Each --view has the radiance
I that leaves in its direction, as π I / F, where F is the flux that falls in; a zenith beyond 90 is
seen from below. Light that never scattered is in no view. A medium whose coefficients differ
between R, G and B has all of these in each of the three, by paths of its own.

The domain is that of the active voxels, whatever is in them; of volumes with empty margins give
--domain. Directions are as on a compass where z is up: azimuth 0 is north, +y, and 90 east, +x.
Between columns densities change sharply (--interpolation nearest) unless another is chosen. The
result depends on the volumes, --seed and --paths, and on neither --threads nor --batch. With
--error a first 65536 paths tell how many it takes, and have no part in the result. Ctrl-C ends
early, with the paths so far, a map under a partial name, and exit status 75.

Examples:
  freepath flux cumulus.vdb --albedo 1 --phase droplets:diameter=20 --sun-zenith 30
  freepath flux cumulus.vdb --sun-zenith 0,30,60 --ground 0.06 --error 1e-4 --json
  freepath flux stratus.vdb --diffuse --density-scale 12 --columns 64,64 -o albedo.exr
  freepath flux cumulus.vdb --sun-zenith 60 --view 0,0 --view 60,90 --view 180,0 --json)";

/// The options as they were typed.
struct FluxOptions {
  VolumeOptions volumes;
  std::string up = "z", domain, columns, ground;
  std::string zenith = "0", azimuth = "270";
  bool diffuse = false;
  std::vector<std::string> views;
  std::string paths, error;
  std::string tracker = "delta", transmittance = "ratio", absorption = "weighted";
  std::string interpolation = "nearest", simd = "best";
  std::string output;
  int super_voxel = 0, threads = 0;
  uint64_t seed = 0;
  std::size_t batch = FluxSettings{}.batch;
  bool json = false;
};

/// Lights to trace one after the other: suns, or the sky.
std::vector<FluxLight> read_lights(const FluxOptions& options) {
  if (options.diffuse) return {{}};
  std::vector<double> zeniths = parse_numbers(options.zenith, "--sun-zenith");
  std::vector<double> azimuths = parse_numbers(options.azimuth, "--sun-azimuth");
  const std::size_t count = std::max(zeniths.size(), azimuths.size());
  if (zeniths.size() == 1) zeniths.resize(count, zeniths[0]);
  if (azimuths.size() == 1) azimuths.resize(count, azimuths[0]);
  if (zeniths.size() != count || azimuths.size() != count) {
    fail("--sun-zenith has {} and --sun-azimuth {}; give as many of both, or one",
         counted(zeniths.size(), "value"), counted(azimuths.size(), "value"));
  }
  std::vector<FluxLight> lights;
  for (std::size_t i = 0; i < count; ++i) {
    if (!(zeniths[i] >= 0 && zeniths[i] < 90)) {
      fail("--sun-zenith: {} is not in [0, 90): the sun stands above the horizon", zeniths[i]);
    }
    lights.push_back({FluxAngles{zeniths[i], azimuths[i]}});
  }
  return lights;
}

std::vector<FluxAngles> read_views(const FluxOptions& options) {
  std::vector<FluxAngles> views;
  for (const std::string& text : options.views) {
    const std::vector<double> numbers = parse_numbers(text, "--view");
    const bool is_level = std::abs(numbers[0] - 90) < 1e-3;
    if (numbers.size() > 2 || !(numbers[0] >= 0 && numbers[0] <= 180) || is_level) {
      fail("--view: '{}' is not ZENITH[,AZIMUTH] in degrees, with a zenith from 0 to 180 but 90",
           text);
    }
    views.push_back({numbers[0], numbers.size() > 1 ? numbers[1] : 0});
  }
  return views;
}

std::optional<std::array<uint32_t, 2>> read_columns(const FluxOptions& options) {
  if (options.columns.empty()) return std::nullopt;
  constexpr double kMost = 32768;
  const std::vector<double> numbers = parse_numbers(options.columns, "--columns");
  const auto is_count = [](double n) { return n >= 1 && n <= kMost && n == std::floor(n); };
  if (numbers.size() != 2 || !is_count(numbers[0]) || !is_count(numbers[1])) {
    fail("--columns: '{}' is not NX,NY, each a whole number from 1 to {}", options.columns, kMost);
  }
  return std::array{static_cast<uint32_t>(numbers[0]), static_cast<uint32_t>(numbers[1])};
}

FluxSettings read_settings(const FluxOptions& options) {
  FluxSettings settings;
  settings.threads = settle_threads(options.threads);
  settings.batch = options.batch;
  if (!options.paths.empty()) settings.paths = parse_count(options.paths, "--paths", 1, 1e15);
  settings.walk.tracker = read_tracker(options.tracker, "--tracker");
  settings.walk.transmittance =
      read_method(options.transmittance, "--transmittance", transmittance_infos());
  settings.walk.absorption = parse_absorption(options.absorption);
  settings.walk.interpolation = read_interpolation(options.interpolation);
  settings.walk.simd = read_option("--simd", [&] { return parse_simd(options.simd); });
  settings.walk.seed = options.seed;
  return settings;
}

/// Number of paths that an error takes, by a few that have no part in the result.
uint64_t paths_for(double error, const FluxScene& scene, FluxSettings settings,
                   const FluxProgress& progress) {
  settings.paths = kPilotPaths;
  settings.walk.seed = pilot_seed(settings.walk.seed);
  const FluxResult pilot = trace_flux(scene.scene, scene.meter, settings, progress);
  const double largest = std::max(
      {pilot.reflectance.all.error, pilot.transmittance.all.error, pilot.absorptance.all.error});
  return paths_for_error(error, largest, "--error");
}

/// Fluxes of one light.
struct LightResult {
  std::vector<FluxResult> channels;  ///< Results of the scenes that were begun.
  bool is_partial = false;
};

/// Traces light through scenes, each a channel, to the end or until it is interrupted.
/// @param error to reach in place of the settings' number of paths
LightResult trace_light(const std::vector<FluxScene>& scenes, FluxSettings settings,
                        const std::optional<double>& error, const StopOnInterrupt& stop) {
  LightResult result;
  for (const FluxScene& scene : scenes) {
    PathProgress progress(stop);
    const FluxProgress show = [&](uint64_t done, uint64_t total) {
      return progress.show(done, total);
    };
    if (error) settings.paths = paths_for(*error, scene, settings, show);
    if (stop.requested()) break;
    result.channels.push_back(trace_flux(scene.scene, scene.meter, settings, show));
    progress.finish();
    const uint64_t paths = result.channels.back().paths;
    if (paths < settings.paths) {
      result.is_partial = true;
      warn("interrupted after {} of {}", paths, counted(settings.paths, "path"));
    }
    if (stop.requested()) break;
  }
  if (!result.channels.empty() && result.channels.size() < scenes.size()) {
    result.is_partial = true;
    warn("interrupted: {} of {} channels are done", result.channels.size(), scenes.size());
  }
  return result;
}

void run(const FluxOptions& options) {
  if (!options.paths.empty() && !options.error.empty()) {
    fail("--paths and --error both say when to end; give one or the other");
  }
  if (!options.volumes.radiance.empty() || !options.volumes.temperature.empty()) {
    fail("--le and --temperature: what a medium emits is no part of these fluxes; leave them out");
  }
  const UpAxis up = parse_up(options.up);
  const std::vector<FluxLight> lights = read_lights(options);
  const std::vector<FluxAngles> views = read_views(options);
  const PeriodicSides sides = parse_sides(up == UpAxis::kY ? "x,z" : "x,y", options.domain, up);
  const auto columns = read_columns(options);
  const auto ground = parse_ground(options.ground, up);
  std::optional<double> error;
  if (!options.error.empty()) error = parse_error(options.error, "--error");
  FluxSettings settings = read_settings(options);
  if (!options.output.empty()) {
    if (image_format(options.output) != ImageFormat::kExr) {
      fail("-o: maps are written as .exr, not to '{}'", options.output);
    }
    if (lights.size() > 1) fail("-o is for one sun; {} are given", lights.size());
    check_writable(options.output);
  }
  const std::vector<VolumePlan> plans = plan_volumes(options.volumes);
  std::vector<VolumeReport> report;
  const VolumeMedium volumes = make_medium(load_volumes(plans, report), options.super_voxel, sides);
  const std::vector<VolumeMedium> channels =
      grey_media(volumes, channels_of(*volumes.medium), options.super_voxel);
  const TrackerChoice choice = settle_tracker(settings.walk.tracker, *channels[0].medium);
  settings.walk.tracker = choice.tracker;
  if (!choice.reason.empty()) tell("auto: {}, since {}\n", choice.tracker, choice.reason);
  warn_if_biased(settings.walk.tracker);
  std::vector<FluxScene> scenes;
  for (const VolumeMedium& medium : channels) {
    scenes.push_back(make_flux_scene(medium, up, ground, settings.walk.interpolation));
    FluxMeter& meter = scenes.back().meter;
    if (columns) meter.counts = *columns;
    for (const FluxAngles& view : views) meter.views.push_back(direction_of(view, up));
  }
  const StopOnInterrupt stop;
  FluxReport results{.counts = scenes[0].meter.counts,
                     .domain = scenes[0].domain,
                     .views = views,
                     .settings = settings,
                     .is_grey = channels.size() == 1,
                     .results = {}};
  bool is_partial = false;
  for (const FluxLight& light : lights) {
    for (FluxScene& scene : scenes) {
      scene.meter.beam.reset();
      if (light.sun) scene.meter.beam = -direction_of(*light.sun, up);
    }
    LightResult result = trace_light(scenes, settings, error, stop);
    is_partial = is_partial || result.is_partial;
    if (!result.channels.empty()) results.results.emplace_back(light, std::move(result.channels));
    if (stop.requested()) break;
  }
  if (results.results.empty()) fail("interrupted before any path of the result: wait longer");
  if (results.results.size() < lights.size()) {
    is_partial = true;
    warn("interrupted: {} of {} suns are done", results.results.size(), lights.size());
  }
  if (is_partial) note_partial_result();
  if (!options.output.empty()) {
    write_maps(is_partial ? partial_name(options.output) : options.output, results);
  }
  if (options.json) {
    print_json(results);
  } else {
    print_table(results);
  }
}

void add_domain_options(CLI::App& command, FluxOptions& o) {
  command.add_option("--up", o.up, "Axis that points up: y or z")
      ->capture_default_str()
      ->group("Domain");
  command
      .add_option("--domain", o.domain,
                  "FROM,TO,FROM,TO of a period along the two level axes [those of the active "
                  "voxels]")
      ->group("Domain");
  command
      .add_option("--columns", o.columns,
                  "NX,NY columns along the two level axes [one for each voxel]")
      ->group("Domain");
  command
      .add_option(
          "--ground", o.ground,
          "ALBEDO[,HEIGHT] of a level plane that reflects evenly [none; HEIGHT: the bottom]")
      ->group("Domain");
}

void add_light_options(CLI::App& command, FluxOptions& o) {
  CLI::Option* const zenith =
      command
          .add_option("--sun-zenith", o.zenith,
                      "Angles of the sun from the zenith, 0 to below 90, A,A,... [degrees]")
          ->capture_default_str()
          ->group("Light");
  CLI::Option* const azimuth =
      command
          .add_option("--sun-azimuth", o.azimuth,
                      "Where it stands, clockwise from north, one or one for each [degrees]")
          ->capture_default_str()
          ->group("Light");
  command.add_flag("--diffuse", o.diffuse, "The same radiance from all over the sky instead")
      ->excludes(zenith)
      ->excludes(azimuth)
      ->group("Light");
  command
      .add_option("--view", o.views,
                  "ZENITH[,AZIMUTH] of the direction towards one who looks [degrees]; may be "
                  "repeated")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group("Light");
}

void add_method_options(CLI::App& command, FluxOptions& o) {
  const auto add = [&](const char* name, auto& value, const std::string& text) {
    return command.add_option(name, value, text)->capture_default_str()->group("Method");
  };
  add("--tracker", o.tracker, "Free-path sampling: " + method_names(tracker_infos()) + ", auto");
  add("--transmittance", o.transmittance,
      "Transmittance towards views: " + method_names(transmittance_infos()));
  add("--absorption", o.absorption, "analog or weighted");
  add("--interpolation", o.interpolation, "nearest, trilinear or stochastic");
  add("--super-voxel", o.super_voxel,
      "Edge of a super-voxel [voxels]: 4, 8, 16, 32, 64, or 0 for automatic");
}

void add_result_options(CLI::App& command, FluxOptions& o) {
  command.add_option("--paths", o.paths, "Paths to trace for each sun [1e6]");
  command.add_option("--error", o.error,
                     "In place of it the standard error to reach, of each of the three fluxes");
  add_run_options(command, {o.seed, o.threads, o.batch, o.simd});
  command.add_flag("--json", o.json, "Print one JSON object instead of a table");
  command.add_option(
      "-o,--output", o.output,
      "Maps of the columns to write, .exr: a channel for each quantity and its error");
}

}  // namespace

void add_flux_command(CLI::App& program) {
  CLI::App* const command = program.add_subcommand(
      "flux", "Reflectance, transmittance and absorptance of volumes that repeat sideways");
  const auto options = std::make_shared<FluxOptions>();
  command
      ->add_option(
          "volume", options->volumes.files,
          "Volume files of any format that freepath info reads, which overlap, each where its "
          "file puts it")
      ->required();
  add_domain_options(*command, *options);
  add_light_options(*command, *options);
  add_volume_options(*command, options->volumes);
  add_method_options(*command, *options);
  add_result_options(*command, *options);
  command->footer(kFluxFooter);
  command->callback([options] { run(*options); });
}

}  // namespace freepath::program
