#pragma once
/// @file The work of a wavefront of paths, and what came of it.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <shared_mutex>

#include "freepath/sensors/sample_share.h"
#include "freepath/tracking/statistics.h"

namespace freepath {

/// Paths that a wavefront has in flight: what scatterings touch of them and of their rays lies in a
/// core's second cache, and there are enough to fill lanes to the last. Half as many take a
/// twentieth longer, twice as many are no faster.
inline constexpr std::size_t kPathsInFlight = 2048;

/// A rectangle of work: `pixels` pixels of the film from `first_pixel` on (row-major, or in an
/// order of their own), samples [first_sample, first_sample + samples) of each.
struct PathJob {
  std::size_t first_pixel = 0;
  std::size_t pixels = 0;
  uint32_t first_sample = 0;
  uint32_t samples = 0;
  uint32_t rounds = samples;        ///< That these samples are, Film::end_rounds().
  SampleShare share = {};           ///< Of these pixels.
  const uint32_t* order = nullptr;  ///< Of the film's pixels; null: row-major.

  /// The film's pixel that a sample of the job is of.
  /// @param number of the sample, pixel by pixel
  std::size_t pixel_of(std::size_t number) const {
    // Divisions of 32 bits take a third of the time.
    const std::size_t pixel = first_pixel + static_cast<uint32_t>(number) / samples;
    return order == nullptr ? pixel : order[pixel];
  }

  std::size_t sample_count() const { return pixels * samples; }
};

/// Where a wavefront gets its jobs from.
struct PathJobSource {
  /// The next job, none of which has a pixel of another that is under way; nothing if there is
  /// none.
  std::function<std::optional<PathJob>()> next;
  /// Held shared while a job is added to the film and is told of as finished: who holds it alone
  /// sees whole jobs. May be null.
  std::shared_mutex* adding = nullptr;
  /// Told of each that has been added to the film.
  std::function<void(const PathJob&)> finished = [](const PathJob&) {};
  /// Asked before every flight; once it is true the jobs under way are dropped whole: nothing of
  /// them is added to the film.
  std::function<bool()> stop = [] { return false; };
  /// Whether a job may begin before the one before it has ended, so that lanes stay full.
  bool overlaps = true;
};

/// Counts of paths, and of the walks that they took.
struct PathCounts {
  WalkStatistics free_paths;   ///< Statistics of the tracker.
  WalkStatistics shadow_rays;  ///< Statistics of the transmittance estimator.
  uint64_t paths = 0;
  /// Paths whose weight grew beyond the range of float; they count as 0, so a picture with any is
  /// not to be trusted. Only rates that are no bound can do that.
  uint64_t overflows = 0;
  /// Paths that the limit of scatterings ended, and the weight that they still had: the mean of
  /// their channels, in units of kWeightUnit, so that sums don't depend on their order.
  uint64_t cut_paths = 0, cut_weight = 0;
  static constexpr double kWeightUnit = 0x1p-20;

  /// Counts a path that the limit ends.
  void cut(float weight) {
    constexpr double kMost = 1e6;
    ++cut_paths;
    cut_weight += static_cast<uint64_t>(std::clamp(double{weight}, 0.0, kMost) / kWeightUnit);
  }

  /// The weight of the paths that were cut over the number of all: the share of light that is
  /// missing where as much comes from everywhere.
  double cut_share() const {
    return static_cast<double>(cut_weight) * kWeightUnit /
           static_cast<double>(std::max<uint64_t>(paths, 1));
  }
  /// Statistics of all walks.
  WalkStatistics statistics() const {
    WalkStatistics sum = free_paths;
    sum.merge(shadow_rays);
    return sum;
  }

  void merge(const PathCounts& other) {
    free_paths.merge(other.free_paths);
    shadow_rays.merge(other.shadow_rays);
    paths += other.paths;
    overflows += other.overflows;
    cut_paths += other.cut_paths;
    cut_weight += other.cut_weight;
  }
};

}  // namespace freepath
