#include "freepath/paths/slab.h"

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
#include "freepath/base/threads.h"
#include "freepath/paths/slab_paths.h"
#include "freepath/transport/auto_tracker.h"
#include "freepath/transport/weight_growth.h"

namespace freepath {
namespace {

/// Paths that are traced and summed together. A constant, since sums depend on it.
constexpr uint64_t kPathsPerChunk = 16384;
/// Chunks whose sums are held until they are merged in order.
constexpr uint64_t kChunksPerPass = 4096;

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

/// E_2, the share of isotropic light that an absorber of this thickness lets through.
double exponential_integral_2(double x) {
  if (x == 0) return 1;
  return std::isinf(x) ? 0 : std::exp(-x) + x * std::expint(-x);
}

/// Refuses trackers whose weights may have an infinite mean square in these layers. The mean square
/// obeys a transfer equation of its own, whose collisions multiply; it is finite where fewer than
/// one follows each. Of isotropic scattering that share is at most 1 - E_2 of half the thickness,
/// in the middle; Henyey and Greenstein's phase function exceeds the isotropic one by at most
/// (1 + |g|)/(1 - |g|)², of others nothing is taken for known.
/// @throws Error that says what to take instead
void check_growth(std::span<const SlabLayer> layers, const SlabMedium& slab,
                  const WalkSettings& walk) {
  const WeightGrowth growth = weight_growth(channels_of(slab.medium, 0), walk);
  if (growth.bounded()) return;
  double tau = 0;
  double albedo = 0;
  double peak = 0;
  for (const SlabLayer& layer : layers) {
    tau += layer.tau;
    albedo = std::max(albedo, layer.albedo);
    const double g = std::abs(layer.g);
    peak = layer.phase ? std::numeric_limits<double>::infinity()
                       : std::max(peak, (1 + g) / ((1 - g) * (1 - g)));
  }
  // What scatters keeps the albedo in its weight, or survives with that probability.
  const double kept = walk.absorption == Absorption::kWeighted ? albedo * albedo : albedo;
  const double loss = growth.per_mean_free_path / growth.per_flight;
  const double share = std::min(1.0, peak * (1 - exponential_integral_2(0.5 * loss * tau)));
  if (kept == 0 || growth.per_flight * kept * share < 1) return;
  fail("{}; the variance may be infinite in these layers", growth.reason);
}

/// Traces all chunks, and merges their sums in order.
SlabSums trace_chunks(const SlabMedium& slab, const Walker& walker, const SlabSettings& settings,
                      const SlabProgress& progress) {
  Threads threads(settings.threads);
  tbb::enumerable_thread_specific<SlabPaths> paths(
      [&] { return SlabPaths(slab, walker, settings); });
  const uint64_t chunks = (settings.paths - 1) / kPathsPerChunk + 1;
  SlabSums total;
  std::atomic<bool> stop = false;
  std::mutex mutex;
  uint64_t done = 0;
  const auto trace_chunk = [&](uint64_t chunk) {
    const uint64_t first = chunk * kPathsPerChunk;
    const uint64_t count = std::min(kPathsPerChunk, settings.paths - first);
    const SlabSums sums = paths.local().trace(first, count);
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
  SlabMedium slab =
      make_slab_medium(layers, settings.super_voxel, settings.diffuse ? 1 : settings.mu0);
  if (settings.bound_scale != 1) slab.medium = slab.medium.with_scaled_bounds(settings.bound_scale);
  WalkSettings walk = settings.walk;
  walk.interpolation = Interpolation::kNearest;
  std::string reason;
  if (walk.tracker == kAutoTracker) {
    TrackerChoice choice = choose_tracker(slab.medium);
    walk.tracker = std::move(choice.tracker);
    reason = std::move(choice.reason);
  }
  check_growth(layers, slab, walk);
  // Weights that grow would split without end.
  if (!weight_growth(channels_of(slab.medium, 0), walk).bounded()) slab.splits.clear();
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
  const bool scatters = std::any_of(layers.begin(), layers.end(),
                                    [](const SlabLayer& layer) { return layer.albedo > 0; });
  result.reflectance = sums.top.estimate(sums.paths, scatters);
  result.transmittance = sums.bottom.estimate(sums.paths, !slab.half_space);
  result.unscattered = sums.unscattered.estimate(sums.paths, !slab.half_space);
  result.total = sums.total.estimate(sums.paths, scatters || !slab.half_space);
  result.largest_weight = sums.largest_weight;
  result.paths = sums.paths;
  result.tracker_reason = std::move(reason);
  result.tracker = to_string(parse_method(walk.tracker, tracker_infos()), tracker_infos());
  return result;
}

}  // namespace freepath
