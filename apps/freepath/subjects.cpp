#include "apps/freepath/subjects.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <utility>

#include "apps/freepath/parse.h"
#include "apps/freepath/render_scene.h"
#include "freepath/io/content_digest.h"
#include "freepath/render/paths/scene_renderer.h"
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

LoadedSubject load_volume_subject(const CLI::App& command, const PictureOptions& options) {
  check_volume_options(command, options);
  const UpAxis up = read_up(options);
  const FilmPlan film;
  const CameraOptions camera_options = read_camera(options, film);
  const LightOptions light_options = read_lights(options);
  LoadedSubject loaded;
  loaded.settings = read_run_settings(options);
  const auto lights = std::make_shared<const Lights>(make_lights(light_options, up));
  loaded.medium = std::make_shared<const Medium>(load_medium(options, options.super_voxel));
  const auto camera =
      std::make_shared<const Camera>(make_camera(*loaded.medium, camera_options, up));
  const TrackerChoice choice = choose_tracker(*loaded.medium);
  loaded.automatic_tracker = choice.tracker;
  loaded.reason = choice.reason;
  Subject& subject = loaded.subject;
  subject.name = names_of(options.volumes.files);
  std::vector<std::filesystem::path> files(options.volumes.files.begin(),
                                           options.volumes.files.end());
  if (const auto* image = std::get_if<std::string>(&light_options.environment)) {
    files.emplace_back(*image);
  }
  subject.digest = digest_of(command, files);
  subject.width = camera->width();
  subject.height = camera->height();
  subject.render = [medium = loaded.medium, camera, lights](const RenderSettings& settings,
                                                            const ProgressFunction& progress) {
    return render(*medium, *camera, *lights, settings, progress);
  };
  return loaded;
}

LoadedSubject load_scene_subject(const CLI::App& command, const PictureOptions& options) {
  check_scene_options(command, options);
  ScenePlan plan;
  plan.file = options.volumes.files[0];
  plan.settings = read_run_settings(options);
  plan.color = read_color(options);
  if (command.count("--max-scatterings") > 0) plan.max_scatterings = options.max_scatterings;
  BuildOptions build;
  if (command.count("--size") > 0) {
    const PictureSize size = parse_size(options.size, "--size");
    build.size = FilmSize{size.width, size.height};
  }
  Diagnostics diagnostics;
  const auto built = std::make_shared<BuiltScene>(load_scene(plan.file, diagnostics, build));
  for (const std::string& warning : diagnostics.warnings()) {
    fmt::print(stderr, "warning: {}\n", warning);
  }
  LoadedSubject loaded;
  loaded.settings = settle(plan, *built);
  const SceneCamera& camera = *built->scene.camera;
  const PixelWindow window = pixel_window(loaded.settings.crop, camera.width(), camera.height());
  check_memory(window, FilmPlan());
  loaded.automatic_tracker = standard_tracker(built->scene);
  loaded.reason = loaded.automatic_tracker == "spectral"
                      ? "media have colour, and surfaces take most of the time"
                      : "media are grey, or there are no surfaces, whose time one path for all "
                        "channels would save";
  Subject& subject = loaded.subject;
  subject.name = names_of(options.volumes.files);
  subject.digest = digest_of(command, built->files);
  subject.width = window.width;
  subject.height = window.height;
  subject.render = [built, color = plan.color](const RenderSettings& settings,
                                               const ProgressFunction& progress) {
    return render_scene(built->scene, color, settings, progress);
  };
  subject.render_reference = [built, color = plan.color](const RenderSettings& settings,
                                                         const ProgressFunction& progress) {
    const SampleKind samples = std::exchange(built->scene.samples, SampleKind::kIndependent);
    RenderResult result = render_scene(built->scene, color, settings, progress);
    built->scene.samples = samples;
    return result;
  };
  return loaded;
}

}  // namespace

Medium load_medium(const PictureOptions& options, int super_voxel) {
  std::vector<VolumeReport> report;
  return make_medium(load_volumes(read_volumes(options), report), super_voxel);
}

LoadedSubject load_subject(const CLI::App& command, const PictureOptions& options) {
  return is_scene(options) ? load_scene_subject(command, options)
                           : load_volume_subject(command, options);
}

}  // namespace freepath::program
