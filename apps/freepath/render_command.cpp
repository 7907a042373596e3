// freepath render: a volume file in, pictures out.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "apps/freepath/commands.h"
#include "apps/freepath/film_options.h"
#include "apps/freepath/frames.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/render_pictures.h"
#include "apps/freepath/render_scene.h"
#include "apps/freepath/render_volumes.h"
#include "freepath/base/error.h"
#include "freepath/scene/volume_scene.h"
#include "freepath/transport/auto_tracker.h"

namespace freepath::program {
namespace {

constexpr const char* kFooter =
    R"(Renders the densities of volume files (.vdb, .nvdb), without bias and without a limit to the
number of scatterings. Several -o write the same picture several times; an .exr holds all channels,
a .png the colour. Ctrl-C drops the paths under way, writes what there is, says how many samples
that are, and exits with status 0; a second Ctrl-C ends at once. Where Ctrl-C or the end of --time
come before every pixel has its first sample, that is waited for only if it will not take long
(a second after Ctrl-C; as much time again and a second after --time): pixels without a sample are
black with alpha 0, and counted in a warning, in --stats and in the .exr.

Several volumes overlap as parts of one medium, each where its file puts it. Options of the medium
are given once for all volumes, or once for each in the order of the files. Three grids, or a grid
of vectors, are the densities of R, G and B. All trackers walk through such media but closed-form,
which needs one homogeneous density.

With --frames, volumes whose names have a place for the number of a frame change from frame to frame,
and the others stay; every picture and --stats need a place where there are several frames. %d is the
number, %04d or #### has at least four digits, %% is a percent sign. The camera is framed once, from
the first frame, unless --look-at places it; --seed is the same for all frames; --time is that of each
frame. Ctrl-C writes the frame under way and ends the sequence.

A density of 1 has an extinction of 1 per world unit, times --density-scale.
Methods take options after their name: weighted-delta:rate-scale=0.7

A scene of pbrt-v4 (.pbrt) says itself what is rendered; -o, --size, --spp, --seed and the methods
take the place of what it says. Its parameters are listed in docs/scenes.md.

Examples:
  freepath render cloud.vdb -o cloud.exr -o cloud.png
  freepath render cloud.vdb -o cloud.png --spp 256 --size 960x540 --albedo 0.999 --g 0.8
  freepath render smoke.vdb -o smoke.exr --environment sky.hdr --sun none --time 60
  freepath render haze.nvdb -o haze.exr --sigma-s 4,1,0.25 --sigma-a 0.02,0.2,1 --sun 20,120
  freepath render cloud.vdb -o furnace.exr --albedo 1 --environment 1 --stats stats.json
  freepath render cloud.vdb -o c.exr --tracker weighted-delta:rate-scale=0.7 --transmittance ratio
  freepath render smoke.vdb fire.vdb -o both.exr --albedo 0.6 --albedo 0.2 --le 0 --le 9,3,0.5
  freepath render scene.pbrt -o scene.exr --spp 256 --color spectral
  freepath render dye.vdb -o dye.exr --grid red,green,blue --tracker spectral
  freepath render smoke.%04d.vdb --frames 1-48 -o picture.%04d.exr --spp 64)";

constexpr std::array kInterpolations{
    Choice<Interpolation>{"nearest", Interpolation::kNearest},
    Choice<Interpolation>{"trilinear", Interpolation::kTrilinear},
    Choice<Interpolation>{"stochastic", Interpolation::kStochastic}};
constexpr std::array kAbsorptions{Choice<Absorption>{"analog", Absorption::kAnalog},
                                  Choice<Absorption>{"weighted", Absorption::kWeighted}};
constexpr std::array kUpAxes{Choice<UpAxis>{"y", UpAxis::kY}, Choice<UpAxis>{"z", UpAxis::kZ}};

/// The options as they were typed; read_* turn them into what the library takes.
struct Options {
  VolumeOptions volumes;
  FilmOptions film;
  std::string stats, frames;
  std::vector<std::string> outputs;
  uint32_t samples = 0;
  double time_limit = 0;
  std::string size = "640x360";
  uint64_t seed = 0;
  int threads = 0;
  std::size_t batch = RenderSettings{}.batch;
  uint32_t max_scatterings = 0;
  std::string environment, sun;
  double turbidity = SunParameters{}.turbidity;
  std::string tracker = "delta", transmittance = "ratio", interpolation = "stochastic";
  std::string absorption = "weighted";
  std::vector<std::string> emission;
  std::string simd = "best", color;
  int super_voxel = 0;
  std::string up = "y", look_at;
  double fov = CameraOptions{}.fov;
  double exposure = 0;
};

/// What to load, where a number given to --emission counts as one given to --le.
std::vector<VolumePlan> read_volumes(const Options& options) {
  VolumeOptions volumes = options.volumes;
  for (const std::string& value : options.emission) {
    if (looks_numeric(value)) volumes.radiance.push_back(value);
  }
  return plan_volumes(volumes);
}

LightOptions read_lights(const Options& options) {
  LightOptions lights;
  const bool default_lights = options.environment.empty() || options.environment == "sky";
  if (looks_numeric(options.environment)) {
    lights.environment = parse_spectrum(options.environment, "--environment");
  } else if (!default_lights) {
    lights.environment = options.environment;
  }
  lights.sun = options.sun.empty() ? default_lights : options.sun != "none";
  lights.sun_parameters.turbidity = options.turbidity;
  if (!options.sun.empty() && options.sun != "none") {
    const std::vector<double> angles = parse_numbers(options.sun, "--sun");
    if (angles.size() != 2) {
      fail("--sun: '{}' is not ELEVATION,AZIMUTH in degrees, nor none", options.sun);
    }
    lights.sun_parameters.elevation = angles[0];
    lights.sun_parameters.azimuth = angles[1];
  }
  return lights;
}

CameraOptions read_camera(const Options& options, const FilmPlan& film) {
  CameraOptions camera;
  const PictureSize size = parse_size(options.size, "--size");
  check_memory(pixel_window(film.crop, size.width, size.height), film);
  camera.width = size.width;
  camera.height = size.height;
  camera.fov = options.fov;
  if (options.look_at.empty()) return camera;
  const std::vector<double> numbers = parse_numbers(options.look_at, "--look-at");
  if (numbers.size() != 3 && numbers.size() != 6) {
    fail(
        "--look-at: '{}' has {} values; give the camera's position and perhaps the point it looks "
        "at: X,Y,Z or X,Y,Z,ATX,ATY,ATZ",
        options.look_at, numbers.size());
  }
  camera.from = Vec3d(numbers[0], numbers[1], numbers[2]);
  if (numbers.size() == 6) camera.at = Vec3d(numbers[3], numbers[4], numbers[5]);
  return camera;
}

EmissionTally read_emission_tally(const Options& options) {
  constexpr std::array kTallies{Choice<EmissionTally>{"collision", EmissionTally::kCollision},
                                Choice<EmissionTally>{"analog", EmissionTally::kAnalog}};
  EmissionTally tally = EmissionTally::kCollision;
  for (const std::string& value : options.emission) {
    if (!looks_numeric(value)) tally = parse_choice(value, "--emission", kTallies);
  }
  return tally;
}

/// A method with its options, in one spelling.
std::string read_method(const std::string& text, std::string_view option,
                        std::span<const MethodInfo> infos) {
  return read_option(option, [&] { return to_string(parse_method(text, infos), infos); });
}

RenderSettings read_settings(const Options& options) {
  RenderSettings settings;
  settings.samples = options.samples;
  settings.time_limit = options.time_limit;
  if (options.samples == 0 && options.time_limit == 0) settings.samples = 64;
  settings.threads = options.threads;
  settings.batch = options.batch;
  if (options.max_scatterings > 0) settings.max_scatterings = options.max_scatterings;
  WalkSettings& walk = settings.walk;
  walk.tracker = options.tracker == kAutoTracker
                     ? options.tracker
                     : read_method(options.tracker, "--tracker", tracker_infos());
  walk.transmittance = read_method(options.transmittance, "--transmittance", transmittance_infos());
  walk.interpolation = parse_choice(options.interpolation, "--interpolation", kInterpolations);
  walk.absorption = parse_choice(options.absorption, "--absorption", kAbsorptions);
  walk.emission = read_emission_tally(options);
  walk.simd = read_option("--simd", [&] { return parse_simd(options.simd); });
  walk.seed = options.seed;
  return settings;
}

/// Options that a scene's file has the say in.
void check_scene_options(const CLI::App& command) {
  constexpr const char* kOfVolumes[] = {
      "--grid",   "--density-scale", "--albedo",  "--sigma-a",  "--sigma-s",
      "--g",      "--phase",         "--le",      "--negative", "--environment",
      "--sun",    "--turbidity",     "--look-at", "--fov",      "--up",
      "--frames", "--super-voxel"};
  for (const char* name : kOfVolumes) {
    const CLI::Option* const option = command.get_option_no_throw(name);
    if (option != nullptr && option->count() > 0) {
      fail("{} is for volumes: of a scene its file says that", name);
    }
  }
}

void run_scene(const CLI::App& command, const Options& options) {
  if (options.volumes.files.size() > 1) {
    fail("'{}' is a scene: it is rendered alone, without other files", options.volumes.files[0]);
  }
  check_scene_options(command);
  for (const std::string& value : options.emission) {
    if (looks_numeric(value))
      fail("--emission {} is for volumes: of a scene its file says that", value);
  }
  constexpr std::array kColors{Choice<ColorMode>{"rgb", ColorMode::kRgb},
                               Choice<ColorMode>{"spectral", ColorMode::kSpectral}};
  const auto given = [&](const char* name) { return command.count(name) > 0; };
  ScenePlan plan;
  plan.file = options.volumes.files[0];
  plan.outputs = options.outputs;
  plan.stats = options.stats;
  plan.settings = read_settings(options);
  plan.exposure = options.exposure;
  plan.film = read_film_options(options.film);
  if (given("--size")) plan.size = parse_size(options.size, "--size");
  if (given("--spp")) plan.samples = options.samples;
  if (given("--seed")) plan.seed = options.seed;
  if (given("--max-scatterings")) plan.max_scatterings = options.max_scatterings;
  if (given("--tracker")) plan.tracker = plan.settings.walk.tracker;
  if (given("--transmittance")) plan.transmittance = plan.settings.walk.transmittance;
  if (given("--interpolation")) plan.interpolation = plan.settings.walk.interpolation;
  if (given("--color")) plan.color = parse_choice(options.color, "--color", kColors);
  render_scene_file(plan);
}

void run(const CLI::App& command, const Options& options) {
  const auto& files = options.volumes.files;
  if (std::any_of(files.begin(), files.end(), is_scene_file)) return run_scene(command, options);
  if (options.outputs.empty()) fail("-o, --output is required: the picture to write, .exr or .png");
  if (command.count("--color") > 0 && options.color != "rgb") {
    fail("--color {}: volumes are rendered in rgb, scenes (.pbrt) in rgb or spectral",
         options.color);
  }
  // All that can be wrong with the options is said before the first second of work.
  const std::vector<PictureFiles> pictures =
      plan_pictures(options.frames, {.frame = {},
                                     .volumes = options.volumes.files,
                                     .outputs = options.outputs,
                                     .stats = options.stats});
  const UpAxis up = parse_choice(options.up, "--up", kUpAxes);
  const FilmPlan film = read_film_options(options.film);
  const RenderPlan plan{.settings = read_settings(options),
                        .volumes = read_volumes(options),
                        .film = film,
                        .camera = read_camera(options, film),
                        .up = up,
                        .lights = make_lights(read_lights(options), up),
                        .super_voxel = options.super_voxel,
                        .exposure = options.exposure};
  if (options.frames.empty()) {
    render_picture(plan, pictures.front());
  } else {
    render_frames(plan, pictures);
  }
}

void add_picture_options(CLI::App& command, Options& o) {
  command.add_option("-o,--output", o.outputs, "Picture to write, .exr or .png; may be repeated")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group("Picture");
  command
      .add_option("--color", o.color,
                  "Of a scene: rgb, or spectral, four wavelengths of each sample [spectral]")
      ->group("Picture");
  command.add_option("--size", o.size, "Picture size, WIDTHxHEIGHT")
      ->capture_default_str()
      ->group("Picture");
  command.add_option("--spp", o.samples, "Samples per pixel [64]")
      ->check(CLI::Range(1U, 1U << 30))
      ->group("Picture");
  command
      .add_option("--time", o.time_limit,
                  "Seconds to render; the first sample of every pixel may take twice that and a "
                  "second; with --spp, whichever ends first")
      ->check(kFiniteNumber & CLI::PositiveNumber)
      ->group("Picture");
  command.add_option("--exposure", o.exposure, "Exposure of a .png [stops]")
      ->capture_default_str()
      ->check(kFiniteNumber)
      ->group("Picture");
  command.add_option("--stats", o.stats, "Write statistics to a JSON file")->group("Picture");
  command
      .add_option("--frames", o.frames,
                  "Frames of a sequence: 1-48, 1-48x2 for every second one, 7, or 1,5,9-12; their "
                  "number takes the place of %d, %04d or #### in the names of files")
      ->group("Picture");
  command
      .add_option("--look-at", o.look_at,
                  "Camera position, and perhaps its target: X,Y,Z[,ATX,ATY,ATZ]; by default all "
                  "of the volume is framed")
      ->group("Picture");
  command.add_option("--fov", o.fov, "Vertical angle of view [degrees]")
      ->capture_default_str()
      ->check(kFiniteNumber)
      ->group("Picture");
  command.add_option("--up", o.up, "Axis that points up: y or z")
      ->capture_default_str()
      ->group("Picture");
}

void add_light_options(CLI::App& command, Options& o) {
  command
      .add_option("--environment", o.environment,
                  "sky, a radiance V or R,G,B, or a latitude-longitude image (.hdr, .exr) [sky]")
      ->group("Light");
  command
      .add_option("--sun", o.sun,
                  "ELEVATION,AZIMUTH of the sun's disc [degrees, azimuth clockwise from north], "
                  "or none [40,250 under a sky, else none]")
      ->group("Light");
  command.add_option("--turbidity", o.turbidity, "Haze of sky and sun, 2 to 10")
      ->capture_default_str()
      ->check(kFiniteNumber)
      ->group("Light");
}

void add_method_options(CLI::App& command, Options& o) {
  const auto names = [](std::span<const MethodInfo> infos) {
    std::string list;
    for (const MethodInfo& info : infos)
      list += (list.empty() ? "" : ", ") + std::string(info.name);
    return list;
  };
  command
      .add_option("--tracker", o.tracker,
                  "Free-path sampling: " + names(tracker_infos()) + ", auto")
      ->capture_default_str()
      ->group("Method");
  command
      .add_option("--transmittance", o.transmittance,
                  "Transmittance of shadow rays: " + names(transmittance_infos()))
      ->capture_default_str()
      ->group("Method");
  command.add_option("--interpolation", o.interpolation, "nearest, trilinear or stochastic")
      ->capture_default_str()
      ->group("Method");
  command.add_option("--absorption", o.absorption, "analog or weighted")
      ->capture_default_str()
      ->group("Method");
  command
      .add_option("--emission", o.emission,
                  "collision or analog [collision]; a number or R,G,B is taken as --le")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group("Method");
  command
      .add_option("--super-voxel", o.super_voxel,
                  "Edge of a super-voxel [voxels]: 4, 8, 16, 32, 64, or 0 for automatic")
      ->capture_default_str()
      ->group("Method");
  command.add_option("--max-scatterings", o.max_scatterings, "Ends paths; biased [no limit]")
      ->check(CLI::PositiveNumber)
      ->group("Method");
}

void add_run_options(CLI::App& command, Options& o) {
  command.add_option("--seed", o.seed, "Seed of the random numbers")
      ->capture_default_str()
      ->check(kWholeNumber);
  command.add_option("--threads", o.threads, "Threads [all]")->check(CLI::Range(1, 1024));
  command.add_option("--batch", o.batch, "Paths in flight per thread; changes no result")
      ->capture_default_str()
      ->check(CLI::Range(1, 1 << 20));
  command.add_option("--simd", o.simd, "best, avx512, avx2, sse4 or one-lane")
      ->capture_default_str();
}

}  // namespace

void add_render_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("render", "Render volume files to pictures");
  command->footer(kFooter);
  const auto options = std::make_shared<Options>();
  command
      ->add_option(
          "volume", options->volumes.files,
          "Volume files, .vdb or .nvdb, which overlap, each where its file puts it; or one "
          "scene, .pbrt")
      ->required();
  add_picture_options(*command, *options);
  add_film_options(*command, options->film);
  add_volume_options(*command, options->volumes);
  add_light_options(*command, *options);
  add_method_options(*command, *options);
  add_run_options(*command, *options);
  command->callback([command, options] { run(*command, *options); });
}

}  // namespace freepath::program
