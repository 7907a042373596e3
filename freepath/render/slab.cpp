#include "freepath/render/slab.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "freepath/base/threads.h"
#include "freepath/media/phase/phase_function.h"
#include "freepath/transport/auto_tracker.h"

namespace freepath {
namespace {

/// Paths that are traced and summed together. A constant, since sums depend on it.
constexpr uint64_t kPathsPerChunk = 16384;
/// Chunks whose sums are held until they are merged in order.
constexpr uint64_t kChunksPerPass = 4096;

/// What paths have carried out of the slab.
struct SlabSums {
  /// First and second moments.
  struct Moments {
    double sum = 0;
    double squares = 0;
    void add(double weight) {
      sum += weight;
      squares += weight * weight;
    }
    void merge(const Moments& other) {
      sum += other.sum;
      squares += other.squares;
    }
    SlabEstimate estimate(uint64_t count) const {
      const auto n = static_cast<double>(count);
      const double mean = sum / n;
      const double variance = std::max(0.0, squares - mean * sum) / std::max(1.0, n - 1);
      return {mean, std::sqrt(variance / n)};
    }
  };
  Moments top, bottom, unscattered, total;
  double largest_weight = 0;
  uint64_t paths = 0;

  void merge(const SlabSums& other) {
    top.merge(other.top);
    bottom.merge(other.bottom);
    unscattered.merge(other.unscattered);
    total.merge(other.total);
    largest_weight = std::max(largest_weight, other.largest_weight);
    paths += other.paths;
  }
};

/// Traces chunks of paths, many paths at once. One for each thread; its memory is used again.
class SlabWavefront {
 public:
  SlabWavefront(const SlabMedium& slab, const Walker& walker, const SlabSettings& settings)
      : half_space_(slab.half_space), walker_(walker), settings_(settings) {
    for (const Component& component : slab.medium.components()) {
      phases_.push_back(component.phase);
    }
    paths_in_flight_.resize(std::max<std::size_t>(settings.batch, 1));
  }

  /// Traces the paths [first, first + count); sums them in the order of their numbers.
  SlabSums trace(uint64_t first, uint64_t count) {
    outcomes_.assign(count, Outcome{});
    first_path_ = first;
    uint64_t next = 0;
    std::size_t active = 0;
    while (true) {
      rays_.resize(paths_in_flight_.size());
      while (active < paths_in_flight_.size() && next < count) start_path(next++, active++);
      if (active == 0) break;
      rays_.resize(active);
      walker_.free_paths(rays_, flights_, statistics_);
      // Paths that go on close ranks, in the slots of those that have ended.
      std::size_t kept = 0;
      for (std::size_t slot = 0; slot < active; ++slot) {
        if (advance(slot, kept)) ++kept;
      }
      active = kept;
    }
    return sum();
  }

 private:
  /// A path in flight. Its ray stands in the same slot of rays_.
  struct Path {
    uint64_t number;  ///< Within the chunk.
    float weight;
    uint32_t scatterings;  ///< So far.
  };
  /// How a path ended.
  struct Outcome {
    float weight = 0;  ///< 0 if it was absorbed.
    bool top = false;
    bool unscattered = false;
  };

  RandomStream random(const Path& path, StreamPurpose purpose) const {
    const uint64_t number = first_path_ + path.number;
    return {settings_.walk.seed, static_cast<uint32_t>(number >> 32), static_cast<uint32_t>(number),
            stream_number(purpose, path.scatterings)};
  }

  /// Puts a path and its ray into a slot.
  void set_path(std::size_t slot, const Path& path, float z, const Vec3f& direction) {
    paths_in_flight_[slot] = path;
    const uint64_t number = first_path_ + path.number;
    rays_.pixel[slot] = static_cast<uint32_t>(number >> 32);
    rays_.sample[slot] = static_cast<uint32_t>(number);
    rays_.stream[slot] = stream_number(StreamPurpose::kWalk, path.scatterings);
    rays_.t_max[slot] = std::numeric_limits<float>::infinity();
    rays_.origin[0][slot] = rays_.origin[1][slot] = 0;  // all places of one depth are the same
    rays_.origin[2][slot] = z;
    for (int axis = 0; axis < 3; ++axis) rays_.direction[axis][slot] = direction[axis];
  }

  void start_path(uint64_t number, std::size_t slot) {
    const Path path{number, 1.0F, 0};
    auto mu = static_cast<float>(settings_.mu0);
    if (settings_.diffuse) {
      // Equal radiance brings a flux in proportion to mu: density 2 mu. Never 0.
      mu = std::sqrt(1.0F - random(path, StreamPurpose::kCamera).uniform());
    }
    set_path(slot, path, 0, {std::sqrt((1.0F - mu) * (1.0F + mu)), 0, mu});
  }

  /// Takes in what became of the flight in `slot`. True if the path goes on, in slot `kept`.
  bool advance(std::size_t slot, std::size_t kept) {
    Path path = paths_in_flight_[slot];
    path.weight *= flights_.weight[0][slot];
    const Vec3f direction(rays_.direction[0][slot], rays_.direction[1][slot],
                          rays_.direction[2][slot]);
    if (flights_.event[slot] == Event::kEscape) {
      const bool top = direction.z < 0;
      if (top || !half_space_) {
        outcomes_[path.number] = {path.weight, top, !top && path.scatterings == 0};
      }
      return false;
    }
    if (flights_.event[slot] == Event::kAbsorb) return false;

    RandomStream random = this->random(path, StreamPurpose::kScatter);
    const float magnitude = std::abs(path.weight);
    if (magnitude < settings_.roulette_threshold) {
      const float survival = magnitude / settings_.roulette_threshold;
      if (random.uniform() >= survival) return false;
      path.weight *= 1.0F / survival;
    }
    const float u1 = random.uniform();
    const float u2 = random.uniform();
    const PhaseSample next = phases_[flights_.component[slot]].sample(direction, u1, u2);
    ++path.scatterings;
    // A rounding of z that just leaves the slab does no harm: upwards the next flight escapes, as
    // it would have but for a distance of 1e-6; downwards it begins at the surface.
    set_path(kept, path, rays_.origin[2][slot] + direction.z * flights_.t[slot], next.direction);
    return true;
  }

  SlabSums sum() const {
    SlabSums sums;
    sums.paths = outcomes_.size();
    for (const Outcome& outcome : outcomes_) {
      (outcome.top ? sums.top : sums.bottom).add(outcome.weight);
      if (outcome.unscattered) sums.unscattered.add(outcome.weight);
      sums.total.add(outcome.weight);
      sums.largest_weight = std::max(sums.largest_weight, std::abs(double{outcome.weight}));
    }
    return sums;
  }

  bool half_space_;
  const Walker& walker_;
  const SlabSettings& settings_;
  std::vector<PhaseFunction> phases_;  // of the components
  uint64_t first_path_ = 0;
  std::vector<Path> paths_in_flight_;
  std::vector<Outcome> outcomes_;
  RayStream rays_;
  FlightStream flights_;
  WalkStatistics statistics_;
};

constexpr float kLargestBoundScale = 1000;

void check_settings(const SlabSettings& settings) {
  if (!settings.diffuse && !(settings.mu0 > 0 && settings.mu0 <= 1)) {
    fail("mu0 is {}; the cosine of incidence lies in (0, 1], 1 being along the normal",
         settings.mu0);
  }
  if (settings.paths < 1) fail("paths is 0; at least one path must be traced");
  if (settings.threads < 0) {
    fail("threads is {}; give a number from 1 on, or 0 for all", settings.threads);
  }
  if (!(settings.bound_scale >= 1 && settings.bound_scale <= kLargestBoundScale)) {
    fail("the bounds can't be scaled by {}: from 1, tight, to {} is possible", settings.bound_scale,
         kLargestBoundScale);
  }
}

/// Traces all chunks, and merges their sums in order.
SlabSums trace_chunks(const SlabMedium& slab, const Walker& walker, const SlabSettings& settings,
                      const SlabProgress& progress) {
  Threads threads(settings.threads);
  tbb::enumerable_thread_specific<SlabWavefront> wavefronts(
      [&] { return SlabWavefront(slab, walker, settings); });
  const uint64_t chunks = (settings.paths - 1) / kPathsPerChunk + 1;
  SlabSums total;
  std::atomic<bool> stop = false;
  std::mutex mutex;
  uint64_t done = 0;
  const auto trace_chunk = [&](uint64_t chunk) {
    const uint64_t first = chunk * kPathsPerChunk;
    const uint64_t count = std::min(kPathsPerChunk, settings.paths - first);
    const SlabSums sums = wavefronts.local().trace(first, count);
    if (progress) {
      const std::lock_guard lock(mutex);
      done += count;
      if (!progress(done, settings.paths)) stop = true;
    }
    return sums;
  };
  std::vector<SlabSums> sums;
  for (uint64_t begin = 0; begin < chunks && !stop; begin += kChunksPerPass) {
    const uint64_t end = std::min(chunks, begin + kChunksPerPass);
    sums.assign(end - begin, SlabSums{});
    threads.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<uint64_t>(begin, end, 1),
          [&](const tbb::blocked_range<uint64_t>& range) {
            for (uint64_t chunk = range.begin(); chunk < range.end() && !stop; ++chunk) {
              sums[chunk - begin] = trace_chunk(chunk);
            }
          },
          tbb::simple_partitioner());
    });
    for (const SlabSums& chunk : sums) total.merge(chunk);
  }
  return total;
}

}  // namespace

SlabResult trace_slab(std::span<const SlabLayer> layers, const SlabSettings& settings,
                      const SlabProgress& progress) {
  check_settings(settings);
  SlabMedium slab = make_slab_medium(layers, settings.super_voxel);
  if (settings.bound_scale != 1) slab.medium = slab.medium.with_scaled_bounds(settings.bound_scale);
  WalkSettings walk = settings.walk;
  walk.interpolation = Interpolation::kNearest;
  std::string reason;
  if (walk.tracker == kAutoTracker) {
    TrackerChoice choice = choose_tracker(slab.medium);
    walk.tracker = std::move(choice.tracker);
    reason = std::move(choice.reason);
  }
  // Layers are grey: a tracker that would give each channel its own path needs one.
  const Walker walker(slab.medium, walk,
                      shares_paths(slab.medium, walk) ? Walker::kAllChannels : 0);
  const SlabSums sums = trace_chunks(slab, walker, settings, progress);
  if (!std::isfinite(sums.total.squares)) {
    fail(
        "tracker {}: the weights of paths overflow in these layers; choose a rate that bounds the "
        "extinction",
        walk.tracker);
  }
  SlabResult result;
  result.reflectance = sums.top.estimate(sums.paths);
  result.transmittance = sums.bottom.estimate(sums.paths);
  result.unscattered = sums.unscattered.estimate(sums.paths);
  result.total = sums.total.estimate(sums.paths);
  result.largest_weight = sums.largest_weight;
  result.paths = sums.paths;
  result.tracker_reason = std::move(reason);
  result.tracker = to_string(parse_method(walk.tracker, tracker_infos()), tracker_infos());
  return result;
}

}  // namespace freepath
