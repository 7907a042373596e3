#include "apps/freepath/render_output.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/info.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "apps/freepath/attempts.h"
#include "apps/freepath/console.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/progress_bar.h"
#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/base/version.h"
#include "freepath/io/atomic_file.h"
#include "freepath/io/atomic_image.h"
#include "freepath/tracking/statistics_fields.h"

namespace freepath::program {
namespace {

std::string now_text() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

int64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return int64_t{usage.ru_maxrss} * 1024;
}

int thread_count(const RenderReport& report) {
  return report.threads > 0 ? report.threads : tbb::info::default_concurrency();
}

/// "smoke.vdb, fire.vdb"
std::string volume_names(const RenderReport& report) {
  std::string names;
  for (const VolumeReport& volume : report.volumes) {
    if (!names.empty()) names += ", ";
    names += std::filesystem::path(volume.file).filename().string();
  }
  return names;
}

nlohmann::json volumes_json(const RenderReport& report) {
  nlohmann::json list = nlohmann::json::array();
  for (const VolumeReport& volume : report.volumes) {
    list.push_back({{"file", volume.file}, {"grids", volume.grids}});
  }
  return list;
}

/// Adds the metadata of what was done.
void add_metadata(Image& image, const RenderResult& result) {
  const WalkStatistics counts = result.counts.statistics();
  const auto integer = [](uint64_t value) { return static_cast<int64_t>(value); };
  const std::vector<std::pair<std::string, MetadataValue>> done = {
      {"DateTime", now_text()},
      {"freepath:samples", integer(result.samples)},
      {"freepath:most_samples", integer(result.most_samples)},
      {"freepath:pixels_without_samples", integer(result.pixels_without_samples)},
      {"freepath:seconds", result.seconds},
      {"freepath:paths", integer(result.counts.paths)},
      {"freepath:tentative_collisions", integer(counts.tentative_collisions)},
      {"freepath:null_collisions", integer(counts.null_collisions)},
      {"freepath:real_collisions", integer(counts.real_collisions)},
      {"freepath:lookups", integer(counts.lookups)},
      {"freepath:super_voxel_steps", integer(counts.super_voxel_steps)},
      {"freepath:bound_violations", integer(counts.bound_violations)},
      {"freepath:negative_weights", integer(counts.negative_weights)},
      {"freepath:largest_weight", static_cast<double>(counts.largest_weight)},
  };
  image.metadata.insert(image.metadata.end(), done.begin(), done.end());
}

nlohmann::json counts_json(const WalkStatistics& counts) {
  nlohmann::json json;
  visit_statistics(counts, [&](const char* name, const auto& count) { json[name] = count; });
  return json;
}

nlohmann::json statistics_json(const RenderResult& result, const RenderReport& report) {
  nlohmann::json json = counts_json(result.counts.statistics());
  json.update({{"paths", result.counts.paths},
               {"free_paths", counts_json(result.counts.free_paths)},
               {"shadow_rays", counts_json(result.counts.shadow_rays)},
               {"samples", result.samples},
               {"most_samples", result.most_samples},
               {"pixels_without_samples", result.pixels_without_samples},
               {"overflows", result.counts.overflows},
               {"cut_paths", result.counts.cut_paths},
               {"cut_share", result.counts.cut_share()},
               {"seconds",
                {{"load", report.seconds_load},
                 {"build", report.seconds_build},
                 {"render", report.seconds_render}}},
               {"peak_memory_bytes", peak_memory_bytes()},
               {"volumes", volumes_json(report)},
               {"tracker", report.settings.walk.tracker},
               {"transmittance", report.settings.walk.transmittance},
               {"seed", report.settings.walk.seed},
               {"threads", thread_count(report)},
               {"simd", to_string(report.settings.walk.simd)},
               {"version", version()}});
  if (report.frame) json["frame"] = *report.frame;
  return json;
}

/// One line on what a method did.
void print_counts(const std::string& method, const char* unit, const WalkStatistics& counts) {
  if (counts.rays == 0) return;
  const auto each = [&](uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(counts.rays);
  };
  tell(
      "{}: {}, each {:.2f} lookups, {:.2f} real, {:.2f} null and {:.2f} control "
      "collisions, {:.2f} super-voxel steps; largest weight {:.4g}, {}, {}\n",
      method, counted(counts.rays, unit), each(counts.lookups), each(counts.real_collisions),
      each(counts.null_collisions), each(counts.control_collisions), each(counts.super_voxel_steps),
      counts.largest_weight, counted(counts.negative_weights, "negative weight"),
      counted(counts.bound_violations, "bound violation"));
}

/// What a film's file says.
FilmHeader header_of(FilmHeader header, const RenderResult& result) {
  header.counts = result.counts;
  header.seconds = result.seconds;
  return header;
}

/// Keeps a picture that could not be written where it should be; says where.
[[noreturn]] void keep_elsewhere(const Image& image) {
  const std::string file =
      (std::filesystem::temp_directory_path() / fmt::format("freepath-{}.exr", random_word()))
          .string();
  write_exr(file, image);
  fail("the picture is kept in {}", file);
}

}  // namespace

PictureFilesAside::PictureFilesAside(const std::vector<std::string>& pictures,
                                     const std::string& statistics) {
  for (const std::string& picture : pictures) pictures_.emplace_back(picture);
  if (!statistics.empty()) statistics_.emplace(statistics);
}

std::vector<std::string> PictureFilesAside::write(const OutputPlan& plan,
                                                  const RenderResult& result,
                                                  const RenderReport& report) {
  Attempts attempts;
  Image image = result.film.to_image(plan.film.written());
  if (plan.film.denoiser) {
    attempts.attempt([&] {
      // What is transparent has no background to be kept.
      const LayerSet guides =
          plan.film.transparent ? LayerSet{Layer::kAlbedo, Layer::kNormal} : kDenoiserLayers;
      plan.film.denoiser->denoise(image, result.film.to_image(guides), plan.film.transparent);
    });
  }
  image.metadata = report.metadata;
  add_metadata(image, result);
  bool is_kept = false;
  std::vector<std::string> names;
  for (AtomicFile& file : pictures_) {
    const bool is_film = is_film_file(file.path());
    const bool is_written = attempts.attempt([&] {
      if (is_partial(result, is_film_file(file.path()))) file.retarget(partial_name(file.path()));
      if (is_film) {
        write_film(file, header_of(*plan.header, result), result.film);
      } else {
        write_image(file, image, plan.look, plan.film.exr);
      }
    });
    names.push_back(file.path());
    is_kept |= is_written && (is_film || is_exr(file.path()));
  }
  const bool is_lost = !is_kept && attempts.failed();
  if (statistics_) {
    attempts.attempt([&] {
      if (is_partial(result, true)) statistics_->retarget(partial_name(statistics_->path()));
      statistics_->write(json_text(statistics_json(result, report), 2) + '\n');
      statistics_->replace_target();
    });
  }
  if (is_lost) attempts.attempt([&] { keep_elsewhere(image); });
  if (plan.display != nullptr) plan.display->show_last(image);
  attempts.finish();
  return names;
}

std::string partial_name(const std::string& file) {
  const std::filesystem::path path(file);
  std::filesystem::path name = path.stem();
  name += ".partial";
  name += path.extension();
  return (path.parent_path() / name).string();
}

bool is_partial(const RenderResult& result, bool is_film) {
  return result.interrupted || result.pixels_without_samples > 0 ||
         (!is_film && result.pixels_between > 0);
}

std::vector<std::pair<std::string, MetadataValue>> fixed_metadata(const RenderReport& report) {
  const WalkSettings& walk = report.settings.walk;
  std::vector<std::pair<std::string, MetadataValue>> metadata = {
      {"Software", fmt::format("freepath {}", version())},
      {"freepath:version", std::string(version())},
      {"freepath:volume", volume_names(report)},
      {"freepath:seed", static_cast<int64_t>(walk.seed)},
      {"freepath:tracker", walk.tracker},
      {"freepath:transmittance", walk.transmittance},
  };
  if (report.frame) metadata.emplace_back("freepath:frame", int64_t{*report.frame});
  return metadata;
}

void check_output(const std::string& file) {
  if (is_film_file(file)) {
    check_file_target(file);
  } else {
    check_writable(file);
  }
}

void check_statistics_file(const std::string& file, const std::vector<std::string>& pictures,
                           const std::vector<std::string>& volumes) {
  namespace fs = std::filesystem;
  if (file.empty()) return;
  read_option("--stats", [&] { check_file_target(file); });
  std::vector<std::string> others = pictures;
  others.insert(others.end(), volumes.begin(), volumes.end());
  std::error_code error;
  for (const std::string& other : others) {
    if (fs::weakly_canonical(other, error) == fs::weakly_canonical(file, error)) {
      fail("--stats {}: would overwrite {}; choose another name", file, other);
    }
  }
}

void print_warnings(const RenderResult& result, const RenderReport& report) {
  constexpr double kMeasurable = 0.005;
  if (result.counts.cut_share() >= kMeasurable) {
    const uint64_t limit = report.settings.max_scatterings;
    const uint64_t more = std::max<uint64_t>(100, 10 * limit);
    tell(
        "freepath: note: {1:.2g} % of the paths ended at the limit of {2}, with {3:.2g} % of all "
        "weight: about as much light may be missing. Give a higher limit: --max-scatterings {0}, "
        "or in the scene Integrator \"volpath\" \"integer maxdepth\" {0}\n",
        more,
        100 * static_cast<double>(result.counts.cut_paths) /
            static_cast<double>(std::max<uint64_t>(result.counts.paths, 1)),
        counted(limit, "scattering"), 100 * result.counts.cut_share());
  }
  if (result.pixels_without_samples > 0) {
    warn("{} of {} pixels {} no sample, for want of time: black with alpha 0",
         result.pixels_without_samples,
         static_cast<std::size_t>(result.film.width()) * result.film.height(),
         result.pixels_without_samples == 1 ? "has" : "have");
  }
}

void warn_of_pixels_between(const RenderResult& result) {
  if (result.pixels_between == 0) return;
  warn(
      "{} of {} pixels {} no sample in these rounds: black with alpha 0; write a .film of them and "
      "merge it with the others, or take as many samples of each pixel by --no-adaptive",
      result.pixels_between, result.film.pixel_count(),
      result.pixels_between == 1 ? "has" : "have");
}

void require_no_overflows(const RenderResult& result) {
  if (result.counts.overflows == 0) return;
  fail(
      "the weights of {} of {} paths left the range of float, so that the picture is not known: "
      "the variance of their pixels is infinite; media or surfaces that give back more light than "
      "they get do that, and trackers whose weights grow",
      result.counts.overflows, result.counts.paths);
}

std::string samples_text(const RenderResult& result) {
  if (result.most_samples == result.samples) return counted(result.samples, "sample");
  return fmt::format("{} to {} samples", result.samples, result.most_samples);
}

void print_summary(const std::vector<std::string>& files, const RenderResult& result,
                   const RenderReport& report) {
  const std::string samples = samples_text(result);
  if (result.interrupted) tell("interrupted after {} per pixel\n", samples);
  tell("{} per pixel in {} (load {:.2f} s, build {:.2f} s, render {:.2f} s)\n", samples,
       clock_text(report.seconds_load + report.seconds_build + report.seconds_render),
       report.seconds_load, report.seconds_build, report.seconds_render);
  tell("{}, {:.2f} lookups each\n", counted(result.counts.paths, "path"),
       static_cast<double>(result.counts.statistics().lookups) /
           static_cast<double>(std::max<uint64_t>(result.counts.paths, 1)));
  print_counts(report.settings.walk.tracker, "flight", result.counts.free_paths);
  print_counts(report.settings.walk.transmittance, "shadow ray", result.counts.shadow_rays);
  print_warnings(result, report);
  for (const std::string& file : files) tell("wrote {}\n", file);
  require_no_overflows(result);
}

}  // namespace freepath::program
