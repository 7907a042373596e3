#include "apps/freepath/picture_options.h"

#include <algorithm>
#include <array>

#include "apps/freepath/parse.h"
#include "apps/freepath/render_scene.h"
#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/transport/auto_tracker.h"

namespace freepath::program {
namespace {

constexpr std::array kInterpolations{
    Choice<Interpolation>{"nearest", Interpolation::kNearest},
    Choice<Interpolation>{"trilinear", Interpolation::kTrilinear},
    Choice<Interpolation>{"stochastic", Interpolation::kStochastic}};
constexpr std::array kAbsorptions{Choice<Absorption>{"analog", Absorption::kAnalog},
                                  Choice<Absorption>{"weighted", Absorption::kWeighted}};
constexpr std::array kUpAxes{Choice<UpAxis>{"y", UpAxis::kY}, Choice<UpAxis>{"z", UpAxis::kZ}};

EmissionTally read_emission_tally(const PictureOptions& options) {
  constexpr std::array kTallies{Choice<EmissionTally>{"collision", EmissionTally::kCollision},
                                Choice<EmissionTally>{"analog", EmissionTally::kAnalog}};
  EmissionTally tally = EmissionTally::kCollision;
  for (const std::string& value : options.emission) {
    if (!looks_numeric(value)) tally = parse_choice(value, "--emission", kTallies);
  }
  return tally;
}

void add_light_options(CLI::App& command, PictureOptions& o) {
  command
      .add_option("--environment", o.environment,
                  "sky, a radiance V or R,G,B, or a latitude-longitude image (.hdr, .exr) [sky]")
      ->group("Light");
  command
      .add_option("--sun", o.sun,
                  "ELEVATION,AZIMUTH of the sun's disc [degrees, azimuth clockwise from north], "
                  "or none [38,255 under a sky, else none]")
      ->group("Light");
  command.add_option("--turbidity", o.turbidity, "Haze of sky and sun, 2 to 10")
      ->capture_default_str()
      ->check(kFiniteNumber)
      ->group("Light");
}

void add_camera_options(CLI::App& command, PictureOptions& o) {
  command
      .add_option("--color", o.color,
                  "rgb, or spectral, --wavelengths of each sample [scenes: spectral by render, rgb "
                  "by compare and plan; volumes: rgb]")
      ->group("Picture");
  command
      .add_option(
          "--wavelengths", o.wavelengths,
          fmt::format("That a path carries together with --color spectral, 1 to {}", kMaxChannels))
      ->capture_default_str()
      ->check(CLI::Range(1, kMaxChannels))
      ->group("Picture");
  command.add_option("--size", o.size, "Picture size, WIDTHxHEIGHT")
      ->capture_default_str()
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

void add_path_options(CLI::App& command, PictureOptions& o) {
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
  command
      .add_option("--max-scatterings", o.max_scatterings,
                  "Ends paths, whose light is missing then [no limit; of a scene its maxdepth]")
      ->check(CLI::PositiveNumber)
      ->group("Method");
}

void add_run_options(CLI::App& command, PictureOptions& o) {
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

void add_picture_options(CLI::App& command, PictureOptions& options) {
  command
      .add_option("volume", options.volumes.files,
                  "Volume files, .vdb or .nvdb, which overlap, each where its file puts it; or one "
                  "scene, .pbrt")
      ->required();
  add_camera_options(command, options);
  add_volume_options(command, options.volumes);
  add_light_options(command, options);
  add_path_options(command, options);
  add_run_options(command, options);
}

/// What to load, where a number given to --emission counts as one given to --le.
std::vector<VolumePlan> read_volumes(const PictureOptions& options) {
  VolumeOptions volumes = options.volumes;
  for (const std::string& value : options.emission) {
    if (looks_numeric(value)) volumes.radiance.push_back(value);
  }
  return plan_volumes(volumes);
}

LightOptions read_lights(const PictureOptions& options) {
  LightOptions lights;
  lights.invalid = read_invalid(options.volumes);
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

CameraOptions read_camera(const PictureOptions& options, const FilmPlan& film) {
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
        "--look-at: '{}' has {}; give the camera's position and perhaps the point it looks "
        "at: X,Y,Z or X,Y,Z,ATX,ATY,ATZ",
        options.look_at, counted(numbers.size(), "value"));
  }
  camera.from = Vec3d(numbers[0], numbers[1], numbers[2]);
  if (numbers.size() == 6) camera.at = Vec3d(numbers[3], numbers[4], numbers[5]);
  return camera;
}

UpAxis read_up(const PictureOptions& options) { return parse_choice(options.up, "--up", kUpAxes); }

ColorMode read_color(const PictureOptions& options, ColorMode usual) {
  constexpr std::array kColors{Choice<ColorMode>{"rgb", ColorMode::kRgb},
                               Choice<ColorMode>{"spectral", ColorMode::kSpectral}};
  if (options.color.empty()) return usual;
  return parse_choice(options.color, "--color", kColors);
}

Interpolation read_interpolation(const std::string& text) {
  return parse_choice(text, "--interpolation", kInterpolations);
}

RenderSettings read_run_settings(const PictureOptions& options) {
  RenderSettings settings;
  settings.threads = settle_threads(options.threads);
  settings.wavelengths = options.wavelengths;
  settings.batch = options.batch;
  if (options.max_scatterings > 0) settings.max_scatterings = options.max_scatterings;
  WalkSettings& walk = settings.walk;
  walk.absorption = parse_choice(options.absorption, "--absorption", kAbsorptions);
  walk.emission = read_emission_tally(options);
  walk.simd = read_option("--simd", [&] { return parse_simd(options.simd); });
  walk.seed = options.seed;
  return settings;
}

std::string read_method(const std::string& text, std::string_view option,
                        std::span<const MethodInfo> infos) {
  return read_option(option, [&] { return to_string(parse_method(text, infos), infos); });
}

std::string read_tracker(const std::string& text, std::string_view option) {
  std::vector<MethodInfo> known(tracker_infos().begin(), tracker_infos().end());
  known.push_back(kAutoInfo);
  return read_method(text, option, known);
}

std::string method_names(std::span<const MethodInfo> infos) {
  std::string list;
  for (const MethodInfo& info : infos) list += (list.empty() ? "" : ", ") + std::string(info.name);
  return list;
}

bool is_scene(const PictureOptions& options) {
  const std::vector<std::string>& files = options.volumes.files;
  if (std::none_of(files.begin(), files.end(), is_scene_file)) return false;
  if (files.size() > 1) {
    fail("'{}' is a scene: it is rendered alone, without other files", files[0]);
  }
  return true;
}

void check_scene_options(const CLI::App& command, const PictureOptions& options) {
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
  for (const std::string& value : options.emission) {
    if (!looks_numeric(value)) continue;
    fail("--emission {} is for volumes: of a scene its file says that", value);
  }
}

void check_wavelengths(const CLI::App& command, ColorMode color) {
  if (command.count("--wavelengths") > 0 && color != ColorMode::kSpectral) {
    fail("--wavelengths are those of --color spectral, but here --color is rgb");
  }
}

}  // namespace freepath::program
