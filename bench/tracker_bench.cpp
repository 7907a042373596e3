/// @file Every tracker and estimator of the registry side by side: time of a tentative collision in
/// a large cloud, in lanes and in scalar loops; look-ups, variance and largest weight in a dense
/// haze, where controls decide much; what a spectral path costs against a path for each channel,
/// and multi-volume against delta in volumes that overlap. Exits with 1 if variants of one method
/// differ in what they do. bench/README.md has the figures.

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "bench/cloud.h"
#include "bench/media.h"
#include "bench/tables.h"
#include "bench/timing.h"
#include "freepath/transport/walker.h"

namespace freepath::bench {
namespace {

constexpr int kRepetitions = 9;
constexpr std::size_t kBatches = 16;
constexpr std::size_t kPathBatches = 4;  ///< Of the tables that follow paths over many scatterings.

/// One method on one medium: all channels of a path, or the first alone.
struct Contestant {
  std::string name;
  Walker walker;
  bool free_paths;
  std::vector<double> nanoseconds;
  WalkStatistics statistics;
  double sum = 0;      ///< Of the weights that escape, first channel.
  double squares = 0;  ///< Of the same.

  void walk(const std::vector<RayStream>& batches, FlightStream& flights) {
    WalkStatistics counts;
    const double start = thread_seconds();
    for (const RayStream& rays : batches) {
      if (free_paths) {
        walker.free_paths(rays, flights, counts);
      } else {
        walker.transmittance(rays, flights, counts);
      }
    }
    const double seconds = thread_seconds() - start;
    nanoseconds.push_back(seconds * 1e9 / std::max(1.0, double(counts.tentative_collisions)));
    statistics = counts;
  }

  void estimate(const std::vector<RayStream>& batches, FlightStream& flights) {
    sum = squares = 0;
    for (const RayStream& rays : batches) {
      WalkStatistics counts;
      if (free_paths) {
        walker.free_paths(rays, flights, counts);
      } else {
        walker.transmittance(rays, flights, counts);
      }
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool counts_here = !free_paths || flights.event[i] == Event::kEscape;
        const double weight = counts_here ? flights.weight[0][i] : 0.0;
        sum += weight;
        squares += weight * weight;
      }
    }
  }
};

std::vector<Contestant> enlist(const Medium& medium, const std::vector<std::string>& methods,
                               bool free_paths, bool all_channels) {
  std::vector<Contestant> contestants;
  for (const std::string& method : methods) {
    WalkSettings settings;
    (free_paths ? settings.tracker : settings.transmittance) = method;
    if (!free_paths && all_channels) settings.tracker = "spectral";
    if (all_channels && !shares_paths(medium, settings)) continue;
    contestants.push_back({method,
                           Walker(medium, settings, all_channels ? Walker::kAllChannels : 0),
                           free_paths,
                           {},
                           {},
                           0,
                           0});
  }
  return contestants;
}

/// Times all contestants in turn, over and over, and prints their medians against the first's.
void compare_times(const char* title, std::vector<Contestant> contestants,
                   const std::vector<RayStream>& rays) {
  FlightStream flights;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    for (Contestant& contestant : contestants) contestant.walk(rays, flights);
  }
  fmt::print("\n{}\n{:<52}{:>13}{:>8}{:>15}\n", title, "", "ns/collision", "ratio",
             "lookups/coll.");
  const double first = median(contestants.front().nanoseconds);
  for (const Contestant& contestant : contestants) {
    const double time = median(contestant.nanoseconds);
    const WalkStatistics& counts = contestant.statistics;
    fmt::print("{:<52}{:>13.2f}{:>8.2f}{:>15.3f}\n", contestant.name, time, time / first,
               double(counts.lookups) / double(counts.tentative_collisions));
  }
}

/// Look-ups a ray, the variance of what escapes, and their product against the first's.
void compare_lookups(const char* title, std::vector<Contestant> contestants,
                     const std::vector<RayStream>& rays) {
  FlightStream flights;
  std::size_t count = 0;
  for (const RayStream& batch : rays) count += batch.size();
  fmt::print("\n{}\n{:<52}{:>10}{:>12}{:>12}{:>9}{:>10}\n", title, "", "lookups", "mean",
             "variance", "product", "weight");
  double first = 0;
  for (Contestant& contestant : contestants) {
    contestant.walk(rays, flights);
    contestant.estimate(rays, flights);
    const double mean = contestant.sum / double(count);
    const double variance = contestant.squares / double(count) - mean * mean;
    const double lookups = double(contestant.statistics.lookups) / double(count);
    if (first == 0) first = lookups * variance;
    fmt::print("{:<52}{:>10.3f}{:>12.6f}{:>12.6f}{:>9.3f}{:>10.3g}\n", contestant.name, lookups,
               mean, variance, lookups * variance / first, contestant.statistics.largest_weight);
  }
}

const std::vector<std::string> kTrackers = {"delta",
                                            "weighted-delta",
                                            "multi-volume",
                                            "decomposition",
                                            "weighted-decomposition",
                                            "weighted-decomposition:control=1.3",
                                            "spectral",
                                            "spectral:collision-probability=max",
                                            "spectral-decomposition",
                                            "spectral-decomposition:control=1.3",
                                            "hero-wavelength"};
const std::vector<std::string> kEstimators = {"ratio", "delta", "residual-ratio", "next-flight"};
/// Extinctions of the channels, relative to the first.
const Rgb kChromatic(1.0F, 0.6F, 0.3F);
const Rgb kMildlyChromatic(1.0F, 0.85F, 0.7F);

Medium coloured(const Medium& medium, const Rgb& colour) {
  const Rgb sigma_t = medium.components()[0].sigma_t() * colour;
  return with_spectra(medium, sigma_t * 0.1F, sigma_t * 0.9F);
}

void compare_trackers(const Medium& cloud, const std::vector<RayStream>& rays) {
  compare_times("512^3 cloud, one channel, to the first real collision",
                enlist(cloud, kTrackers, true, false), rays);
  compare_times("512^3 cloud, one channel, transmittance", enlist(cloud, kEstimators, false, false),
                rays);
  const Medium chromatic_cloud = coloured(cloud, kChromatic);
  std::vector<Contestant> all = enlist(cloud, {"delta"}, true, false);
  for (Contestant& contestant : enlist(chromatic_cloud, kTrackers, true, true)) {
    all.push_back(std::move(contestant));
  }
  compare_times("512^3 chromatic cloud, three channels (first: delta, one channel)", std::move(all),
                rays);
}

/// Volumes that overlap: the mirror images of a cloud, in fields of their own.
void compare_volumes() {
  const Medium cloud = make_cloud(256);
  const std::vector<RayStream> rays = make_rays(cloud, kBatches);
  for (const int count : {2, 4, 8}) {
    compare_times(fmt::format("{} overlapping 256^3 clouds, one channel", count).c_str(),
                  enlist(in_mirrors(cloud, count), {"delta", "multi-volume"}, true, false), rays);
  }
}

bool compare_spectral_costs(const std::string& name, const Medium& grey) {
  const Medium medium = coloured(grey, kChromatic);
  const std::vector<RayStream> inside = make_rays(medium, kPathBatches);
  bool same = true;
  for (const int scatterings : {1, 8}) {
    same &= compare_spectral_costs(
        fmt::format("{}, lit by height, from inside, scatterings: {}", name, scatterings), medium,
        inside, Light::kHeight, scatterings);
  }
  const std::vector<RayStream> view = make_view_rays(medium, kPathBatches);
  same &= compare_spectral_costs(name + ", daylight, seen from the side, scatterings: 8", medium,
                                 view, Light::kDaylight, 8);
  same &= compare_spectral_costs("mildly " + name + ", the same", coloured(grey, kMildlyChromatic),
                                 view, Light::kDaylight, 8);
  return same;
}

int run() {
  const Medium cloud = make_cloud(512);
  const std::vector<RayStream> rays = make_rays(cloud, kBatches);
  bool same = compare_with_scalar_loops(cloud, rays);
  compare_trackers(cloud, rays);
  compare_volumes();
  const Medium haze = make_haze(Rgb(0.0F), Rgb(0.05F));
  const std::vector<RayStream> haze_rays = make_rays(haze, kBatches);
  compare_lookups("dense haze, one channel, unscattered light",
                  enlist(haze, kTrackers, true, false), haze_rays);
  compare_lookups("dense haze, one channel, transmittance", enlist(haze, kEstimators, false, false),
                  haze_rays);
  same &= compare_spectral_costs("chromatic 512^3 cloud", cloud);
  same &= compare_spectral_costs("chromatic haze", haze);
  return same ? 0 : 1;
}

}  // namespace
}  // namespace freepath::bench

int main() {
  try {
    return freepath::bench::run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "tracker_bench: {}\n", error.what());
    return 1;
  }
}
