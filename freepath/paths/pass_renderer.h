#pragma once
/// @file Rendering in passes over all pixels, on all threads.

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <utility>

#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/base/threads.h"
#include "freepath/paths/deadline.h"
#include "freepath/paths/path_wavefront.h"
#include "freepath/paths/renderer.h"
#include "freepath/sensors/film.h"

namespace freepath {

/// Paths of a job: enough to fill a wavefront many times over, so that its end, where lanes idle,
/// counts little; few enough to share a pass evenly.
inline constexpr std::size_t kPathsPerJob = 8192;
/// In a first pass that may run out of time, where jobs under way are lost, jobs are to take this
/// part of the time; but not fewer paths, since lanes idle at the end of each job.
inline constexpr double kHastyShareOfTime = 0.1;
inline constexpr std::size_t kFewestPathsPerJob = 512;
/// Even where many pixels are best traced together.
inline constexpr std::size_t kMostPixelsOfHastyJobs = 1024;
inline constexpr uint32_t kMaxSamplesPerPass = 256;
inline constexpr double kSecondsPerPass = 2;
inline constexpr double kSecondsBetweenReports = 0.1;

/// Renders pass after pass into a film, by one wavefront for each thread.
class PassRenderer {
 public:
  /// Called before a pass over samples [first, first + count) of every pixel. It gives the fewest
  /// pixels of a job, where many are best traced together.
  using Prepare = std::function<std::size_t(uint32_t first, uint32_t count)>;

  PassRenderer(std::function<PathWavefront()> make_wavefront, const RenderSettings& settings,
               const ProgressFunction& progress, Film& film, Prepare prepare = {})
      : prepare_(std::move(prepare)),
        settings_(settings),
        progress_(progress),
        film_(film),
        threads_(settings.threads),
        wavefronts_(std::move(make_wavefront)),
        start_(time()),
        deadline_(settings.whole_passes ? 0 : settings.time_limit) {}

  void run() {
    const bool timed = settings_.time_limit > 0;
    const uint32_t wanted = settings_.samples > 0 ? settings_.samples : UINT32_MAX;
    uint32_t samples = 1;
    while (!deadline_.stop_is_wished() && samples_done_ < wanted) {
      samples = std::min(samples, wanted - samples_done_);
      const double before = seconds_since(start_);
      deadline_.begin_pass(before, samples_done_ == 0);
      if (prepare_) fewest_pixels_ = prepare_(samples_done_, samples);
      pass(samples);
      if (over_) break;
      samples_done_ += samples;
      if (settings_.on_pass) settings_.on_pass(film_);
      const double now = seconds_since(start_);
      const bool needs_more = settings_.whole_passes && samples_done_ < 2;
      if (timed && now >= settings_.time_limit && !needs_more) break;
      samples = next_pass(samples, (now - before) / samples, timed, now);
      if (needs_more) samples = std::max(samples, 1U);
      if (samples == 0) break;
    }
    report(seconds_since(start_), true);
  }

  bool stop_is_wished() const { return deadline_.stop_is_wished(); }
  double seconds() const { return seconds_since(start_); }
  PathCounts counts() {
    PathCounts sum;
    for (const PathWavefront& wavefront : wavefronts_) sum.merge(wavefront.counts());
    return sum;
  }

 private:
  /// Of a clock that began anywhere [s].
  double time() const {
    if (settings_.clock) return settings_.clock();
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }
  double seconds_since(double start) const { return time() - start; }

  uint32_t next_pass(uint32_t samples, double seconds_per_sample, bool timed, double now) const {
    double wanted = kSecondsPerPass / std::max(seconds_per_sample, 1e-9);
    if (timed) wanted = std::min(wanted, (settings_.time_limit - now) / seconds_per_sample);
    if (timed && wanted < 0.5) return 0;
    wanted = std::min(wanted, 4.0 * samples);
    return static_cast<uint32_t>(std::clamp(wanted, 1.0, double(kMaxSamplesPerPass)));
  }

  void pass(uint32_t samples) {
    std::atomic<std::size_t> next_pixel = 0;
    threads_.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<int>(0, threads_.count(), 1),
          [&](const tbb::blocked_range<int>&) { work(samples, next_pixel); },
          tbb::simple_partitioner());
    });
  }

  /// One thread's part of a pass: takes the next pixels until there are none.
  void work(uint32_t samples, std::atomic<std::size_t>& next_pixel) {
    const std::size_t pixels = static_cast<std::size_t>(film_.width()) * film_.height();
    PathWavefront& wavefront = wavefronts_.local();
    const bool hasty = settings_.time_limit > 0 && !settings_.whole_passes && samples_done_ == 0;
    std::size_t paths = hasty ? kFewestPathsPerJob : kPathsPerJob;
    const std::size_t fewest =
        hasty ? std::min(fewest_pixels_, kMostPixelsOfHastyJobs) : fewest_pixels_;
    double began = 0;
    PathJobSource jobs;
    jobs.next = [&]() -> std::optional<PathJob> {
      const std::size_t wanted = std::max<std::size_t>(paths / samples, fewest);
      const std::size_t first = over_ ? pixels : next_pixel.fetch_add(wanted);
      if (first >= pixels) return std::nullopt;
      began = time();
      return PathJob{first, std::min(wanted, pixels - first), samples_done_, samples};
    };
    jobs.finished = [&](const PathJob& job) {
      const auto paths_traced = static_cast<double>(job.sample_count());
      paths_done_ += paths_traced / static_cast<double>(pixels);
      if (hasty) paths = hasty_job_size(seconds_since(began) / paths_traced);
    };
    jobs.stop = [&] { return is_over(samples); };
    jobs.overlaps = !hasty;
    wavefront.trace(jobs, film_);
  }

  /// Paths of a job so that it takes a small part of the time there is.
  std::size_t hasty_job_size(double seconds_per_path) const {
    const double paths = kHastyShareOfTime * settings_.time_limit / seconds_per_path;
    return static_cast<std::size_t>(
        std::clamp(paths, double(kFewestPathsPerJob), double(kPathsPerJob)));
  }

  /// Whether a pass over so many samples has to end; every thread asks before every flight.
  bool is_over(uint32_t samples) {
    const double now = seconds_since(start_);
    if (now >= next_report_) report(now);
    const double done = (paths_done_ - samples_done_) / samples;
    if (!over_ && deadline_.is_over(now, done)) over_ = true;
    return over_;
  }

  void report(double now, bool last = false) {
    if (!progress_) return;
    std::unique_lock lock(report_mutex_, std::defer_lock);
    if (last) {
      lock.lock();
    } else if (!lock.try_lock() || now < next_report_) {
      return;  // another thread is at it, or has been
    }
    next_report_ = now + kSecondsBetweenReports;
    if (!progress_({paths_done_, double(settings_.samples), now})) deadline_.wish_to_stop(now);
  }

  Prepare prepare_;
  std::size_t fewest_pixels_ = 1;
  const RenderSettings& settings_;
  const ProgressFunction& progress_;
  Film& film_;
  Threads threads_;
  tbb::enumerable_thread_specific<PathWavefront> wavefronts_;
  double start_;
  Deadline deadline_;
  std::atomic<bool> over_ = false;
  std::atomic<double> paths_done_ = 0;  // samples of each pixel, on average
  std::mutex report_mutex_;
  std::atomic<double> next_report_ = kSecondsBetweenReports;
  uint32_t samples_done_ = 0;
};

/// What came of it, all but the film.
inline void finish_result(PassRenderer& passes, const RenderSettings& settings,
                          RenderResult& result) {
  const Film::SampleCounts samples = result.film.sample_counts();
  result.samples = samples.fewest;
  result.most_samples = samples.most;
  result.pixels_without_samples = samples.pixels_without;
  result.interrupted = passes.stop_is_wished() && result.samples != settings.samples;
  result.seconds = passes.seconds();
  const PathCounts counts = passes.counts();
  result.paths = counts.paths;
  result.overflows = counts.overflows;
  result.cut_paths = counts.cut_paths;
  result.cut_share = static_cast<double>(counts.cut_weight) * PathCounts::kWeightUnit /
                     static_cast<double>(std::max<uint64_t>(counts.paths, 1));
  result.free_paths = counts.free_paths;
  result.shadow_rays = counts.shadow_rays;
  const Film::NonFinite non_finite = result.film.non_finite_samples();
  if (non_finite.samples > 0) {
    const auto width = static_cast<std::size_t>(result.film.width());
    fail("internal error: {}, the first in pixel ({}, {}); please report it",
         counted(non_finite.samples, "sample is not finite", "samples are not finite"),
         non_finite.first_pixel % width, non_finite.first_pixel / width);
  }
}

}  // namespace freepath
