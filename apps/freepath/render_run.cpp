#include "apps/freepath/render_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/freepath/console.h"
#include "apps/freepath/parse.h"
#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/base/json_text.h"
#include "freepath/paths/noise_target.h"
#include "freepath/paths/time_target.h"

namespace freepath::program {
namespace {

nlohmann::json json_of(const auto& value) { return value; }
nlohmann::json json_of(const Matrix4d& matrix) {
  const double* const values = matrix.getValue();
  return std::vector<double>(values, values + 16);
}

/// What merging needs to know to write the picture as rendering does.
std::string notes_of(const RenderReport& report, const PictureLook& look) {
  nlohmann::json metadata = nlohmann::json::array();
  for (const auto& [name, value] : report.metadata) {
    metadata.push_back({name, std::visit([](const auto& v) { return json_of(v); }, value)});
  }
  return json_text(nlohmann::json{{"metadata", metadata}, {"view", static_cast<int>(look.view)}});
}

/// Saves films now and then; what hinders it is told once, and the rendering goes on.
class CheckpointWriter {
 public:
  CheckpointWriter(std::string file, const FilmHeader& header)
      : file_(std::move(file)), header_(header) {}

  void write(const Film& film, const PathCounts& counts, double seconds) {
    try {
      AtomicFile aside(file_);
      FilmHeader header = header_;
      header.counts = counts;
      header.seconds = seconds;
      write_film(aside, std::move(header), film);
      if (!failure_.empty()) warn("{}: checkpoints are written again", file_);
      failure_.clear();
    } catch (const std::exception& error) {
      if (failure_ == error.what()) return;
      failure_ = error.what();
      warn("no checkpoint: {}; rendering goes on, and the last one that was written stays",
           failure_);
    }
  }

 private:
  std::string file_;
  const FilmHeader& header_;
  std::string failure_;
};

std::string window_text(const PixelWindow& w) {
  return fmt::format("{}x{} pixels from ({}, {}) on, of {}x{}", w.width, w.height, w.x, w.y,
                     w.full_width, w.full_height);
}

/// The film to go on with, after it is known to be of this picture.
std::shared_ptr<RenderedBefore> load_before(const std::string& file, const FilmHeader& expected,
                                            const RenderSettings& settings,
                                            const WavelengthBuckets& buckets) {
  FilmFile loaded = read_film(file);
  const FilmHeader& header = loaded.header;
  std::string reason = difference(expected.identity, header.identity);
  const auto compare = [&](bool is_same, const std::string& text) {
    if (reason.empty() && !is_same) reason = text;
  };
  compare(header.window == expected.window,
          "it has " + window_text(header.window) + " and not " + window_text(expected.window));
  compare(header.layers == settings.layers,
          "its layers are " + to_string(header.layers) + " and not " + to_string(settings.layers));
  compare(header.buckets == buckets, "its buckets of wavelengths are others");
  compare(
      header.first_sample == settings.first_sample,
      fmt::format("its first sample is {} and not {}", header.first_sample, settings.first_sample));
  compare(settings.samples == 0 || header.samples.most <= settings.samples,
          fmt::format("it has {} of a pixel already, and {} are asked for",
                      counted(header.samples.most, "sample"), settings.samples));
  if (!reason.empty()) {
    fail("--resume {}: it can't be gone on with: {}; give the options that it was begun with", file,
         reason);
  }
  tell("{}: goes on from {} per pixel\n", file, counted(header.samples.fewest, "sample"));
  return std::make_shared<RenderedBefore>(
      RenderedBefore{std::move(loaded.film), header.counts, header.seconds});
}

bool exists(const std::string& file) {
  std::error_code error;
  return std::filesystem::exists(file, error);
}

/// The film's file to go on from, if there is one.
std::optional<std::string> file_to_resume(const RenderJob& job) {
  if (job.resume.empty()) return std::nullopt;
  if (job.resume == job.checkpoint && !exists(job.resume)) return std::nullopt;
  return job.resume;
}

/// Refuses to write a picture of nothing, perhaps over one of something.
void check_not_empty(const RenderResult& result) {
  if (result.most_samples > 0) return;
  fail("{} after {:.1f} s, before any pixel had a sample: nothing is written; {}",
       result.interrupted ? "interrupted" : "the time was up", result.seconds,
       result.interrupted ? "wait longer, or choose a smaller --size"
                          : "give more --time, or choose a smaller --size or a thinner volume");
}

/// Where a camera stands and looks, which may have been framed from another frame's volumes.
std::string position_text(const Camera& camera) {
  const Matrix4d matrix = camera.ndc_from_world().value_or(camera.camera_from_world());
  const double* const values = matrix.getValue();
  return fmt::format("[{:.9g}]", fmt::join(values, values + 16, " "));
}

/// Chooses the number of samples by a pilot, and tells of it.
void settle_samples(const RenderJob& job, RenderSettings& settings, const StopOnInterrupt& stop) {
  if (!job.run.limits_samples) settings.samples = 0;
  ProgressBar bar(
      1, 0,
      job.run.progress == ProgressForm::kBar || job.run.progress == ProgressForm::kAutomatic
          ? ProgressForm::kBar
          : ProgressForm::kNone);
  const NoisePlan plan =
      plan_noise(job.scene, job.color, settings, *job.run.noise, [&](const RenderProgress& p) {
        bar.show(p);
        return !stop.requested();
      });
  bar.finish();
  if (plan.interrupted) fail("interrupted before it was known how many samples --noise takes");
  const uint32_t most = settings.samples;
  settings.samples = plan.samples;
  tell("noise {:.3g} takes {}, by a pilot of {}{}\n", *job.run.noise,
       counted(plan.samples, "sample"), plan.pilot_samples,
       most > 0 && plan.samples == most ? ", the most that --spp allows" : "");
}

/// Chooses the number of samples that the time allows by a pilot, so that what the picture's own
/// samples cost does not; the clock still ends it where the machine has become much slower.
void settle_time(const RenderJob& job, RenderSettings& settings, const StopOnInterrupt& stop) {
  const TimePlan plan = plan_time(job.scene, job.color, settings,
                                  [&](const RenderProgress&) { return !stop.requested(); });
  if (stop.requested()) fail("interrupted before it was known how many samples the time allows");
  if (plan.seconds == 0) return;
  constexpr double kPatience = 1.05;
  settings.time_limit = std::max(kPatience * settings.time_limit - plan.seconds, 1.0);
  if (plan.samples == 0) return;
  settings.samples = plan.samples;
  tell("the time allows {}, by a pilot of {:.1f} s\n", counted(plan.samples, "sample"),
       plan.seconds);
}

}  // namespace

RenderOutcome render_and_write(const RenderJob& job, RenderReport& report,
                               const StopOnInterrupt& stop) {
  RenderSettings& settings = report.settings;
  const Camera& camera = *job.scene.camera;
  const PixelWindow region = pixel_window(settings.crop, camera.width(), camera.height());
  if (job.run.tile) {
    settings.crop = read_option("--tiles", [&] { return tile_of(region, *job.run.tile); });
  }
  const PixelWindow window = pixel_window(settings.crop, camera.width(), camera.height());
  if (job.run.samples) {
    settings.first_sample = job.run.samples->first;
    settings.samples = job.run.samples->count;
  }
  settings.layers = job.film.recorded();
  settings.transparent = job.film.transparent;
  const WavelengthBuckets buckets =
      job.color == ColorMode::kSpectral ? settings.buckets : WavelengthBuckets{};
  check_memory(window, job.film, buckets);
  PictureFilesAside aside(job.outputs, job.stats);
  report.metadata = fixed_metadata(report);
  report.metadata.emplace_back("worldToCamera", camera.camera_from_world());
  if (const std::optional<Matrix4d> ndc = camera.ndc_from_world()) {
    report.metadata.emplace_back("worldToNDC", *ndc);
  }
  FilmHeader header;
  header.region = region;
  header.window = window;
  header.notes = notes_of(report, job.look);
  const std::optional<std::string> before = file_to_resume(job);
  const bool has_film = std::any_of(job.outputs.begin(), job.outputs.end(), is_film_file);
  if (before || !job.checkpoint.empty() || has_film) {
    header.identity = picture_identity(
        job.run, settings, job.color == ColorMode::kSpectral ? "spectral" : "rgb", job.files);
    auto& facts = header.identity.facts;
    facts.emplace_back("the camera's place", position_text(camera));
    facts.insert(facts.end(), job.facts.begin(), job.facts.end());
  }
  const uint32_t had = before ? read_film_header(*before).samples.most : 0;
  if (job.run.noise) settle_samples(job, settings, stop);
  // What is gone on with has samples that no pilot has chosen.
  if (settings.time_limit > 0 && had == 0) settle_time(job, settings, stop);
  header.wanted_samples = settings.samples;
  if (before) settings.before = load_before(*before, header, settings, buckets);
  CheckpointWriter checkpoints(job.checkpoint, header);
  if (!job.checkpoint.empty()) {
    settings.checkpoint_seconds = job.run.every;
    settings.on_checkpoint = [&](const Film& film, const PathCounts& counts, double seconds) {
      checkpoints.write(film, counts, seconds);
    };
  }
  const auto display = show_passes(job.film, job.outputs.front(), settings);
  ProgressBar bar(std::size_t(window.width) * window.height, settings.time_limit, job.run.progress,
                  job.run.noise.value_or(0));
  RenderOutcome outcome{render_scene(job.scene, job.color, settings,
                                     [&](const RenderProgress& progress) {
                                       bar.show(progress);
                                       return !stop.requested();
                                     }),
                        {}};
  bar.finish();
  const RenderResult& result = outcome.result;
  check_not_empty(result);
  report.seconds_render = result.seconds;
  if (!job.checkpoint.empty()) checkpoints.write(result.film, result.counts, result.seconds);
  outcome.written = aside.write({job.look, job.film, display.get(), &header}, result, report);
  const bool are_films = std::all_of(job.outputs.begin(), job.outputs.end(), is_film_file);
  if (!are_films) warn_of_pixels_between(result);
  if (is_partial(result, are_films)) note_partial_result();
  return outcome;
}

bool is_rendered(const std::vector<std::string>& outputs, const std::string& stats) {
  return std::all_of(outputs.begin(), outputs.end(), exists) && (stats.empty() || exists(stats));
}

}  // namespace freepath::program
