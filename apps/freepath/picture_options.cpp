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

EmissionTally read_emission_tally(const PictureOptions& options) {
  constexpr std::array kTallies{Choice<EmissionTally>{"collision", EmissionTally::kCollision},
                                Choice<EmissionTally>{"analog", EmissionTally::kAnalog}};
  EmissionTally tally = EmissionTally::kCollision;
  for (const std::string& value : options.emission) {
    if (!looks_numeric(value)) tally = parse_choice(value, "--emission", kTallies);
  }
  return tally;
}

CameraKind read_camera_kind(const PictureOptions& options) {
  constexpr std::array kKinds{Choice<CameraKind>{"perspective", CameraKind::kPerspective},
                              Choice<CameraKind>{"orthographic", CameraKind::kOrthographic},
                              Choice<CameraKind>{"spherical", CameraKind::kSpherical}};
  return parse_choice(options.camera, "--camera", kKinds);
}

/// Where --look-at puts the camera and its target, if it is given.
void read_look_at(const PictureOptions& options, std::optional<Vec3d>& from,
                  std::optional<Vec3d>& at) {
  if (options.look_at.empty()) return;
  const std::vector<double> numbers = parse_numbers(options.look_at, "--look-at");
  if (numbers.size() != 3 && numbers.size() != 6) {
    fail(
        "--look-at: '{}' has {}; give the camera's position and perhaps the point it looks "
        "at: X,Y,Z or X,Y,Z,ATX,ATY,ATZ",
        options.look_at, counted(numbers.size(), "value"));
  }
  from = Vec3d(numbers[0], numbers[1], numbers[2]);
  if (numbers.size() == 6) at = Vec3d(numbers[3], numbers[4], numbers[5]);
}

/// Options that change the camera of a scene.
constexpr const char* kCameraOptions[] = {"--look-at", "--fov", "--camera"};

bool changes_camera(const CLI::App& command) {
  return std::any_of(std::begin(kCameraOptions), std::end(kCameraOptions),
                     [&](const char* name) { return command.count(name) > 0; });
}

void add_light_options(CLI::App& command, PictureOptions& o) {
  command
      .add_option("--environment", o.environment,
                  "sky, a radiance V or R,G,B, or a latitude-longitude image (.hdr, .exr) [sky; "
                  "of a scene it replaces the lights from all around]")
      ->group("Light");
  command
      .add_option("--sun", o.sun,
                  "ELEVATION,AZIMUTH[,IRRADIANCE] of the sun's disc [degrees, azimuth clockwise "
                  "from north; V or R,G,B on what faces it, that of sunlight where it is not "
                  "given], or none [38,255 under a sky, else none]")
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
                  "of the volume is framed [of a scene its own; with --fov or --camera alone that "
                  "one changes where it stands]")
      ->group("Picture");
  command
      .add_option("--camera", o.camera,
                  "perspective, orthographic (as wide as the former is where it looks at) or "
                  "spherical (all around, latitude-longitude)")
      ->capture_default_str()
      ->group("Picture");
  command
      .add_option(
          "--ground", o.ground,
          "ALBEDO[,HEIGHT], or R,G,B[,HEIGHT], of a level plane that reflects evenly [none; "
          "HEIGHT: the bottom of all else]")
      ->group("Picture");
  command.add_option("--fov", o.fov, "Vertical angle of view [degrees]")
      ->capture_default_str()
      ->check(kFiniteNumber)
      ->group("Picture");
  command
      .add_option("--periodic", o.periodic,
                  "Axes along which volumes or a scene repeat without end, as the domains of "
                  "atmospheric models do: x,y with --up z, or one of them [none]")
      ->group("Picture");
  command
      .add_option("--domain", o.domain,
                  "FROM,TO[,FROM,TO] of a period along each of them [those of the active voxels]")
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
  command
      .add_flag("--all-shadow-rays", o.all_shadow_rays,
                "Cast shadow rays that bring little too, not by Russian roulette")
      ->group("Method");
  command
      .add_flag("--no-near-light-lines", o.no_near_light_lines,
                "Find lights in or near media at scatterings alone, not along lines that pass them")
      ->group("Method");
  command
      .add_flag("--no-light-through-glass", o.no_light_through_glass,
                "Find lamps from within spheres of glass by chance alone, not where light to them "
                "is refracted")
      ->group("Method");
  command
      .add_flag("--no-lobe-splitting", o.no_lobe_splitting,
                "Never split paths towards a sun, where phase functions have lobes")
      ->group("Method");
}

}  // namespace

void add_picture_options(CLI::App& command, PictureOptions& options) {
  command
      .add_option(
          "volume", options.volumes.files,
          "Volume files of any format that freepath info reads, which overlap, each where its "
          "file puts it; or one scene, .pbrt")
      ->required();
  add_camera_options(command, options);
  add_volume_options(command, options.volumes);
  add_light_options(command, options);
  add_path_options(command, options);
  add_run_options(command, {options.seed, options.threads, options.batch, options.simd});
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
    const std::vector<double> numbers = parse_numbers(options.sun, "--sun");
    if (numbers.size() != 2 && numbers.size() != 3 && numbers.size() != 5) {
      fail(
          "--sun: '{}' is not ELEVATION,AZIMUTH in degrees, perhaps with an irradiance V or R,G,B, "
          "nor none",
          options.sun);
    }
    lights.sun_parameters.elevation = numbers[0];
    lights.sun_parameters.azimuth = numbers[1];
    if (numbers.size() > 2) lights.sun_parameters.irradiance = spectrum_of(numbers, 2);
  }
  return lights;
}

CameraOptions read_camera(const PictureOptions& options, const FilmPlan& film) {
  CameraOptions camera;
  camera.kind = read_camera_kind(options);
  const PictureSize size = parse_size(options.size, "--size");
  check_memory(pixel_window(film.crop, size.width, size.height), film);
  camera.width = size.width;
  camera.height = size.height;
  camera.fov = options.fov;
  // From below one would see the ground's underside.
  if (!options.ground.empty()) camera.elevation = -kFramingElevation;
  read_look_at(options, camera.from, camera.at);
  return camera;
}

UpAxis read_up(const PictureOptions& options) { return parse_up(options.up); }

PeriodicSides read_sides(const PictureOptions& options) {
  return parse_sides(options.periodic, options.domain, read_up(options));
}

std::optional<Ground> read_ground(const PictureOptions& options) {
  return parse_ground(options.ground, read_up(options));
}

BuildOptions read_build_options(const CLI::App& command, const PictureOptions& options,
                                std::vector<std::string>& warnings) {
  BuildOptions build{.invalid = read_invalid(options.volumes)};
  build.super_voxel = options.super_voxel;
  build.ground = read_ground(options);
  build.sides = read_sides(options);
  if (changes_camera(command)) {
    CameraChange& camera = build.camera.emplace();
    camera.kind = read_camera_kind(options);
    if (command.count("--fov") > 0) camera.fov = options.fov;
    read_look_at(options, camera.from, camera.at);
    if (command.count("--up") > 0) camera.up = read_up(options);
  }
  const bool has_environment = command.count("--environment") > 0;
  if (has_environment || command.count("--sun") > 0) {
    LightOptions lights = read_lights(options);
    if (!has_environment) lights.environment = Rgb(0.0F);  // no sky is made in vain
    build.surroundings = make_surroundings(lights, read_up(options), &warnings);
    if (!has_environment) build.surroundings.environment.reset();
  }
  // Read as those of a volume alone are.
  VolumeOptions medium;
  medium.files = {options.volumes.files.front()};
  medium.sigma_a = options.volumes.sigma_a;
  medium.sigma_s = options.volumes.sigma_s;
  medium.g = options.volumes.g;
  medium.phase = options.volumes.phase;
  const OpticalProperties optics = plan_volumes(medium).front().optics;
  build.sigma_a = optics.sigma_a;
  build.sigma_s = optics.sigma_s;
  if (!medium.g.empty() || !medium.phase.empty()) build.phase = optics.phase;
  return build;
}

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
  settings.shadow_roulette = !options.all_shadow_rays;
  settings.near_light_lines = !options.no_near_light_lines;
  settings.lobe_splitting = !options.no_lobe_splitting;
  settings.light_through_glass = !options.no_light_through_glass;
  if (options.max_scatterings > 0) settings.max_scatterings = options.max_scatterings;
  WalkSettings& walk = settings.walk;
  walk.absorption = parse_absorption(options.absorption);
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
  return read_method(text, option, tracker_choices());
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
  constexpr const char* kOfVolumes[] = {"--grid", "--density-scale", "--albedo",
                                        "--le",   "--negative",      "--frames"};
  for (const char* name : kOfVolumes) {
    const CLI::Option* const option = command.get_option_no_throw(name);
    if (option != nullptr && option->count() > 0) {
      fail("{} is for volumes: of a scene its file says that", name);
    }
  }
  const auto given = [&](const char* name) { return command.count(name) > 0; };
  const bool has_lights = given("--environment") || given("--sun");
  if (given("--turbidity") && !has_lights) {
    fail("--turbidity is that of --environment sky or of the --sun; give one of them for a scene");
  }
  const bool has_geometry = given("--ground") || given("--periodic") || changes_camera(command);
  if (given("--up") && !has_lights && !has_geometry) {
    fail(
        "--up is for --environment, --sun, --ground, --periodic and the camera; give one of their "
        "options for a scene");
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
