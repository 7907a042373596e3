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
#include <numeric>
#include <optional>
#include <shared_mutex>
#include <utility>
#include <vector>

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
/// The part of the time that jobs are to take in a first pass that may run out of time, where jobs
/// under way are lost; but not fewer paths, since lanes idle at the end of each job.
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
  /// Called before a pass over rounds [first, first + count) of samples. It gives the fewest
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
        deadline_(settings.whole_passes ? 0 : settings.time_limit),
        next_checkpoint_(settings.checkpoint_seconds) {
    const Film::SampleCounts counts = film.sample_counts();
    samples_done_ = counts.fewest;
    ahead_ = counts.most - counts.fewest;
    set_order();
    double sum = 0;
    for (std::size_t i = 0; ahead_ > 0 && i < film.pixel_count(); ++i) sum += film.rounds(i);
    paths_done_ = ahead_ > 0 ? sum / static_cast<double>(film.pixel_count()) : samples_done_;
  }

  void run() {
    const bool timed = settings_.time_limit > 0;
    const uint32_t wanted = settings_.samples > 0 ? settings_.samples : UINT32_MAX;
    uint32_t samples = 1;
    while (!deadline_.stop_is_wished() && samples_done_ < wanted) {
      // A pass that was broken off before is made whole first.
      samples = ahead_ > 0 ? ahead_ : std::min(samples, wanted - samples_done_);
      const double before = seconds_since(start_);
      deadline_.begin_pass(before, samples_done_ == 0);
      const double share = pass(samples);
      if (over_) break;
      samples_done_ += samples;
      ahead_ = 0;
      paths_done_ = samples_done_;  // which parts of them have come to but for rounding
      if (settings_.on_pass) settings_.on_pass(film_);
      const double now = seconds_since(start_);
      const bool needs_more = settings_.whole_passes && samples_done_ < 2;
      if (timed && now >= settings_.time_limit && !needs_more) break;
      samples = next_pass(samples, (now - before) / (samples * share), timed, now);
      if (needs_more) samples = std::max(samples, 1U);
      if (samples == 0) break;
    }
    report(seconds_since(start_), true);
  }

  bool stop_is_wished() const { return deadline_.stop_is_wished(); }
  double seconds() const { return seconds_since(start_) + seconds_before(); }
  PathCounts counts() {
    PathCounts sum = counts_before();
    for (const PathWavefront& wavefront : wavefronts_) sum.merge(wavefront.counts());
    return sum;
  }

 private:
  /// Time of a clock that began anywhere [s].
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

  double seconds_before() const { return settings_.before ? settings_.before->seconds : 0; }
  PathCounts counts_before() const {
    return settings_.before ? settings_.before->counts : PathCounts{};
  }

  /// Pixels that come one after the other, in the order of the picture or of order_, and their
  /// samples in a pass.
  struct Run {
    std::size_t first = 0, count = 0;
    uint32_t first_sample = 0, samples = 0;
    SampleShare share = {};

    double paths() const { return static_cast<double>(count) * samples; }
  };

  /// Pixels of the same share side by side, where there are several.
  void set_order() {
    if (!film_.has_shares()) return;
    order_.resize(film_.pixel_count());
    std::iota(order_.begin(), order_.end(), 0U);
    const auto step = [&](uint32_t pixel) { return film_.share(pixel).step(); };
    std::stable_sort(order_.begin(), order_.end(),
                     [&](uint32_t a, uint32_t b) { return step(a) < step(b); });
  }

  /// The pixels that a pass is about: all, but for those that have its samples already.
  /// @param pixels their number, with those that have no sample in it
  std::vector<Run> runs_of_pass(uint32_t rounds, std::size_t& pixels) {
    const uint32_t first = settings_.first_sample + samples_done_;
    std::vector<Run> runs;
    for (std::size_t i = 0; i < film_.pixel_count(); ++i) {
      const std::size_t pixel = order_.empty() ? i : order_[i];
      if (film_.rounds(pixel) > samples_done_) continue;
      ++pixels;
      const SampleShare share = film_.share(pixel);
      const uint32_t begin = share.samples(first);
      const uint32_t samples = share.samples(first + rounds) - begin;
      if (samples == 0) {
        film_.end_rounds(pixel, rounds);
        continue;
      }
      if (runs.empty() || runs.back().first + runs.back().count != i ||
          runs.back().share != share) {
        runs.push_back({i, 0, begin, samples, share});
      }
      ++runs.back().count;
    }
    return runs;
  }

  /// Hands out pixels to threads.
  class PixelRefill {
   public:
    explicit PixelRefill(std::vector<Run> runs) : runs_(std::move(runs)) {}

    /// The next pixels, for so many paths or this number of pixels at least; none if there are no
    /// more.
    Run next(std::size_t paths, std::size_t fewest) {
      const std::lock_guard lock(mutex_);
      if (runs_.empty()) return {};
      Run& run = runs_.back();
      Run taken = run;
      taken.count = std::min(std::max<std::size_t>(paths / run.samples, fewest), run.count);
      run.first += taken.count;
      run.count -= taken.count;
      if (run.count == 0) runs_.pop_back();
      return taken;
    }

   private:
    std::mutex mutex_;
    std::vector<Run> runs_;
  };

  /// @return the share of the pixels that it was about
  double pass(uint32_t samples) {
    std::size_t pixels = 0;
    const std::vector<Run> runs = runs_of_pass(samples, pixels);
    const double share = static_cast<double>(pixels) / static_cast<double>(film_.pixel_count());
    double paths = 0;
    for (const Run& run : runs) paths += run.paths();
    if (runs.empty()) return share;
    if (prepare_) fewest_pixels_ = prepare_(settings_.first_sample + samples_done_, samples);
    // However many paths there are, the pass comes to its rounds of those pixels.
    rounds_per_path_ = share * samples / paths;
    PixelRefill refill(runs);
    threads_.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<int>(0, threads_.count(), 1),
          [&](const tbb::blocked_range<int>&) { work(samples, refill); },
          tbb::simple_partitioner());
    });
    return share;
  }

  /// One thread's part of a pass: takes the next pixels until there are none.
  void work(uint32_t samples, PixelRefill& refill) {
    PathWavefront& wavefront = wavefronts_.local();
    const bool hasty = settings_.time_limit > 0 && !settings_.whole_passes && samples_done_ == 0;
    std::size_t paths = hasty ? kFewestPathsPerJob : kPathsPerJob;
    const std::size_t fewest =
        hasty ? std::min(fewest_pixels_, kMostPixelsOfHastyJobs) : fewest_pixels_;
    double began = 0;
    PathJobSource jobs;
    jobs.next = [&]() -> std::optional<PathJob> {
      if (over_) return std::nullopt;
      const Run run = refill.next(paths, fewest);
      if (run.count == 0) return std::nullopt;
      began = time();
      return PathJob{.first_pixel = run.first,
                     .pixels = run.count,
                     .first_sample = run.first_sample,
                     .samples = run.samples,
                     .rounds = samples,
                     .share = run.share,
                     .order = order_.empty() ? nullptr : order_.data()};
    };
    jobs.adding = &adding_;
    PathCounts* published = nullptr;
    {
      const std::shared_lock lock(adding_);
      published = &published_.local();
    }
    jobs.finished = [&](const PathJob& job) {
      *published = wavefront.counts();
      const auto paths_traced = static_cast<double>(job.sample_count());
      paths_done_ += paths_traced * rounds_per_path_;
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
    if (!progress_ && !settings_.on_checkpoint) return;
    std::unique_lock lock(report_mutex_, std::defer_lock);
    if (last) {
      lock.lock();
    } else if (!lock.try_lock() || now < next_report_) {
      return;  // another thread is at it, or has been
    }
    next_report_ = now + kSecondsBetweenReports;
    checkpoint(now);
    if (!progress_) return;
    if (!progress_({paths_done_, double(settings_.samples), now})) deadline_.request_stop(now);
  }

  /// Hands over what there is, if it is time. By one thread at a time.
  void checkpoint(double now) {
    if (!settings_.on_checkpoint || now < next_checkpoint_) return;
    {
      const std::lock_guard alone(adding_);
      PathCounts counts = counts_before();
      for (const PathCounts& of_thread : published_) counts.merge(of_thread);
      settings_.on_checkpoint(film_, counts, now + seconds_before());
    }
    next_checkpoint_ = seconds_since(start_) + settings_.checkpoint_seconds;
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
  /// Samples that all pixels have, and how many more some have: those of a pass that was broken
  /// off.
  uint32_t samples_done_ = 0, ahead_ = 0;
  std::vector<uint32_t> order_;  // of the pixels, by their shares; empty: that of the picture
  double rounds_per_path_ = 0;   // of the pass, over all pixels
  std::shared_mutex adding_;     // held alone to look at the film while threads are at work
  /// What each thread has counted when it added its last job; by whoever holds adding_.
  tbb::enumerable_thread_specific<PathCounts> published_;
  double next_checkpoint_;
};

/// What came of it, all but the film.
inline void finish_result(PassRenderer& passes, const RenderSettings& settings,
                          RenderResult& result) {
  const Film::SampleCounts samples = result.film.sample_counts();
  result.samples = samples.fewest;
  result.most_samples = samples.most;
  result.pixels_without_samples = samples.pixels_without;
  result.pixels_between = samples.pixels_between;
  result.interrupted = passes.stop_is_wished() && result.samples != settings.samples;
  result.seconds = passes.seconds();
  result.counts = passes.counts();
  const Film::NonFinite non_finite = result.film.non_finite_samples();
  if (non_finite.samples > 0) {
    const auto width = static_cast<std::size_t>(result.film.width());
    fail("internal error: {}, the first in pixel ({}, {}); please report it",
         counted(non_finite.samples, "sample is not finite", "samples are not finite"),
         non_finite.first_pixel % width, non_finite.first_pixel / width);
  }
}

}  // namespace freepath
