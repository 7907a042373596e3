#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/agreement.h"
#include "bench/media.h"
#include "bench/scalar_trackers.h"
#include "bench/tables.h"
#include "bench/timing.h"
#include "freepath/transport/walker.h"

namespace freepath::bench {
namespace {

constexpr int kScalarRepetitions = 9;
constexpr double kBar = 3;  ///< How many times faster than a scalar loop the lanes should be.

/// Sums over rays of something that each has.
struct Moments {
  double sum = 0;
  double squares = 0;
  void add(double value) {
    sum += value;
    squares += value * value;
  }
};

/// What a walk did to its rays, as far as it must be the same for all variants.
struct Record {
  double rays = 0;
  Moments collisions;  ///< Of lanes the sum alone: they do not keep them ray by ray.
  Moments lookups;
  Moments escaped;    ///< Weight of a ray that escaped, first channel; of a transmittance, any.
  Moments scattered;  ///< Weight of a ray that scattered.

  void add(Event event, double weight, double ray_lookups) {
    rays += 1;
    lookups.add(ray_lookups);
    escaped.add(event == Event::kEscape ? weight : 0.0);
    scattered.add(event == Event::kScatter ? weight : 0.0);
  }
};

bool same_mean(const Moments& a, double a_count, const Moments& b, double b_count) {
  return agree(mean(a.sum, a.squares, a_count), mean(b.sum, b.squares, b_count));
}

/// @param scalar whose collisions lend their variance to those of the lanes
bool same_walk(const Record& scalar, const Record& lanes) {
  const Mean collisions = mean(scalar.collisions.sum, scalar.collisions.squares, scalar.rays);
  const Mean of_lanes{lanes.collisions.sum / lanes.rays, collisions.variance};
  return agree(collisions, of_lanes) &&
         same_mean(scalar.lookups, scalar.rays, lanes.lookups, lanes.rays) &&
         same_mean(scalar.escaped, scalar.rays, lanes.escaped, lanes.rays) &&
         same_mean(scalar.scattered, scalar.rays, lanes.scattered, lanes.rays);
}

/// A way to walk, its times, and what its last run did.
struct Variant {
  std::vector<double> nanoseconds;  ///< Per tentative collision, of each run.
  Record record;
};

/// One method in lanes and in scalars, on one medium.
class Rivals {
 public:
  Rivals(const std::string& method, bool free_paths, int channels, const Medium& medium,
         const std::shared_ptr<const ScalarMedium>& scalar_medium)
      : name_(method),
        free_paths_(free_paths),
        walker_(medium, lane_settings(method, free_paths),
                channels == kChannels ? Walker::kAllChannels : 0) {
    for (const Interpolation interpolation :
         {Interpolation::kTrilinear, Interpolation::kStochastic}) {
      scalars_.emplace_back(scalar_medium, ScalarSettings{.method = method,
                                                          .free_paths = free_paths,
                                                          .interpolation = interpolation,
                                                          .channels = channels});
    }
  }

  /// One run of each variant.
  void walk(const std::vector<RayStream>& batches) {
    walk_lanes(batches);
    for (int i = 0; i < kScalars; ++i) walk_scalar(batches, scalars_[i], scalar_[i]);
  }

  /// Prints a row. @return whether the variants agree
  bool print() const {
    double ratios[kScalars];
    bool same = true;
    for (int i = 0; i < kScalars; ++i) {
      std::vector<double> side_by_side;
      for (std::size_t run = 0; run < lanes_.nanoseconds.size(); ++run) {
        side_by_side.push_back(scalar_[i].nanoseconds[run] / lanes_.nanoseconds[run]);
      }
      ratios[i] = median(side_by_side);
      same &= same_walk(scalar_[i].record, lanes_.record);
    }
    const Record& record = lanes_.record;
    const auto verdict = [](double ratio) { return ratio >= kBar ? "yes" : "no"; };
    fmt::print("{:<25}{:>10.1f}{:>11.1f}{:>8.1f}{:>7.2f} {:<4}{:>7.2f} {:<4}{:>11.3f}{:>9.4f}{}\n",
               name_, median(scalar_[0].nanoseconds), median(scalar_[1].nanoseconds),
               median(lanes_.nanoseconds), ratios[0], verdict(ratios[0]), ratios[1],
               verdict(ratios[1]), record.collisions.sum / record.rays,
               (record.escaped.sum + record.scattered.sum) / record.rays,
               same ? "" : "  scalars and lanes differ");
    return same;
  }

 private:
  static constexpr int kScalars = 2;

  static WalkSettings lane_settings(const std::string& method, bool free_paths) {
    WalkSettings settings;
    (free_paths ? settings.tracker : settings.transmittance) = method;
    return settings;
  }

  void walk_lanes(const std::vector<RayStream>& batches) {
    WalkStatistics statistics;
    lanes_.record = {};
    double seconds = 0;
    for (const RayStream& rays : batches) {
      const double start = thread_seconds();
      if (free_paths_) {
        walker_.free_paths(rays, lane_flights_, statistics);
      } else {
        walker_.transmittance(rays, lane_flights_, statistics);
      }
      seconds += thread_seconds() - start;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        lanes_.record.add(lane_flights_.event[i], lane_flights_.weight[0][i],
                          lane_flights_.lookups[i]);
      }
    }
    lanes_.record.collisions.sum = static_cast<double>(statistics.tentative_collisions);
    lanes_.nanoseconds.push_back(seconds * 1e9 / lanes_.record.collisions.sum);
  }

  void walk_scalar(const std::vector<RayStream>& batches, const ScalarWalk& walk,
                   Variant& variant) {
    variant.record = {};
    double seconds = 0;
    for (const RayStream& rays : batches) {
      const double start = thread_seconds();
      walk.run(rays, scalar_flights_);
      seconds += thread_seconds() - start;
      for (const ScalarFlight& flight : scalar_flights_) {
        variant.record.add(flight.event, flight.weight[0], flight.lookups);
        variant.record.collisions.add(flight.collisions);
      }
    }
    variant.nanoseconds.push_back(seconds * 1e9 / variant.record.collisions.sum);
  }

  std::string name_;
  bool free_paths_;
  Walker walker_;
  std::vector<ScalarWalk> scalars_;  ///< Trilinear, stochastic.
  Variant scalar_[kScalars];
  Variant lanes_;
  FlightStream lane_flights_;
  std::vector<ScalarFlight> scalar_flights_;
};

bool compare(const char* title, std::vector<Rivals> all, const std::vector<RayStream>& rays) {
  for (int repetition = 0; repetition < kScalarRepetitions; ++repetition) {
    for (Rivals& rivals : all) rivals.walk(rays);
  }
  fmt::print("\n{}\n{:<25}{:>10}{:>11}{:>8}{:>11} {:>11} {:>10}{:>9}\n", title, "", "trilinear",
             "stochastic", "lanes", "tri./lanes", "sto./lanes", "coll./ray", "weight");
  bool same = true;
  for (const Rivals& rivals : all) same &= rivals.print();
  return same;
}

}  // namespace

bool compare_with_scalar_loops(const Medium& cloud, const std::vector<RayStream>& rays) {
  const Rgb sigma_t = cloud.components()[0].sigma_t();
  const Medium grey = with_spectra(cloud, sigma_t * 0.1F, sigma_t * 0.9F);
  const Medium parts = in_two_parts(grey);
  const auto scalar_grey = make_scalar_medium(grey);
  const auto scalar_parts = make_scalar_medium(parts);
  std::vector<Rivals> trackers;
  for (const char* name :
       {"delta", "weighted-delta", "decomposition", "weighted-decomposition", "spectral",
        "spectral-decomposition", "hero-wavelength", "per-wavelength"}) {
    trackers.emplace_back(name, true, 1, grey, scalar_grey);
  }
  trackers.emplace_back("multi-volume", true, 1, parts, scalar_parts);
  bool same = compare(
      "512^3 cloud, one channel, to the first real collision: ns per tentative collision of scalar "
      "loops and lanes; are lanes 3 times faster?",
      std::move(trackers), rays);

  std::vector<Rivals> estimators;
  for (const char* name : {"ratio", "delta", "residual-ratio", "next-flight"}) {
    estimators.emplace_back(name, false, 1, grey, scalar_grey);
  }
  same &= compare("512^3 cloud, one channel, transmittance", std::move(estimators), rays);

  const Rgb chromatic = sigma_t * Rgb(1.0F, 0.6F, 0.3F);
  const Medium coloured = with_spectra(cloud, chromatic * 0.1F, chromatic * 0.9F);
  const auto scalar_coloured = make_scalar_medium(coloured);
  std::vector<Rivals> spectral;
  for (const char* name : {"spectral", "spectral-decomposition"}) {
    spectral.emplace_back(name, true, kChannels, coloured, scalar_coloured);
  }
  return compare("512^3 chromatic cloud, three channels", std::move(spectral), rays) && same;
}

}  // namespace freepath::bench
