#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bench/agreement.h"
#include "bench/tables.h"
#include "bench/timing.h"
#include "freepath/base/random.h"
#include "freepath/transport/walker.h"

namespace freepath::bench {
namespace {

/// Paths from each ray: their scatter about the ray's own mean is the variance that counts, as it
/// is in a pixel.
constexpr int kSpectralRepetitions = 16;

using Radiances = std::array<std::vector<double>, kChannels>;  ///< Of each ray.

Vec3f uniform_direction(uint32_t pixel, uint32_t sample, int bounce) {
  RandomStream random(0, pixel, sample,
                      stream_number(StreamPurpose::kScatter, static_cast<uint32_t>(bounce)));
  const float height = 2 * random.uniform() - 1;
  const float angle = 2 * std::numbers::pi_v<float> * random.uniform();
  const float radius = std::sqrt(1 - height * height);
  return {radius * std::cos(angle), radius * std::sin(angle), height};
}

/// Of the sky above, and of the ground below.
double background(const Vec3f& direction) { return direction.z >= 0 ? 0.8 : 0.2; }

/// Follows the paths of a stream of rays, in one channel or in all.
class Paths {
 public:
  /// @param channel the one that the walker carries, or Walker::kAllChannels
  Paths(const Medium& medium, const WalkSettings& settings, int channel, Light light)
      : walker_(medium, settings, channel),
        light_(light),
        first_channel_(std::max(channel, 0)),
        bottom_(medium.world_bounds().min.z),
        height_(medium.world_bounds().max.z - bottom_) {}

  /// Adds the radiance of each ray's path. @return seconds that the walks took
  double follow(const RayStream& rays, int repetition, int scatterings, std::size_t first_ray,
                Radiances& radiances) {
    RayStream current = rays;
    current.set_weighted(true);
    std::vector<std::size_t> paths(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      paths[i] = first_ray + i;
      current.sample[i] += static_cast<uint32_t>(repetition * rays.size());
    }
    double seconds = 0;
    for (int bounce = 0; bounce < scatterings && current.size() > 0; ++bounce) {
      const double start = thread_seconds();
      walker_.free_paths(current, flights_, statistics_);
      seconds += thread_seconds() - start;
      gather(current, paths, radiances);
      if (light_ == Light::kDaylight) seconds += gather_sun(bounce, current, paths, radiances);
      scatter(bounce, current, paths);
    }
    return seconds;
  }

 private:
  double position(const RayStream& rays, std::size_t i, int axis) const {
    return rays.origin[axis][i] + double(flights_.t[i]) * rays.direction[axis][i];
  }

  /// What escapes, and where the light has no direction what scatters; lists the scatterings.
  void gather(const RayStream& rays, const std::vector<std::size_t>& paths, Radiances& radiances) {
    scattered_.clear();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      double light = 0;
      if (flights_.event[i] == Event::kScatter) {
        scattered_.push_back(i);
        if (light_ == Light::kHeight) light = (position(rays, i, 2) - bottom_) / height_;
      } else if (flights_.event[i] == Event::kEscape) {
        const Vec3f direction(rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]);
        light = light_ == Light::kHeight ? 1.0 : background(direction);
      }
      add(light, flights_, i, paths[i], radiances);
    }
  }

  /// The sun at each scattering, by a shadow ray. @return seconds that their walk took
  double gather_sun(int bounce, const RayStream& rays, const std::vector<std::size_t>& paths,
                    Radiances& radiances) {
    leave_scatterings(
        rays, stream_number(StreamPurpose::kShadowWalk, static_cast<uint32_t>(bounce)),
        [](std::size_t) { return Vec3f(0.6F, 0, 0.8F); }, next_);
    const double start = thread_seconds();
    walker_.transmittance(next_, shadow_flights_, statistics_);
    const double seconds = thread_seconds() - start;
    for (std::size_t k = 0; k < scattered_.size(); ++k) {
      add(1.0, shadow_flights_, k, paths[scattered_[k]], radiances);
    }
    return seconds;
  }

  void add(double light, const FlightStream& flights, std::size_t i, std::size_t path,
           Radiances& radiances) const {
    for (int slot = 0; slot < walker_.channels(); ++slot) {
      radiances[first_channel_ + slot][path] += light * flights.weight[slot][i];
    }
  }

  /// Turns the rays that have scattered, and leaves out the others.
  void scatter(int bounce, RayStream& rays, std::vector<std::size_t>& paths) {
    leave_scatterings(
        rays, stream_number(StreamPurpose::kWalk, static_cast<uint32_t>(bounce) + 1),
        [&](std::size_t i) { return uniform_direction(rays.pixel[i], rays.sample[i], bounce); },
        next_);
    for (std::size_t k = 0; k < scattered_.size(); ++k) paths[k] = paths[scattered_[k]];
    paths.resize(scattered_.size());
    std::swap(rays, next_);
  }

  /// Rays that go on from where others have scattered, with their weights.
  template <class Direction>
  void leave_scatterings(const RayStream& rays, uint32_t stream, Direction direction_of,
                         RayStream& leaving) const {
    leaving.resize(scattered_.size());
    leaving.set_weighted(true);
    for (std::size_t k = 0; k < scattered_.size(); ++k) {
      const std::size_t i = scattered_[k];
      const Vec3f direction = direction_of(i);
      for (int axis = 0; axis < 3; ++axis) {
        leaving.origin[axis][k] = static_cast<float>(position(rays, i, axis));
        leaving.direction[axis][k] = direction[axis];
      }
      for (int channel = 0; channel < walker_.channels(); ++channel) {
        leaving.weight[channel][k] = flights_.weight[channel][i];
        leaving.density[channel][k] = flights_.density[channel][i];
      }
      leaving.t_max[k] = rays.t_max[i];
      leaving.pixel[k] = rays.pixel[i];
      leaving.sample[k] = rays.sample[i];
      leaving.stream[k] = stream;
    }
  }

  Walker walker_;
  Light light_;
  int first_channel_;
  double bottom_;
  double height_;
  FlightStream flights_;
  FlightStream shadow_flights_;
  RayStream next_;
  std::vector<std::size_t> scattered_;  ///< Slots of the rays that have.
  WalkStatistics statistics_;
};

/// A tracker, with a walk for all channels or one for each.
class SpectralContestant {
 public:
  SpectralContestant(const std::string& tracker, const Medium& medium, Light light,
                     std::size_t rays, uint64_t seed)
      : name_(tracker) {
    WalkSettings settings;
    settings.tracker = tracker;
    settings.seed = seed;
    const bool shared = shares_paths(medium, settings);
    for (int channel = 0; channel < (shared ? 1 : kChannels); ++channel) {
      walks_.emplace_back(medium, settings, shared ? Walker::kAllChannels : channel, light);
    }
    for (int channel = 0; channel < kChannels; ++channel) {
      sums_[channel].assign(rays, 0.0);
      squares_[channel].assign(rays, 0.0);
    }
  }

  /// A path, or one for each channel, from every ray.
  void follow(const std::vector<RayStream>& batches, int repetition, int scatterings) {
    Radiances radiances;
    for (auto& values : radiances) values.assign(sums_[0].size(), 0.0);
    double time = 0;
    for (Paths& paths : walks_) {
      std::size_t first_ray = 0;
      for (const RayStream& rays : batches) {
        time += paths.follow(rays, repetition, scatterings, first_ray, radiances);
        first_ray += rays.size();
      }
    }
    seconds_.push_back(time);
    for (int channel = 0; channel < kChannels; ++channel) {
      for (std::size_t ray = 0; ray < sums_[channel].size(); ++ray) {
        const double radiance = radiances[channel][ray];
        sums_[channel][ray] += radiance;
        squares_[channel][ray] += radiance * radiance;
      }
    }
  }

  /// Mean radiance, and the variance of a path about the mean of its ray.
  Mean radiance(int channel) const {
    double sum = 0;
    double variance = 0;
    for (std::size_t ray = 0; ray < sums_[channel].size(); ++ray) {
      const double mean = sums_[channel][ray] / kSpectralRepetitions;
      sum += mean;
      variance += (squares_[channel][ray] / kSpectralRepetitions - mean * mean) *
                  kSpectralRepetitions / (kSpectralRepetitions - 1);
    }
    const auto rays = static_cast<double>(sums_[channel].size());
    return {sum / rays, variance / rays};
  }

  /// Mean over channels of the variance over the squared mean.
  double relative_variance() const {
    double sum = 0;
    for (int channel = 0; channel < kChannels; ++channel) {
      const Mean m = radiance(channel);
      sum += m.variance / (m.value * m.value);
    }
    return sum / kChannels;
  }

  /// Of a path for all channels, or of one for each together.
  double microseconds() const { return median(seconds_) * 1e6 / double(sums_[0].size()); }

  bool agrees(const SpectralContestant& other) const {
    const double paths = double(sums_[0].size()) * kSpectralRepetitions;
    bool same = true;
    for (int channel = 0; channel < kChannels; ++channel) {
      Mean mine = radiance(channel);
      Mean others = other.radiance(channel);
      mine.variance /= paths;
      others.variance /= paths;
      same &= agree(mine, others);
    }
    return same;
  }

  const std::string& name() const { return name_; }
  /// Run by run, since neighbours in time had the same machine.
  double time_ratio(const SpectralContestant& other) const {
    std::vector<double> ratios;
    for (std::size_t run = 0; run < seconds_.size(); ++run) {
      ratios.push_back(seconds_[run] / other.seconds_[run]);
    }
    return median(ratios);
  }

 private:
  std::string name_;
  std::vector<Paths> walks_;
  Radiances sums_;
  Radiances squares_;
  std::vector<double> seconds_;
};

}  // namespace

bool compare_spectral_costs(const std::string& title, const Medium& medium,
                            const std::vector<RayStream>& rays, Light light, int scatterings) {
  std::size_t count = 0;
  for (const RayStream& batch : rays) count += batch.size();
  std::vector<SpectralContestant> contestants;
  for (const char* tracker : {"per-wavelength", "spectral", "spectral-decomposition",
                              "hero-wavelength", "hero-wavelength:selection=throughput-albedo"}) {
    // Other random numbers for each, so that their means are independent.
    contestants.emplace_back(tracker, medium, light, count, contestants.size());
  }
  for (int repetition = 0; repetition < kSpectralRepetitions; ++repetition) {
    for (SpectralContestant& contestant : contestants) {
      contestant.follow(rays, repetition, scatterings);
    }
  }
  fmt::print("\n{}\n{:<46}{:>9}{:>10}{:>10}{:>8}{:>26}\n", title, "", "us/path", "time",
             "rel. var.", "cost", "radiance");
  const SpectralContestant& first = contestants.front();
  bool same = true;
  for (const SpectralContestant& contestant : contestants) {
    const bool agrees = contestant.agrees(first);
    const double variance = contestant.relative_variance();
    const double time = contestant.time_ratio(first);
    fmt::print("{:<46}{:>9.3f}{:>10.3f}{:>10.4f}{:>8.3f}{:>10.4f}{:>8.4f}{:>8.4f}{}\n",
               contestant.name(), contestant.microseconds(), time, variance,
               time * variance / first.relative_variance(), contestant.radiance(0).value,
               contestant.radiance(1).value, contestant.radiance(2).value,
               agrees ? "" : "  differs from the first row");
    same &= agrees;
  }
  return same;
}

}  // namespace freepath::bench
