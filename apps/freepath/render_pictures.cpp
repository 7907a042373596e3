#include "apps/freepath/render_pictures.h"

#include <fmt/format.h>

#include <optional>
#include <span>
#include <string>
#include <utility>

#include "apps/freepath/console.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/progress_bar.h"
#include "apps/freepath/render_output.h"
#include "freepath/base/error.h"
#include "freepath/transport/auto_tracker.h"

namespace freepath::program {
namespace {

/// Refuses to write a picture of nothing, perhaps over one of something.
void check_not_empty(const RenderResult& result) {
  if (result.most_samples > 0) return;
  fail("{} after {:.1f} s, before any pixel had a sample: nothing is written; {}",
       result.interrupted ? "interrupted" : "the time was up", result.seconds,
       result.interrupted ? "wait longer, or choose a smaller --size"
                          : "give more --time, or choose a smaller --size or a thinner volume");
}

/// The medium of a picture, with the times it took in the report.
VolumeMedium load_medium(const RenderPlan& plan, const PictureFiles& files, RenderReport& report) {
  std::vector<VolumePlan> volume_plans = plan.volumes;
  for (std::size_t i = 0; i < volume_plans.size(); ++i) volume_plans[i].file = files.volumes[i];
  Stopwatch watch;
  std::vector<Volume> volumes = load_volumes(volume_plans, report.volumes);
  report.seconds_load = watch.lap();
  VolumeMedium medium = make_medium(std::move(volumes), plan.super_voxel, plan.sides);
  report.seconds_build = watch.lap();
  return medium;
}

/// Camera and ground, which stay the same in a sequence.
struct Stage {
  Camera camera;
  std::optional<Ground> ground;
};

Stage make_stage(const RenderPlan& plan, const Medium& medium) {
  Stage stage{make_camera(medium, plan.camera, plan.up), plan.ground};
  if (stage.ground) stage.ground->height = height_under(medium.world_bounds(), *stage.ground);
  return stage;
}

/// The stage of a sequence: framed from its first frame that holds something, whose volumes are
/// loaded for that where it is not this one.
Stage frame_sequence(const RenderPlan& plan, std::span<const PictureFiles> frames,
                     const Medium& first) {
  const bool framed = !plan.camera.from || (plan.ground && !plan.ground->height);
  for (std::size_t i = 1; framed && is_empty(first) && i < frames.size(); ++i) {
    RenderReport ignored;
    const VolumeMedium loaded = load_medium(plan, frames[i], ignored);
    if (!is_empty(*loaded.medium)) return make_stage(plan, *loaded.medium);
  }
  return make_stage(plan, first);
}

/// The tracker to walk with, after saying what users must know of it.
/// @param last the one of the frame before, of which there is nothing new to say
std::string settled_tracker(const std::string& tracker, const Medium& medium,
                            const std::string& last = {}) {
  const TrackerChoice choice = settle_tracker(tracker, medium);
  if (choice.reason.empty()) {
    if (last.empty()) warn_if_biased(tracker);
  } else if (choice.tracker != last) {
    tell("auto: {}, since {}\n", choice.tracker, choice.reason);
  }
  return choice.tracker;
}

/// Renders until it is done or the stop is wished, and writes what there is.
/// @param tracker for the medium: that of the plan may be automatic
RenderResult render_and_write(const RenderPlan& plan, const PictureFiles& files,
                              const VolumeMedium& medium, const Stage& stage,
                              const std::string& tracker, const StopOnInterrupt& stop,
                              RenderReport& report) {
  report.settings = plan.settings;
  report.settings.walk.tracker = tracker;
  report.threads = plan.settings.threads;
  report.frame = files.frame;
  RenderSettings& settings = report.settings;
  settings.layers = plan.film.recorded();
  settings.crop = plan.film.crop;
  PictureFilesAside aside(files.outputs, files.stats);
  const auto display = show_passes(plan.film, files.outputs.front(), settings);
  const PixelWindow window =
      pixel_window(settings.crop, stage.camera.width(), stage.camera.height());
  const ProgressBar bar(std::size_t(window.width) * window.height, settings.time_limit);
  const PathScene scene = make_volume_scene(medium, stage.camera, plan.surroundings, stage.ground);
  RenderResult result =
      render_scene(scene, plan.color, settings, [&](const RenderProgress& progress) {
        bar.show(progress);
        return !stop.requested();
      });
  bar.finish();
  check_not_empty(result);
  report.seconds_render = result.seconds;
  aside.write({plan.look, plan.film, display.get()}, result, report);
  return result;
}

/// "frame 3 (3 of 48): 64 samples per pixel in 0:12, wrote picture.0003.exr"
void print_frame(std::size_t index, std::size_t count, const PictureFiles& files,
                 const RenderResult& result, const RenderReport& report) {
  std::string written;
  for (const std::string& output : files.outputs) {
    if (!written.empty()) written += ", ";
    written += output;
  }
  tell("frame {} ({} of {}): {}{} per pixel in {}, wrote {}\n", *files.frame, index + 1, count,
       result.interrupted ? "interrupted after " : "", samples_text(result),
       clock_text(report.seconds_load + report.seconds_build + report.seconds_render), written);
  print_warnings(result, report);
  require_no_overflows(result);
}

/// Numbers of the frames from `begin` on, before `end`.
std::string frame_list(const std::vector<PictureFiles>& frames, std::size_t begin,
                       std::size_t end) {
  std::vector<int> numbers;
  for (std::size_t i = begin; i < end; ++i) numbers.push_back(*frames[i].frame);
  return format_frames(numbers);
}

/// Says how far a sequence came that did not come to its end.
/// @param done how many frames are complete
void print_unfinished(const std::vector<PictureFiles>& frames, std::size_t done) {
  if (done == frames.size()) return;
  const std::string finished =
      done == 0 ? "no frame is" : fmt::format("--frames {} are", frame_list(frames, 0, done));
  tell("{} done; to render the others, give --frames {}\n", finished,
       frame_list(frames, done, frames.size()));
}

}  // namespace

void render_picture(const RenderPlan& plan, const PictureFiles& files) {
  RenderReport report;
  const VolumeMedium medium = load_medium(plan, files, report);
  Stopwatch watch;
  const Stage stage = make_stage(plan, *medium.medium);
  const std::string tracker = settled_tracker(plan.settings.walk.tracker, *medium.medium);
  report.seconds_build += watch.lap();
  const StopOnInterrupt stop;
  const RenderResult result = render_and_write(plan, files, medium, stage, tracker, stop, report);
  print_summary(files.outputs, result, report);
}

void render_frames(const RenderPlan& plan, const std::vector<PictureFiles>& frames) {
  const StopOnInterrupt stop;
  std::optional<Stage> stage;
  std::string tracker;
  std::size_t done = 0;
  for (std::size_t i = 0; i < frames.size() && !stop.requested(); ++i) {
    const PictureFiles& files = frames[i];
    try {
      RenderReport report;
      const VolumeMedium medium = load_medium(plan, files, report);
      Stopwatch watch;
      if (!stage) stage = frame_sequence(plan, std::span(frames).subspan(i), *medium.medium);
      tracker = settled_tracker(plan.settings.walk.tracker, *medium.medium, tracker);
      report.seconds_build += watch.lap();
      if (stop.requested()) {
        if (i > 0) break;
        fail("interrupted before it was rendered: nothing is written; wait longer");
      }
      const RenderResult result =
          render_and_write(plan, files, medium, *stage, tracker, stop, report);
      print_frame(i, frames.size(), files, result, report);
      if (!result.interrupted) ++done;
    } catch (const Error& error) {
      print_unfinished(frames, done);
      fail("frame {}: {}", *files.frame, error.what());
    }
  }
  print_unfinished(frames, done);
}

}  // namespace freepath::program
