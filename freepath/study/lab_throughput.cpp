#include "freepath/study/lab_throughput.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>

#include "freepath/base/error.h"
#include "freepath/transport/walker.h"

namespace freepath {
namespace {

constexpr std::size_t kPathsTimedTogether = 8192;
/// Rays that a path may take to its last scattering: rates so low that it takes more are refused.
constexpr int kMostRays = 20'000;
/// That a weight in a table has ended.
constexpr float kEnded = std::numeric_limits<float>::quiet_NaN();

/// Weights of all paths at all stages.
class WeightTable {
 public:
  WeightTable(int stages, int channels, std::size_t paths)
      : channels_(channels), paths_(paths), weights_(paths * stages * channels, kEnded) {}

  float& at(int stage, int channel, std::size_t path) {
    return weights_[(std::size_t(stage) * channels_ + channel) * paths_ + path];
  }
  std::span<const float> of(int stage, int channel) const {
    return std::span(weights_).subspan((std::size_t(stage) * channels_ + channel) * paths_, paths_);
  }
  int channels() const { return channels_; }
  std::size_t paths() const { return paths_; }

 private:
  int channels_;
  std::size_t paths_;
  std::vector<float> weights_;
};

LabWeights summarize_weights(std::span<const float> weights, double exact) {
  LabWeights result;
  LabMoments moments;
  std::vector<float> sizes;
  for (const float weight : weights) {
    if (std::isnan(weight)) continue;
    moments.add(weight);
    sizes.push_back(std::abs(weight));
  }
  std::sort(sizes.begin(), sizes.end());
  const auto percentile = [&](double share) -> double {
    if (sizes.empty()) return 0;
    return sizes[static_cast<std::size_t>(share * static_cast<double>(sizes.size() - 1))];
  };
  const LabCheck check = check_mean(moments, weights.size(), std::isnan(exact) ? 0 : exact);
  result.mean = check.estimate;
  result.standard_error = check.standard_error;
  result.exact = exact;
  result.standing = check.standing;
  result.low = percentile(0.05);
  result.median = percentile(0.5);
  result.high = percentile(0.95);
  result.largest = percentile(1);
  return result;
}

/// @param at of a stage; exact its mean in a channel
LabThroughput summarize_table(const WeightTable& table, int stages, const LabWalk& walk,
                              const std::function<double(int)>& at,
                              const std::function<double(int, int)>& exact) {
  LabThroughput result;
  result.tracker = walk.tracker;
  result.paths = table.paths();
  result.stages.resize(stages);
  tbb::parallel_for(tbb::blocked_range<int>(0, stages, 1), [&](const auto& range) {
    for (int i = range.begin(); i < range.end(); ++i) {
      LabStage& stage = result.stages[i];
      stage.at = at(i);
      const std::span<const float> first = table.of(i, 0);
      const auto living = std::count_if(first.begin(), first.end(),
                                        [](float weight) { return !std::isnan(weight); });
      stage.alive = static_cast<double>(living) / static_cast<double>(table.paths());
      for (int channel = 0; channel < table.channels(); ++channel) {
        stage.channels.push_back(summarize_weights(table.of(i, channel), exact(i, channel)));
      }
    }
  });
  return result;
}

/// Paths that fly ray after ray; where each ray begins and what its end means is for others to say.
class Flyer {
 public:
  Flyer(const Walker& walker, std::size_t first, std::size_t count) : walker_(walker) {
    set_lab_rays(first, count, rays_);
    rays_.set_weighted(true);
    for (std::size_t i = 0; i < count; ++i) paths_.push_back(first + i);
  }

  /// Flies all rays on; `arrive` is called with a slot and says whether its path goes on, having
  /// placed the ray. Paths that go on close ranks.
  template <class Arrive>
  void fly(Arrive arrive) {
    walker_.free_paths(rays_, flights_, statistics_);
    std::size_t kept = 0;
    for (std::size_t slot = 0; slot < paths_.size(); ++slot) {
      if (!arrive(slot)) continue;
      paths_[kept] = paths_[slot];
      set_lab_ray(kept, rays_.origin[0][slot], rays_.t_max[slot], rays_);
      rays_.pixel[kept] = rays_.pixel[slot];
      rays_.sample[kept] = rays_.sample[slot];
      rays_.stream[kept] = rays_.stream[slot] + 1;
      for (int channel = 0; channel < kMaxChannels; ++channel) {
        rays_.weight[channel][kept] = flights_.weight[channel][slot];
        rays_.density[channel][kept] = flights_.density[channel][slot];
      }
      ++kept;
    }
    paths_.resize(kept);
    rays_.resize(kept);
  }

  bool empty() const { return paths_.empty(); }
  std::size_t size() const { return paths_.size(); }
  std::size_t path(std::size_t slot) const { return paths_[slot]; }
  RayStream& rays() { return rays_; }
  const FlightStream& flights() const { return flights_; }

  /// Writes the weights of a flight into the table.
  void record(std::size_t slot, int stage, WeightTable& table) const {
    for (int channel = 0; channel < table.channels(); ++channel) {
      table.at(stage, channel, paths_[slot]) = flights_.weight[channel][slot];
    }
  }

 private:
  const Walker& walker_;
  RayStream rays_;
  FlightStream flights_;
  WalkStatistics statistics_;
  std::vector<std::size_t> paths_;  ///< Numbers of the paths in the slots.
};

/// Calls walk_chunk(walker, first, count) for all paths, on all threads.
template <class WalkChunk>
void walk_all(const LabSetting& setting, const LabWalk& walk, Absorption absorption,
              const LabGoesOn& goes_on, WalkChunk walk_chunk) {
  WalkSettings settings;
  settings.tracker = lab_tracker(setting, walk.tracker);
  settings.interpolation = Interpolation::kNearest;
  settings.absorption = absorption;
  settings.seed = walk.seed;
  const Walker walker(*setting.medium, settings);
  if (walker.channels() != setting.channels) {
    fail("'{}' carries one channel a path", walk.tracker);
  }
  if (goes_on && !goes_on()) fail("interrupted");
  const uint64_t chunks = (walk.paths + kPathsTimedTogether - 1) / kPathsTimedTogether;
  tbb::parallel_for(tbb::blocked_range<uint64_t>(0, chunks, 1), [&](const auto& range) {
    for (uint64_t i = range.begin(); i < range.end(); ++i) {
      const uint64_t first = i * kPathsTimedTogether;
      walk_chunk(walker, first, std::min<uint64_t>(kPathsTimedTogether, walk.paths - first));
    }
  });
}

}  // namespace

LabThroughput throughput_along_ray(const LabSetting& setting, const LabCurves& curves,
                                   const LabWalk& walk, const LabGoesOn& goes_on) {
  constexpr float kStretch = 1.0F / kLabCuts;  // a power of two: no rounding
  WeightTable table(kLabCuts + 1, setting.channels, walk.paths);
  for (int channel = 0; channel < setting.channels; ++channel) {
    for (std::size_t path = 0; path < walk.paths; ++path) table.at(0, channel, path) = 1;
  }
  walk_all(setting, walk, walk.absorption, goes_on,
           [&](const Walker& walker, uint64_t first, uint64_t count) {
             Flyer flyer(walker, first, count);
             for (std::size_t i = 0; i < count; ++i) flyer.rays().t_max[i] = kStretch;
             for (int cut = 1; cut <= kLabCuts && !flyer.empty(); ++cut) {
               flyer.fly([&](std::size_t slot) {
                 if (flyer.flights().event[slot] != Event::kEscape) return false;
                 flyer.record(slot, cut, table);
                 flyer.rays().origin[0][slot] = cut * kStretch;
                 return true;
               });
             }
           });
  return summarize_table(
      table, kLabCuts + 1, walk, [](int cut) { return double{1} * cut / kLabCuts; },
      [&](int cut, int channel) {
        return curves.transmittance(double{1} * cut / kLabCuts, channel);
      });
}

LabThroughput throughput_of_scatterings(const LabSetting& setting, const LabCurves& curves,
                                        const LabWalk& walk, const LabGoesOn& goes_on) {
  WeightTable table(kLabScatterings + 1, setting.channels, walk.paths);
  for (int channel = 0; channel < setting.channels; ++channel) {
    for (std::size_t path = 0; path < walk.paths; ++path) table.at(0, channel, path) = 1;
  }
  walk_all(setting, walk, Absorption::kWeighted, goes_on,
           [&](const Walker& walker, uint64_t first, uint64_t count) {
             Flyer flyer(walker, first, count);
             std::vector<int> scatterings(count, 0);
             for (int ray = 0; !flyer.empty(); ++ray) {
               if (ray == kMostRays) {
                 fail("'{}' takes more than {} rays to {} scatterings", walk.tracker, kMostRays,
                      kLabScatterings);
               }
               flyer.fly([&](std::size_t slot) {
                 const FlightStream& flights = flyer.flights();
                 RayStream& rays = flyer.rays();
                 float x = 0;  // where the next copy of the setting begins
                 int& done = scatterings[flyer.path(slot) - first];
                 if (flights.event[slot] == Event::kAbsorb) return false;
                 if (flights.event[slot] == Event::kScatter) {
                   flyer.record(slot, ++done, table);
                   x = std::min(rays.origin[0][slot] + flights.t[slot], 1.0F);
                 }
                 rays.origin[0][slot] = x;
                 rays.t_max[slot] = 1 - x;
                 return done < kLabScatterings;
               });
             }
           });
  // Where a channel's albedo is one number.
  std::vector<double> albedo;
  for (int channel = 0; channel < setting.channels; ++channel) {
    const double first = curves.sigma_s(0, channel) / curves.sigma_t(0, channel);
    bool same = true;
    for (int voxel = 0; voxel < kLabVoxels; ++voxel) {
      const double x = (voxel + 0.5) / kLabVoxels;
      same = same &&
             std::abs(curves.sigma_s(x, channel) / curves.sigma_t(x, channel) / first - 1) < 1e-6;
    }
    albedo.push_back(same ? first : std::numeric_limits<double>::quiet_NaN());
  }
  return summarize_table(
      table, kLabScatterings + 1, walk, [](int scattering) { return double(scattering); },
      [&](int scattering, int channel) {
        const double power = std::pow(albedo[channel], scattering);
        return std::isnan(albedo[channel]) ? albedo[channel] : power;  // the power of 0 is 1
      });
}

}  // namespace freepath
