#include "apps/freepath/render_pictures.h"

#include <fmt/format.h>

#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "apps/freepath/console.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/progress_bar.h"
#include "apps/freepath/render_output.h"
#include "apps/freepath/render_run.h"
#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/transport/auto_tracker.h"

namespace freepath::program {
namespace {

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
  const TrackerChoice choice = settle_picture_tracker(tracker, medium);
  if (choice.reason.empty()) {
    if (last.empty()) warn_if_biased(tracker);
  } else if (choice.tracker != last) {
    tell("auto: {}, since {}\n", choice.tracker, choice.reason);
  }
  return choice.tracker;
}

/// Renders a picture and writes it.
/// @param tracker for the medium: that of the plan may be automatic
RenderOutcome render_stage(const RenderPlan& plan, const PictureFiles& files,
                           const VolumeMedium& medium, const Stage& stage,
                           const std::string& tracker, const InputFileLog& log,
                           const StopOnInterrupt& stop, RenderReport& report) {
  report.settings = plan.settings;
  report.settings.walk.tracker = tracker;
  if (files.frame && plan.run.seed_per_frame) report.settings.walk.seed += *files.frame;
  report.settings.crop = plan.film.crop;
  report.threads = plan.settings.threads;
  report.frame = files.frame;
  const PathScene scene = make_volume_scene(medium, stage.camera, plan.surroundings, stage.ground);
  std::vector<std::pair<std::string, std::string>> facts;
  if (stage.ground && stage.ground->height) {
    facts.emplace_back("the ground's height", fmt::format("{:.9g}", *stage.ground->height));
  }
  return render_and_write({.scene = scene,
                           .color = plan.color,
                           .film = plan.film,
                           .run = plan.run,
                           .look = plan.look,
                           .outputs = files.outputs,
                           .stats = files.stats,
                           .checkpoint = files.checkpoint,
                           .resume = files.resume,
                           .files = log,
                           .facts = facts},
                          report, stop);
}

/// "frame 3 (3 of 48): 64 samples per pixel in 0:12, wrote picture.0003.exr"
void print_frame(std::size_t index, std::size_t count, int frame, const RenderOutcome& outcome,
                 const RenderReport& report) {
  const RenderResult& result = outcome.result;
  tell("frame {} ({} of {}): {}{} per pixel in {}, wrote {}\n", frame, index + 1, count,
       result.interrupted ? "interrupted after " : "", samples_text(result),
       clock_text(report.seconds_load + report.seconds_build + report.seconds_render),
       fmt::join(outcome.written, ", "));
  print_warnings(result, report);
  require_no_overflows(result);
}

/// The frames of a sequence, and how far it has come.
class Sequence {
 public:
  Sequence(const RenderPlan& plan, const std::vector<PictureFiles>& frames)
      : plan_(plan), frames_(frames) {}

  void run() {
    const StopOnInterrupt stop;
    for (std::size_t i = 0; i < frames_.size() && !stop.requested(); ++i) {
      const int frame = *frames_[i].frame;
      if (plan_.run.skip_existing && is_rendered(frames_[i].outputs, frames_[i].stats)) {
        tell("frame {} ({} of {}): is there already\n", frame, i + 1, frames_.size());
        done_.insert(frame);
        continue;
      }
      try {
        if (render(i, stop)) done_.insert(frame);
      } catch (const Error& error) {
        if (stop.requested()) {
          print_unfinished();
          fail("frame {}: {}", frame, error.what());
        }
        tell("freepath: error: frame {}: {}\n", frame, error.what());
        failed_.push_back(frame);
      }
    }
    print_unfinished();
    if (!failed_.empty()) {
      fail("{} of {} failed: --frames {}", counted(failed_.size(), "frame"), frames_.size(),
           format_frames(failed_));
    }
    if (stop.requested()) note_partial_result();
  }

 private:
  /// @return whether the frame is complete
  bool render(std::size_t i, const StopOnInterrupt& stop) {
    RenderReport report;
    const InputFileLog log;
    const VolumeMedium medium = load_medium(plan_, frames_[i], report);
    Stopwatch watch;
    if (!stage_) stage_ = frame_sequence(plan_, std::span(frames_).subspan(i), *medium.medium);
    tracker_ = settled_tracker(plan_.settings.walk.tracker, *medium.medium, tracker_);
    report.seconds_build += watch.lap();
    if (stop.requested()) {
      if (i > 0) return false;
      fail("interrupted before it was rendered: nothing is written; wait longer");
    }
    const RenderOutcome outcome =
        render_stage(plan_, frames_[i], medium, *stage_, tracker_, log, stop, report);
    print_frame(i, frames_.size(), *frames_[i].frame, outcome, report);
    return !is_partial(outcome.result, true);
  }

  /// Says how far a sequence came that did not come to its end.
  void print_unfinished() const {
    std::vector<int> done, left;
    for (const PictureFiles& files : frames_) {
      (done_.contains(*files.frame) ? done : left).push_back(*files.frame);
    }
    if (left.empty()) return;
    tell("{} done; to render the others, give --frames {}\n",
         done.empty() ? "no frame is" : fmt::format("--frames {} are", format_frames(done)),
         format_frames(left));
  }

  const RenderPlan& plan_;
  const std::vector<PictureFiles>& frames_;
  std::optional<Stage> stage_;
  std::string tracker_;
  std::set<int> done_;
  std::vector<int> failed_;
};

}  // namespace

void render_picture(const RenderPlan& plan, const PictureFiles& files) {
  if (plan.run.skip_existing && is_rendered(files.outputs, files.stats)) {
    tell("{}: is there already\n", fmt::join(files.outputs, ", "));
    return;
  }
  RenderReport report;
  const InputFileLog log;
  const VolumeMedium medium = load_medium(plan, files, report);
  Stopwatch watch;
  const Stage stage = make_stage(plan, *medium.medium);
  const std::string tracker = settled_tracker(plan.settings.walk.tracker, *medium.medium);
  report.seconds_build += watch.lap();
  const StopOnInterrupt stop;
  const RenderOutcome outcome =
      render_stage(plan, files, medium, stage, tracker, log, stop, report);
  print_summary(outcome.written, outcome.result, report);
}

void render_frames(const RenderPlan& plan, const std::vector<PictureFiles>& frames) {
  Sequence(plan, frames).run();
}

}  // namespace freepath::program
