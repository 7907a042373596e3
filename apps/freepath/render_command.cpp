// freepath render: a volume file in, pictures out.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/freepath/commands.h"
#include "apps/freepath/console.h"
#include "apps/freepath/film_options.h"
#include "apps/freepath/frames.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/picture_options.h"
#include "apps/freepath/render_pictures.h"
#include "apps/freepath/render_scene.h"
#include "freepath/base/error.h"
#include "freepath/paths/time_target.h"
#include "freepath/scene/volume_scene.h"

namespace freepath::program {
namespace {

constexpr const char* kRenderFooter =
    R"(Renders the densities of volume files (.vdb, .nvdb), without bias and without a limit to the
number of scatterings. Several -o write the same picture several times; an .exr holds all channels,
a .png the colour, a .film all that merging and going on need. Ctrl-C drops the paths under way, writes
what there is under partial names (picture.partial.exr), says how many samples that are, and exits with
status 75; a second Ctrl-C ends at once. Where Ctrl-C or the end of --time come before every pixel has
its first sample, that is waited for only if it will not take long (a second after Ctrl-C; as much time
again and a second after --time): pixels without a sample are black with alpha 0, and counted in a
warning, in --stats and in the .exr, which is partial too.

Several volumes overlap as parts of one medium, each where its file puts it. Options of the medium
are given once for all volumes, or once for each in the order of the files. Three grids, or a grid
of vectors, are the densities of R, G and B. All trackers walk through such media but closed-form,
which needs one homogeneous density.

With --frames, volumes whose names have a place for the number of a frame change from frame to frame,
and the others stay; every picture and --stats need a place where there are several frames. %d is the
number, %04d or #### has at least four digits, %% is a percent sign. The camera is framed once, from
the first frame that is not empty, unless --look-at places it; --seed is the same for all frames; --time is that of each
frame. Ctrl-C writes the frame under way and ends the sequence.

A density of 1 has an extinction of 1 per world unit, times --density-scale.
Methods take options after their name: weighted-decomposition:control=0.5

A scene of pbrt-v4 (.pbrt) says itself what is rendered; -o, --size, --spp, --seed, --camera,
--look-at, --fov and the methods take the place of what it says. Its parameters are listed in
docs/scenes.md.

Examples:
  freepath render cloud.vdb -o cloud.exr -o cloud.png
  freepath render room.pbrt -o around.exr --camera spherical --look-at 0,2,1
  freepath render cloud.vdb -o cloud.png --spp 256 --size 960x540 --albedo 0.999 --g 0.8
  freepath render smoke.vdb -o smoke.exr --environment sky.hdr --sun none --time 60
  freepath render haze.nvdb -o haze.exr --sigma-s 4,1,0.25 --sigma-a 0.02,0.2,1 --sun 20,120
  freepath render cloud.vdb -o furnace.exr --albedo 1 --environment 1 --stats stats.json
  freepath render cloud.vdb -o c.exr --tracker weighted-decomposition --transmittance next-flight
  freepath render smoke.vdb fire.vdb -o both.exr --albedo 0.6 --albedo 0.2 --le 0 --le 9,3,0.5
  freepath render scene.pbrt -o scene.exr --spp 256 --color spectral
  freepath render dye.vdb -o dye.exr --grid red,green,blue --tracker spectral
  freepath render smoke.%04d.vdb --frames 1-48 -o picture.%04d.exr --spp 64
  freepath render cloud.vdb -o cloud.exr --noise 0.01
  freepath render cloud.vdb -o cloud.exr --spp 4096 --checkpoint cloud.film --resume cloud.film
  freepath render cloud.vdb -o part3.film --samples 128-191
  freepath render cloud.vdb -o cloud.exr --transparent --exr half,dwaa:45)";

/// The options as they were typed.
struct RenderOptions {
  PictureOptions picture;
  FilmOptions film;
  RunPlanOptions run;
  std::string stats, frames;
  std::vector<std::string> outputs;
  uint32_t samples = 0;
  double time_limit = 0;
  bool adaptive = true;
  std::string tracker = "delta", transmittance = "ratio", interpolation = "stochastic";
  double exposure = 0;
  std::string view;
  std::function<double()> clock;
};

RenderSettings read_settings(const RenderOptions& options) {
  RenderSettings settings = read_run_settings(options.picture);
  settings.samples = options.samples;
  settings.time_limit = options.time_limit;
  settings.clock = options.clock;
  if (options.samples == 0 && options.time_limit == 0) settings.samples = 64;
  WalkSettings& walk = settings.walk;
  walk.tracker = read_tracker(options.tracker, "--tracker");
  walk.transmittance = read_method(options.transmittance, "--transmittance", transmittance_infos());
  walk.interpolation = read_interpolation(options.interpolation);
  settings.adaptive =
      options.adaptive && (options.time_limit == 0 || options.time_limit >= kShortestPlannedTime);
  return settings;
}

/// @param usual the view transform where none is given
PictureLook read_look(const RenderOptions& options, ViewTransform usual) {
  const ViewTransform view = options.view.empty() ? usual : read_view(options.view);
  return {.exposure = options.exposure, .view = view};
}

void run_scene(const CLI::App& command, const RenderOptions& options) {
  check_scene_options(command, options.picture);
  const auto given = [&](const char* name) { return command.count(name) > 0; };
  ScenePlan plan;
  plan.file = options.picture.volumes.files[0];
  plan.outputs = options.outputs;
  plan.stats = options.stats;
  plan.settings = read_settings(options);
  plan.look = read_look(options, ViewTransform::kStandard);
  plan.film = read_film_options(options.film);
  plan.run = read_run_plan(command, options.run);
  std::vector<std::string> warnings;
  plan.build = read_build_options(command, options.picture, warnings);
  for (const std::string& warning : warnings) warn("{}", warning);
  if (given("--size")) {
    const PictureSize size = parse_size(options.picture.size, "--size");
    plan.build.size = FilmSize{size.width, size.height};
  }
  if (given("--spp")) plan.samples = options.samples;
  if (given("--seed")) plan.seed = options.picture.seed;
  if (given("--max-scatterings")) plan.max_scatterings = options.picture.max_scatterings;
  if (given("--tracker")) plan.tracker = plan.settings.walk.tracker;
  if (given("--transmittance")) plan.transmittance = plan.settings.walk.transmittance;
  if (given("--interpolation")) plan.interpolation = plan.settings.walk.interpolation;
  plan.color = read_color(options.picture, ColorMode::kSpectral);
  check_wavelengths(command, plan.color);
  render_scene_file(plan);
}

void run(const CLI::App& command, const RenderOptions& options) {
  if (is_scene(options.picture)) return run_scene(command, options);
  if (options.outputs.empty())
    fail("-o, --output is required: the picture to write, .exr, .png, .pfm, .qoi or .film");
  check_wavelengths(command, read_color(options.picture, ColorMode::kRgb));
  // All that can be wrong with the options is said before the first second of work.
  const std::vector<PictureFiles> pictures =
      plan_pictures(options.frames, {.frame = {},
                                     .volumes = options.picture.volumes.files,
                                     .outputs = options.outputs,
                                     .stats = options.stats,
                                     .checkpoint = options.run.checkpoint,
                                     .resume = options.run.resume});
  const UpAxis up = read_up(options.picture);
  const FilmPlan film = read_film_options(options.film);
  std::vector<std::string> warnings;
  const RenderPlan plan{
      .settings = read_settings(options),
      .volumes = read_volumes(options.picture),
      .film = film,
      .camera = read_camera(options.picture, film),
      .up = up,
      .ground = read_ground(options.picture),
      .surroundings = make_surroundings(read_lights(options.picture), up, &warnings),
      .color = read_color(options.picture, ColorMode::kRgb),
      .super_voxel = options.picture.super_voxel,
      .sides = read_sides(options.picture),
      .look = read_look(options, ViewTransform::kNeutral),
      .run = read_run_plan(command, options.run)};
  for (const std::string& warning : warnings) warn("{}", warning);
  if (!options.frames.empty() && !options.picture.periodic.empty() && !plan.sides.extents) {
    fail("--periodic with --frames needs a --domain: that of the voxels may change with them");
  }
  if (options.frames.empty()) {
    render_picture(plan, pictures.front());
  } else {
    render_frames(plan, pictures);
  }
}

void add_output_options(CLI::App& command, RenderOptions& o) {
  command
      .add_option("-o,--output", o.outputs,
                  "Picture to write, .exr, .png, .pfm, .qoi or .film; may be repeated")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
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
  command.add_option("--exposure", o.exposure, "Exposure of a .png or .qoi [stops]")
      ->capture_default_str()
      ->check(kFiniteNumber)
      ->group("Picture");
  command
      .add_option(
          "--view", o.view,
          "View transform of a .png: standard, which clips, or neutral, which keeps hues and "
          "rolls bright light off to white [volumes: neutral, scenes: standard]")
      ->group("Picture");
  command.add_option("--stats", o.stats, "Write statistics to a JSON file")->group("Picture");
  command
      .add_option("--frames", o.frames,
                  "Frames of a sequence: 1-48, 1-48x2 for every second one, 7, or 1,5,9-12; their "
                  "number takes the place of %d, %04d or #### in the names of files")
      ->group("Picture");
}

void add_method_options(CLI::App& command, RenderOptions& o) {
  command
      .add_option("--tracker", o.tracker,
                  "Free-path sampling: " + method_names(tracker_infos()) + ", auto")
      ->capture_default_str()
      ->group("Method");
  command
      .add_option("--transmittance", o.transmittance,
                  "Transmittance of shadow rays: " + method_names(transmittance_infos()) +
                      "; where none is named, homogeneous media of scenes have residual-ratio, "
                      "which is exact there")
      ->capture_default_str()
      ->group("Method");
  command.add_option("--interpolation", o.interpolation, "nearest, trilinear or stochastic")
      ->capture_default_str()
      ->group("Method");
}

}  // namespace

void add_render_command(CLI::App& program, const std::function<double()>& clock) {
  CLI::App* command = program.add_subcommand("render", "Render volume files to pictures");
  command->footer(kRenderFooter);
  const auto options = std::make_shared<RenderOptions>();
  options->clock = clock;
  add_output_options(*command, *options);
  add_film_options(*command, options->film);
  add_run_plan_options(*command, options->run);
  add_method_options(*command, *options);
  add_picture_options(*command, options->picture);
  command
      ->add_flag("--adaptive,!--no-adaptive", options->adaptive,
                 "More samples for pixels that are noisier, by a pilot: --spp is their mean; "
                 "not with a --time below 20 s [on]")
      ->group("Picture");
  command->callback([command, options] { run(*command, *options); });
}

}  // namespace freepath::program
