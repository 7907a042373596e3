/// @file Every tracker and estimator of the registry side by side: time of a tentative collision in
/// a large cloud, and look-ups, variance and largest weight in a dense haze, where controls decide
/// much. bench/README.md has the figures.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/cloud.h"
#include "freepath/transport/walker.h"

namespace freepath::bench {
namespace {

constexpr int kRepetitions = 9;
constexpr std::size_t kBatches = 16;

/// Time that this thread has run: what else the machine does counts as little as can be.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// A cube whose density varies smoothly between 0.55 and 1: minima of super-voxels are most of the
/// maxima.
Medium make_haze(const Spectrum& sigma_a, const Spectrum& sigma_s) {
  constexpr int kSize = 128;
  BrickMapBuilder builder(Vec3i(0), Vec3i(kSize - 1), 0);
  for (int x = 0; x < kSize; ++x) {
    for (int y = 0; y < kSize; ++y) {
      for (int z = 0; z < kSize; ++z) {
        const double wave = std::sin(0.09 * x) * std::cos(0.07 * y + 0.05 * z);
        builder.set_voxel(Vec3i(x, y, z), static_cast<float>(0.775 + 0.225 * wave));
      }
    }
  }
  auto field = std::make_shared<Field>();
  field->name = "haze";
  field->voxels = std::move(builder).finish();
  return Medium({Component{.density = field, .sigma_a = sigma_a, .sigma_s = sigma_s}}, 8);
}

Medium with_spectra(const Medium& medium, const Spectrum& sigma_a, const Spectrum& sigma_s) {
  Component component = medium.components()[0];
  component.sigma_a = sigma_a;
  component.sigma_s = sigma_s;
  return Medium({component}, medium.super_voxels().cell_size);
}

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

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

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

int run() {
  const std::vector<std::string> trackers = {"delta",
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
  const std::vector<std::string> estimators = {"ratio", "delta", "residual-ratio", "next-flight"};
  const Medium cloud = make_cloud(512);
  const std::vector<RayStream> rays = make_rays(cloud, kBatches);
  compare_times("512^3 cloud, one channel, to the first real collision",
                enlist(cloud, trackers, true, false), rays);
  compare_times("512^3 cloud, one channel, transmittance", enlist(cloud, estimators, false, false),
                rays);
  const Spectrum sigma_t = cloud.components()[0].sigma_t();
  const Spectrum chromatic = sigma_t * Spectrum(1.0F, 0.6F, 0.3F);
  const Medium coloured = with_spectra(cloud, chromatic * 0.1F, chromatic * 0.9F);
  std::vector<Contestant> all = enlist(cloud, {"delta"}, true, false);
  for (Contestant& contestant : enlist(coloured, trackers, true, true)) {
    all.push_back(std::move(contestant));
  }
  compare_times("512^3 chromatic cloud, three channels (first: delta, one channel)", std::move(all),
                rays);
  const Medium haze = make_haze(Spectrum(0.0F), Spectrum(0.05F));
  const std::vector<RayStream> haze_rays = make_rays(haze, kBatches);
  compare_lookups("dense haze, one channel, unscattered light", enlist(haze, trackers, true, false),
                  haze_rays);
  compare_lookups("dense haze, one channel, transmittance", enlist(haze, estimators, false, false),
                  haze_rays);
  return 0;
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
