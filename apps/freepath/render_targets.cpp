#include "apps/freepath/render_targets.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "apps/freepath/console.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/render_scene.h"
#include "freepath/io/content_digest.h"
#include "freepath/media/phase/parse_phase_function.h"
#include "freepath/paths/renderer.h"
#include "freepath/scene/volume_scene.h"
#include "freepath/transport/auto_tracker.h"

namespace freepath::program {
namespace {

/// "smoke.vdb, fire.vdb"
std::string names_of(const std::vector<std::string>& files) {
  std::string names;
  for (const std::string& file : files) {
    names += (names.empty() ? "" : ", ") + std::filesystem::path(file).filename().string();
  }
  return names;
}

/// Every option that a picture depends on, as it was typed.
std::string digest_of(const CLI::App& command, const std::vector<std::filesystem::path>& files) {
  constexpr const char* kWithoutEffect[] = {"--threads", "--batch",         "--simd",
                                            "--seed",    "--interpolation", "--super-voxel"};
  constexpr const char* kOfPictures[] = {"Medium", "Light", "Picture", "Method"};
  ContentDigest digest;
  for (const CLI::Option* const option : command.get_options()) {
    const std::string name = option->get_name();
    const bool counts =
        std::any_of(std::begin(kOfPictures), std::end(kOfPictures),
                    [&](const char* group) { return option->get_group().rfind(group, 0) == 0; });
    const bool idle = std::find(std::begin(kWithoutEffect), std::end(kWithoutEffect), name) !=
                      std::end(kWithoutEffect);
    if (!counts || idle || option->count() == 0) continue;
    digest.add(name);
    for (const std::string& value : option->results()) digest.add(value);
  }
  for (const std::filesystem::path& file : files) digest.add_file(file.string());
  return digest.hex();
}

/// Files that options name, besides the volumes or the scene.
std::vector<std::filesystem::path> files_of_options(const PictureOptions& options) {
  std::vector<std::filesystem::path> files;
  const LightOptions lights = read_lights(options);
  if (const auto* image = std::get_if<std::string>(&lights.environment)) files.emplace_back(*image);
  for (const std::string& phase : options.volumes.phase) {
    for (const auto& file : phase_function_files(phase)) files.push_back(file);
  }
  return files;
}

LoadedTarget load_volume_target(const CLI::App& command, const PictureOptions& options,
                                const PictureSize& size) {
  check_wavelengths(command, read_color(options, ColorMode::kRgb));
  // All that can be wrong with the options is said before a file is read.
  read_up(options);
  read_camera(options, FilmPlan());
  read_lights(options);
  read_sides(options);
  std::vector<VolumeReport> report;
  LoadedTarget loaded = target_of_medium(options,
                                         make_medium(load_volumes(read_volumes(options), report),
                                                     options.super_voxel, read_sides(options)),
                                         size);
  std::vector<std::filesystem::path> files = files_of_options(options);
  files.insert(files.begin(), options.volumes.files.begin(), options.volumes.files.end());
  loaded.target.digest = digest_of(command, files);
  return loaded;
}

LoadedTarget load_scene_target(const CLI::App& command, const PictureOptions& options,
                               const std::optional<PictureSize>& size) {
  check_scene_options(command, options);
  ScenePlan plan;
  plan.file = options.volumes.files[0];
  plan.settings = read_run_settings(options);
  // Trackers are compared, which three channels do as well as wavelengths, with less noise of
  // colour.
  plan.color = read_color(
      options, command.count("--wavelengths") > 0 ? ColorMode::kSpectral : ColorMode::kRgb);
  check_wavelengths(command, plan.color);
  if (command.count("--max-scatterings") > 0) plan.max_scatterings = options.max_scatterings;
  std::vector<std::string> warnings;
  BuildOptions build = read_build_options(command, options, warnings);
  for (const std::string& warning : warnings) warn("{}", warning);
  if (size) {
    build.size = FilmSize{size->width, size->height};
  } else if (command.count("--size") > 0) {
    const PictureSize wanted = parse_size(options.size, "--size");
    build.size = FilmSize{wanted.width, wanted.height};
  }
  Diagnostics diagnostics;
  const auto built = std::make_shared<BuiltScene>(load_scene(plan.file, diagnostics, build));
  for (const std::string& warning : diagnostics.warnings()) {
    warn("{}", warning);
  }
  LoadedTarget loaded;
  loaded.settings = settle(plan, *built);
  loaded.settings.buckets = {};  // colours are compared
  const Camera& camera = *built->scene.camera;
  const PixelWindow window = pixel_window(loaded.settings.crop, camera.width(), camera.height());
  check_memory(window, FilmPlan());
  loaded.film = {camera.width(), camera.height()};
  loaded.automatic_tracker = standard_tracker(built->scene);
  loaded.reason = loaded.automatic_tracker == "spectral"
                      ? "media have colour, and surfaces take most of the time"
                      : "media are grey, or there are no surfaces, whose time one path for all "
                        "channels would save";
  loaded.target = target_of(std::shared_ptr<PathScene>(built, &built->scene), plan.color);
  RenderTarget& target = loaded.target;
  target.name = names_of(options.volumes.files);
  std::vector<std::filesystem::path> files = files_of_options(options);
  files.insert(files.begin(), built->files.begin(), built->files.end());
  target.digest = digest_of(command, files);
  const RgbColorSpace& space = built->scene.spectra->space();
  target.chromaticities = RgbChromaticities{space.primaries(), space.white()};
  target.width = window.width;
  target.height = window.height;
  return loaded;
}

}  // namespace

LoadedTarget target_of_medium(const PictureOptions& options, VolumeMedium volumes,
                              const PictureSize& size) {
  const UpAxis up = read_up(options);
  CameraOptions camera_options = read_camera(options, FilmPlan());
  camera_options.width = size.width;
  camera_options.height = size.height;
  std::vector<std::string> warnings;
  const Surroundings surroundings = make_surroundings(read_lights(options), up, &warnings);
  for (const std::string& warning : warnings) warn("{}", warning);
  LoadedTarget loaded;
  loaded.settings = read_run_settings(options);
  loaded.film = size;
  const Medium& medium = *volumes.medium;
  const TrackerChoice choice = settle_picture_tracker("auto", medium);
  loaded.automatic_tracker = choice.tracker;
  loaded.reason = choice.reason;
  loaded.target = target_of(
      std::make_shared<PathScene>(make_volume_scene(
          volumes, make_camera(medium, camera_options, up), surroundings, read_ground(options))),
      read_color(options, ColorMode::kRgb));
  loaded.target.name = names_of(options.volumes.files);
  loaded.volumes = std::move(volumes);
  return loaded;
}

LoadedTarget load_target(const CLI::App& command, const PictureOptions& options,
                         const std::optional<PictureSize>& size) {
  if (is_scene(options)) return load_scene_target(command, options, size);
  return load_volume_target(command, options, size ? *size : parse_size(options.size, "--size"));
}

}  // namespace freepath::program
