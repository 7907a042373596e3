#include "freepath/render/renderer.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>

#include "freepath/base/error.h"

namespace freepath {
namespace {

using Clock = std::chrono::steady_clock;

/// Paths of a job: enough to fill a wavefront many times over, so that its end, where lanes idle,
/// counts little; few enough to share a pass evenly and to stop soon when asked to.
constexpr std::size_t kPathsPerJob = 8192;
constexpr uint32_t kMaxSamplesPerPass = 256;
constexpr double kSecondsPerPass = 2;
constexpr double kSecondsBetweenReports = 0.1;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

PathSetup make_setup(const Medium& medium, const Camera& camera, const Lights& lights,
                     const RenderSettings& settings) {
  PathSetup setup;
  setup.medium = &medium;
  setup.camera = &camera;
  setup.lights = &lights;
  setup.absorption = settings.walk.absorption;
  setup.seed = settings.walk.seed;
  setup.max_scatterings = settings.max_scatterings;
  setup.slots = std::max<std::size_t>(settings.batch, 1);
  if (shares_paths(medium, settings.walk)) {
    setup.walkers.emplace_back(medium, settings.walk);
  } else {
    for (int channel = 0; channel < kChannels; ++channel) {
      setup.walkers.emplace_back(medium, settings.walk, channel);
    }
  }
  return setup;
}

/// Renders pass after pass into a film.
class PassRenderer {
 public:
  PassRenderer(const PathSetup& setup, const RenderSettings& settings,
               const ProgressFunction& progress, Film& film)
      : setup_(setup),
        settings_(settings),
        progress_(progress),
        film_(film),
        more_threads_(tbb::global_control::max_allowed_parallelism,
                      std::max(settings.threads, tbb::info::default_concurrency())),
        arena_(settings.threads > 0 ? settings.threads : tbb::task_arena::automatic),
        wavefronts_([this] { return PathWavefront(setup_); }),
        start_(Clock::now()) {}

  void run() {
    const bool timed = settings_.time_limit > 0;
    const uint32_t wanted = settings_.samples > 0 ? settings_.samples : UINT32_MAX;
    uint32_t samples = 1;
    while (!stop_ && samples_done_ < wanted) {
      samples = std::min(samples, wanted - samples_done_);
      const double before = seconds_since(start_);
      pass(samples);
      const double now = seconds_since(start_);
      if (!stop_) samples_done_ += samples;
      if (timed && now >= settings_.time_limit) break;
      samples = next_pass(samples, (now - before) / samples, timed, now);
      if (samples == 0) break;
    }
    report(true);
  }

  uint32_t samples_done() const { return samples_done_; }
  bool stopped() const { return stop_; }
  double seconds() const { return seconds_since(start_); }
  uint64_t paths() { return sum_of(&PathWavefront::paths); }
  uint64_t overflows() { return sum_of(&PathWavefront::overflows); }
  WalkStatistics statistics() {
    WalkStatistics sum;
    for (const PathWavefront& wavefront : wavefronts_) sum.merge(wavefront.statistics());
    return sum;
  }

 private:
  uint64_t sum_of(uint64_t (PathWavefront::*count)() const) {
    uint64_t sum = 0;
    for (const PathWavefront& wavefront : wavefronts_) sum += (wavefront.*count)();
    return sum;
  }

  uint32_t next_pass(uint32_t samples, double seconds_per_sample, bool timed, double now) const {
    double wanted = kSecondsPerPass / std::max(seconds_per_sample, 1e-9);
    if (timed) wanted = std::min(wanted, (settings_.time_limit - now) / seconds_per_sample);
    if (timed && wanted < 0.5) return 0;
    wanted = std::min(wanted, 4.0 * samples);
    return static_cast<uint32_t>(std::clamp(wanted, 1.0, double(kMaxSamplesPerPass)));
  }

  void pass(uint32_t samples) {
    const std::size_t pixels = static_cast<std::size_t>(film_.width()) * film_.height();
    const std::size_t pixels_per_job = std::max<std::size_t>(kPathsPerJob / samples, 1);
    const std::size_t jobs = (pixels + pixels_per_job - 1) / pixels_per_job;
    arena_.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, jobs, 1),
          [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t job = range.begin(); job < range.end() && !stop_; ++job) {
              const std::size_t first = job * pixels_per_job;
              const std::size_t count = std::min(pixels_per_job, pixels - first);
              wavefronts_.local().trace({first, count, samples_done_, samples}, film_);
              paths_done_ += static_cast<double>(count) * samples / static_cast<double>(pixels);
              report(false);
            }
          },
          tbb::simple_partitioner());
    });
  }

  void report(bool last) {
    if (!progress_) return;
    std::unique_lock lock(report_mutex_, std::defer_lock);
    if (last) {
      lock.lock();
    } else if (!lock.try_lock()) {
      return;  // another thread is at it
    }
    const double now = seconds_since(start_);
    if (!last && now - reported_ < kSecondsBetweenReports) return;
    reported_ = now;
    if (!progress_({paths_done_, double(settings_.samples), now})) stop_ = true;
  }

  const PathSetup& setup_;
  const RenderSettings& settings_;
  const ProgressFunction& progress_;
  Film& film_;
  tbb::global_control more_threads_;  // than the machine has, if that is wanted
  tbb::task_arena arena_;
  tbb::enumerable_thread_specific<PathWavefront> wavefronts_;
  Clock::time_point start_;
  std::atomic<bool> stop_ = false;
  std::atomic<double> paths_done_ = 0;  // samples of each pixel, on average
  std::mutex report_mutex_;
  double reported_ = 0;
  uint32_t samples_done_ = 0;
};

}  // namespace

RenderResult render(const Medium& medium, const Camera& camera, const Lights& lights,
                    const RenderSettings& settings, const ProgressFunction& progress) {
  if (settings.samples == 0 && settings.time_limit <= 0) {
    fail("nothing to render: neither samples nor a time limit is given");
  }
  RenderResult result{Film(camera.width(), camera.height()), {}};
  const PathSetup setup = make_setup(medium, camera, lights, settings);
  PassRenderer passes(setup, settings, progress, result.film);
  passes.run();
  result.samples = passes.samples_done();
  result.interrupted = passes.stopped() && result.samples != settings.samples;
  result.seconds = passes.seconds();
  result.paths = passes.paths();
  result.overflows = passes.overflows();
  result.statistics = passes.statistics();
  const Film::NonFinite non_finite = result.film.non_finite_samples();
  if (non_finite.samples > 0) {
    const auto width = static_cast<std::size_t>(camera.width());
    fail("internal error: {} samples are not finite, the first in pixel ({}, {}); please report it",
         non_finite.samples, non_finite.first_pixel % width, non_finite.first_pixel / width);
  }
  return result;
}

}  // namespace freepath
