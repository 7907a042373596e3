#include "freepath/study/lab_measure.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "freepath/base/error.h"
#include "freepath/transport/auto_tracker.h"
#include "freepath/transport/walker.h"

namespace freepath {
namespace {

/// Paths that are walked and summed together. A constant, since sums depend on it.
constexpr uint64_t kPathsPerChunk = 16'384;
/// Chunks whose sums are held until they are merged in order.
constexpr uint64_t kChunksPerPass = 64;
constexpr double kLeastWeight = 1e-4;

int weight_bin(double weight) {
  const double decades = std::log10(std::abs(weight) / kLeastWeight);
  const double bin = std::floor(decades * kLabWeightsPerDecade + 0.5);
  return static_cast<int>(std::clamp(bin, 0.0, kLabWeightBins - 1.0));
}

/// What is gathered of one channel.
struct Tally {
  LabMoments radiance, escaped;
  std::array<LabMoments, kLabBins> scattered;
  std::array<uint64_t, kLabBins> ended{};
  std::array<uint64_t, kLabWeightBins> weights{};
  uint64_t negative = 0;

  void merge(const Tally& other) {
    radiance.merge(other.radiance);
    escaped.merge(other.escaped);
    negative += other.negative;
    for (int bin = 0; bin < kLabBins; ++bin) {
      scattered[bin].merge(other.scattered[bin]);
      ended[bin] += other.ended[bin];
    }
    for (int bin = 0; bin < kLabWeightBins; ++bin) weights[bin] += other.weights[bin];
  }
};

/// Of all channels that paths carry together.
struct ChannelTallies {
  std::array<Tally, kMaxChannels> channels;
  WalkStatistics statistics;
  double seconds = 0;

  void merge(const ChannelTallies& other) {
    for (int i = 0; i < kMaxChannels; ++i) channels[i].merge(other.channels[i]);
    statistics.merge(other.statistics);
    seconds += other.seconds;
  }
};

/// The memory of a thread.
struct Workspace {
  RayStream rays;
  FlightStream flights;
};

class Measurement {
 public:
  Measurement(const LabSetting& setting, const WalkSettings& walk, const LabGoesOn& goes_on)
      : setting_(setting), walk_(walk), goes_on_(goes_on) {}

  /// @param turn the one channel to carry, or Walker::kAllChannels
  ChannelTallies walk(int turn, uint64_t paths) {
    const Walker walker(*setting_.medium, walk_, turn);
    const uint64_t chunks = (paths + kPathsPerChunk - 1) / kPathsPerChunk;
    ChannelTallies total;
    for (uint64_t begin = 0; begin < chunks; begin += kChunksPerPass) {
      if (goes_on_ && !goes_on_()) fail("interrupted");
      std::vector<ChannelTallies> sums(std::min(kChunksPerPass, chunks - begin));
      tbb::parallel_for(tbb::blocked_range<uint64_t>(0, sums.size(), 1), [&](const auto& range) {
        for (uint64_t i = range.begin(); i < range.end(); ++i) {
          const uint64_t first = (begin + i) * kPathsPerChunk;
          walk_chunk(walker, std::max(turn, 0), first, std::min(kPathsPerChunk, paths - first),
                     sums[i]);
        }
      });
      for (const ChannelTallies& each : sums) total.merge(each);
    }
    return total;
  }

 private:
  void walk_chunk(const Walker& walker, int first_channel, uint64_t first, uint64_t count,
                  ChannelTallies& sums) {
    Workspace& space = workspaces_.local();
    set_lab_rays(first, count, space.rays);
    const auto start = std::chrono::steady_clock::now();
    walker.free_paths(space.rays, space.flights, sums.statistics);
    sums.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    for (int slot = 0; slot < walker.channels(); ++slot) {
      for (std::size_t i = 0; i < count; ++i) {
        add(space.flights, i, slot, first_channel + slot, sums.channels[slot]);
      }
    }
  }

  void add(const FlightStream& flights, std::size_t i, int slot, int channel, Tally& tally) const {
    const double weight = flights.weight[slot][i];
    const double x = flights.t[i];
    const int bin = std::clamp(static_cast<int>(x * kLabBins), 0, kLabBins - 1);
    double seen = flights.emitted[slot][i];
    if (flights.event[i] == Event::kEscape) {
      tally.escaped.add(weight);
      seen += weight * setting_.background;
    } else {
      ++tally.ended[bin];
    }
    if (flights.event[i] == Event::kScatter) {
      tally.scattered[bin].add(weight);
      seen += weight * setting_.scattered(x, channel);
    }
    tally.radiance.add(seen);
    if (flights.event[i] == Event::kAbsorb || weight == 0 || std::isnan(weight)) return;
    ++tally.weights[weight_bin(weight)];
    tally.negative += weight < 0 ? 1 : 0;
  }

  const LabSetting& setting_;
  WalkSettings walk_;
  const LabGoesOn& goes_on_;
  tbb::enumerable_thread_specific<Workspace> workspaces_;
};

LabChannel evaluate(const Tally& tally, const LabCurves& curves, int channel, uint64_t paths) {
  LabChannel result;
  std::vector<double> expected;
  const auto n = static_cast<double>(paths);
  for (int bin = 0; bin < kLabBins; ++bin) {
    const double begin = double{1} * bin / kLabBins;
    const double end = double{1} * (bin + 1) / kLabBins;
    expected.push_back(curves.scattered(begin, end, channel));
    result.exact.push_back(kLabBins * expected.back());
    result.ended.push_back(kLabBins * static_cast<double>(tally.ended[bin]) / n);
    result.scattered.push_back(kLabBins * tally.scattered[bin].mean(paths));
    result.error.push_back(kLabBins * tally.scattered[bin].standard_error(paths));
  }
  for (const uint64_t count : tally.weights) {
    result.weights.push_back(static_cast<double>(count) / n);
  }
  result.negative = static_cast<double>(tally.negative) / n;
  result.transmittance = check_mean(tally.escaped, paths, curves.transmittance(1, channel));
  result.radiance = check_mean(tally.radiance, paths, curves.radiance(channel));
  result.free_path = check_distribution(tally.scattered, expected, paths);
  result.variance = tally.radiance.variance(paths);
  return result;
}

void finish(const WalkStatistics& statistics, double seconds, LabMeasurement& result) {
  const auto paths = static_cast<double>(result.paths);
  result.statistics = statistics;
  result.lookups = static_cast<double>(statistics.lookups) / paths;
  result.null_collisions = static_cast<double>(statistics.null_collisions) / paths;
  result.control_collisions = static_cast<double>(statistics.control_collisions) / paths;
  result.seconds = seconds / paths;
  for (const LabChannel& channel : result.channels) {
    result.variance += channel.variance / static_cast<double>(result.channels.size());
  }
}

/// Why a tracker does not walk through a setting; empty if it does.
std::string refusal_of(const LabSetting& setting, const WalkSettings& walk, int turn) {
  try {
    const Walker walker(*setting.medium, walk, turn);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace

double lab_weight_edge(int bin) {
  return kLeastWeight * std::pow(10.0, (bin - 0.5) / kLabWeightsPerDecade);
}

std::string lab_tracker(const LabSetting& setting, const std::string& tracker) {
  return settle_tracker(tracker, medium_along_ray(setting)).tracker;
}

LabMeasurement measure_tracker(const LabSetting& setting, const LabCurves& curves,
                               const LabWalk& walk, const LabGoesOn& goes_on) {
  LabMeasurement result;
  result.tracker = walk.tracker;
  const std::string chosen = lab_tracker(setting, walk.tracker);
  if (chosen != walk.tracker) result.stands_for = chosen;
  const Method method = parse_method(chosen, tracker_infos());
  for (const MethodInfo& info : tracker_infos()) {
    if (info.name == method.name) result.biased = info.biased;
  }
  WalkSettings settings;
  settings.tracker = chosen;
  settings.interpolation = Interpolation::kNearest;
  settings.absorption = walk.absorption;
  settings.seed = walk.seed;
  result.shared = shares_paths(*setting.medium, settings);
  result.refusal = refusal_of(setting, settings, result.shared ? Walker::kAllChannels : 0);
  if (!result.refusal.empty()) return result;
  result.paths = walk.paths;
  Measurement measurement(setting, settings, goes_on);
  WalkStatistics statistics;
  double seconds = 0;
  const int turns = result.shared ? 1 : setting.channels;
  for (int turn = 0; turn < turns; ++turn) {
    const ChannelTallies sums =
        measurement.walk(result.shared ? Walker::kAllChannels : turn, walk.paths);
    statistics.merge(sums.statistics);
    seconds += sums.seconds;
    const int channels = result.shared ? setting.channels : 1;
    for (int slot = 0; slot < channels; ++slot) {
      result.channels.push_back(evaluate(sums.channels[slot], curves, turn + slot, walk.paths));
    }
  }
  finish(statistics, seconds, result);
  return result;
}

}  // namespace freepath
