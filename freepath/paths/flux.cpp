#include "freepath/paths/flux.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/base/threads.h"
#include "freepath/paths/path_wavefront.h"

namespace freepath {
namespace {

/// Sets what the meter needs to know of a medium.
/// @return how it is to be walked
Absorption settle_absorption(const MediumChannels& channels, const FluxSettings& settings,
                             FluxMeter& meter) {
  bool is_analog = settings.walk.absorption == Absorption::kAnalog;
  meter.absorbed_of_scattered.clear();
  for (const ComponentChannels& component : channels.components) {
    const float scatters = component.sigma_s[0];
    const float absorbs = component.sigma_a[0];
    if (scatters == 0 && absorbs > 0 && settings.tells_absorption) is_analog = true;
    meter.absorbed_of_scattered.push_back(scatters > 0 ? absorbs / scatters : 0);
  }
  if (is_analog || !settings.tells_absorption) meter.absorbed_of_scattered.clear();
  return is_analog ? Absorption::kAnalog : Absorption::kWeighted;
}

/// Hands out chunks of paths to threads, until there are no more or nobody wants them.
class Chunks {
 public:
  Chunks(uint64_t paths, const FluxProgress& progress) : paths_(paths), progress_(progress) {}

  std::optional<PathJob> next() {
    if (stop_) return std::nullopt;
    const uint64_t first = next_.fetch_add(1) * kPathsPerChunk;
    if (first >= paths_) return std::nullopt;
    PathJob job;
    job.first_pixel = first >> 32;
    job.pixels = 1;
    job.first_sample = static_cast<uint32_t>(first);
    job.samples = static_cast<uint32_t>(std::min(kPathsPerChunk, paths_ - first));
    return job;
  }
  void finished(const PathJob& job) {
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    done_ += job.samples;
    if (!progress_(done_, paths_)) stop_ = true;
  }

 private:
  uint64_t paths_;
  const FluxProgress& progress_;
  std::atomic<uint64_t> next_ = 0;
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  uint64_t done_ = 0;
};

/// @return counts of all paths
PathCounts trace_paths(const PathSetup& setup, const FluxSettings& settings,
                       const FluxProgress& progress) {
  Threads threads(settings.threads);
  tbb::enumerable_thread_specific<PathWavefront> wavefronts([&] { return PathWavefront(setup); });
  Chunks chunks(settings.paths, progress);
  PathJobSource jobs;
  jobs.next = [&] { return chunks.next(); };
  jobs.finished = [&](const PathJob& job) { chunks.finished(job); };
  threads.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, threads.count(), 1),
        [&](const tbb::blocked_range<int>&) { wavefronts.local().trace(jobs); },
        tbb::simple_partitioner());
  });
  PathCounts counts;
  for (const PathWavefront& wavefront : wavefronts) counts.merge(wavefront.counts());
  return counts;
}

FluxMap map_of(const FluxTally& tally, const FluxMeter& meter, uint32_t kind, bool possible) {
  FluxMap map{tally.all(kind, possible), {}};
  if (meter.columns() == 1) return map;
  for (uint32_t i = 0; i < meter.columns(); ++i) {
    map.columns.push_back(tally.column(kind * meter.columns() + i, possible));
  }
  return map;
}

}  // namespace

FluxResult trace_flux(const PathScene& scene, FluxMeter meter, const FluxSettings& settings,
                      const FluxProgress& progress) {
  if (settings.paths < 1) fail("paths is 0; at least one path must be traced");
  if (settings.threads < 0) {
    fail("threads is {}; give a number from 1 on, or 0 for all", settings.threads);
  }
  if (uint64_t{meter.counts[0]} * meter.counts[1] > kMostColumns) {
    fail("{} x {} columns are more than {}: give fewer, wider ones", meter.counts[0],
         meter.counts[1], kMostColumns);
  }
  const SceneMedium& medium = scene.media.at(0);
  if (!medium.is_grey(*scene.spectra)) {
    fail("the coefficients differ between R, G and B; fluxes are those of one number each");
  }
  const MediumChannels channels = medium.bind(scene.spectra->in_rgb()).channels;
  if (channels.emits() || channels.has_radiance_fields()) {
    fail("the medium emits light, which is no part of its fluxes; leave its emission out");
  }
  WalkSettings walk = settings.walk;
  walk.absorption = settle_absorption(channels, settings, meter);
  const WavelengthSampler factory(scene, ColorMode::kRgb, 1, walk);
  if (!settings.studies_unbounded_weights) {
    require_bounded_weights(factory.weight_growth(), UINT32_MAX);
    if (!meter.views.empty()) require_bounded_weights(shadow_weight_growth(walk), UINT32_MAX);
  }
  FluxTally tally(meter);
  PathSetup setup;
  setup.scene = &scene;
  setup.factory = &factory;
  setup.seed = walk.seed;
  setup.absorption = walk.absorption;
  setup.roulette_threshold = settings.roulette_threshold;
  setup.slots = std::max<std::size_t>(settings.batch, 1);
  setup.colors = {factory.colors_of_set(0)};
  setup.meter = &meter;
  setup.tally = &tally;
  const PathCounts counts = trace_paths(setup, settings, progress);
  if (counts.overflows > 0) {
    fail(
        "tracker {}: the weights of paths overflow in this medium; choose a rate that bounds the "
        "extinction",
        walk.tracker);
  }
  const bool scatters =
      std::any_of(channels.components.begin(), channels.components.end(),
                  [](const ComponentChannels& component) { return component.sigma_s[0] > 0; });
  const bool absorbs =
      std::any_of(channels.components.begin(), channels.components.end(),
                  [](const ComponentChannels& component) { return component.sigma_a[0] > 0; });
  const bool reflects = scatters || scene.surfaces.has_value();
  const bool passes = !meter.has_no_bottom;
  const auto map = [&](Flux flux, bool possible) {
    return map_of(tally, meter, static_cast<uint32_t>(flux), possible);
  };
  FluxResult result;
  result.paths = tally.paths();
  result.reflectance = map(Flux::kReflected, reflects);
  result.transmittance = map(Flux::kTransmitted, passes);
  result.unscattered = map(Flux::kUnscattered, passes);
  result.absorptance = map(Flux::kAbsorbed, absorbs);
  for (uint32_t i = 0; i < meter.views.size(); ++i) {
    result.radiances.push_back(map_of(tally, meter, kFluxes + i, reflects));
  }
  result.leaving = tally.leaving(reflects || passes);
  result.largest_weight = tally.largest_weight();
  return result;
}

}  // namespace freepath
