#include "tests/certify/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/certify/tallies.h"
#include "tests/statistics.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr int kBins = 24;
constexpr std::size_t kBatch = 16'384;
constexpr uint64_t kPilotPaths = 4096;
constexpr uint64_t kSlowPilotPaths = 512;
constexpr uint32_t kPilotPixel = 1;
constexpr uint32_t kPixel = 2;
/// Fewer contributions than this are counted, not averaged.
constexpr uint64_t kFew = 1000;
/// So many contributions of exactly 1 come from a method that knows no other weight.
constexpr uint64_t kSurelyAnalog = 20;
/// A mean over paths says nothing unless so many contributions of 1, which is what events too rare
/// to be seen may be worth, would make up the expectation.
constexpr double kFewExpected = 100;
/// Single precision, relative to what is expected: some hundred terms of a sum.
constexpr double kRounding = 2e-5;
/// Events of which so many are expected are seen: none comes with a probability of e^-20.
constexpr double kSurelySeen = 20;
/// Look-ups and steps of a path above which a case takes fewer paths, and below which it may take
/// more; and the share of the paths that those on one lane and methods that are no walks take.
constexpr double kUsualWork = 40;
constexpr double kMostTimes = 8;
constexpr double kSlowShare = 1.0 / 16;
/// The share of the most paths that is spent where even those don't bring the error that is wanted.
constexpr double kBeyondReach = 0.22;
/// Relative standard errors below this are too near to rounding for a mean's sign to tell anything.
constexpr double kClearOfRounding = 5 * kRounding;
/// A flight from wherever paths with a history are.
constexpr uint32_t kHistoryStream = 0x00012345;
/// Below it a transmittance is 0 in single precision.
constexpr double kUnderflow = 1e-45;

struct Exact {
  double radiance = 0;
  double transmittance = 0;
  std::vector<double> bins;  ///< ∫ µ_s T dt, with µ_t in place of µ_s where nothing is lost.
};

double z_of_p(double p) { return p <= 0 ? 1e3 : p >= 1 ? 0 : -normal_quantile(0.5 * p); }

class Measurement {
 public:
  Measurement(const CertifiedCase& test, const CertifyBudget& budget)
      : test_(test),
        medium_(test.walked_medium()),
        channels_(certified_media()[test.medium].channels),
        ray_(certified_media()[test.medium].ray),
        profile_(medium_, channels_, ray_, test.interpolation),
        budget_(budget),
        settings_(test.settings()),
        shared_(!test.free_paths || shares_paths(channels_, settings_)) {
    for (int channel = 0; channel < channels_.count; ++channel) expect(channel);
  }

  CaseResult run() {
    CaseResult result = walk_and_compare(choose_paths());
    // A pilot may not have seen what makes the weights spread.
    while (!tests_every_channel(result) && 4 * result.paths <= most_paths_) {
      result = walk_and_compare(4 * result.paths);
    }
    return result;
  }

 private:
  CaseResult walk_and_compare(uint64_t paths) {
    CaseResult result;
    result.test = test_;
    result.paths = paths;
    walk(kPixel, paths, result.statistics);
    const auto walked = static_cast<double>(result.statistics.rays);
    result.lookups = static_cast<double>(result.statistics.lookups) / walked;
    for (int channel = 0; channel < channel_count(); ++channel) {
      compare(channel, static_cast<double>(paths), result);
    }
    result.variance /= channel_count();
    result.signed_z = pool(result, static_cast<double>(paths));
    return result;
  }

  /// How far the sum over channels is off, in standard errors. A mean and its error are correlated
  /// where values are skewed: -skewness/(2 √n) is what that makes of the expectation.
  std::optional<double> pool(const CaseResult& result, double paths) const {
    if (!tests_every_channel(result)) return {};
    double exact = 0;
    double sum = 0;
    double variance = 0;
    double third = 0;
    for (int channel = 0; channel < channel_count(); ++channel) exact += exact_[channel].radiance;
    for (const PowerSums& moments : together_) {
      const double spread = moments.variance(paths);
      sum += moments.sum / paths;
      variance += spread;
      third += moments.skewness(paths) * spread * std::sqrt(spread);
    }
    const double error = std::sqrt(variance / paths);
    if (!(error > kClearOfRounding * exact)) return {};
    const double skewness = third / (variance * std::sqrt(variance));
    return (sum - exact) / error + skewness / (2 * std::sqrt(paths));
  }

  /// Whether the radiance or transmittance of each channel counts.
  static bool tests_every_channel(const CaseResult& result) {
    return std::all_of(result.checks.begin(), result.checks.end(), [](const Check& check) {
      return check.standing == Standing::kTested || !check.principal;
    });
  }

  bool is(const char* name) const { return test_.method_name() == name; }
  bool slow() const {
    if (is("closed-form")) return false;  // one draw a path
    return test_.one_lane || is("regular") || is("p-series") || is("unbiased-ray-marching");
  }
  bool has_no_variance() const {
    return !test_.free_paths && (test_.method == "regular" || test_.method == "closed-form");
  }
  /// Channels whose numbers differ.
  int channel_count() const {
    const bool grey = test_.free_paths ? channels_.is_grey() : channels_.has_grey_extinction();
    return grey ? 1 : channels_.count;
  }

  /// The exact side of one channel.
  void expect(int channel) {
    ChannelTally& tally = tallies_[channel];
    Exact& exact = exact_[channel];
    tally.edges = profile_.equal_bins(channel, kBins);
    exact.transmittance = std::exp(-profile_.depth(channel));
    exact.radiance = exact.transmittance;
    if (!test_.free_paths) return;
    const std::vector<ComponentChannels>& components = channels_.components;
    for (std::size_t bin = 0; bin + 1 < tally.edges.size(); ++bin) {
      double scattered = 0;
      profile_.visit(tally.edges[bin], tally.edges[bin + 1], [&](const RayProfile::Node& node) {
        for (std::size_t k = 0; k < components.size(); ++k) {
          const ComponentChannels& component = components[k];
          const double hit = node.width * node.transmittance[channel] * node.density[k];
          scattered += hit * component.sigma_s[channel];
          exact.radiance += hit * (component.sigma_a[channel] * component.emission[channel] +
                                   component.sigma_s[channel] *
                                       scattered_radiance(static_cast<int>(k), channel, node.t));
        }
      });
      exact.bins.push_back(scattered);
    }
  }

  /// Enough paths for the error that is wanted, and for normal means, by a pilot.
  /// Sets the most that are worth their cost, too.
  uint64_t choose_paths() {
    WalkStatistics statistics;
    const uint64_t pilot_paths = slow() ? kSlowPilotPaths : kPilotPaths;
    walk(kPilotPixel, pilot_paths, statistics);
    double wanted = 0;
    for (int channel = 0; channel < channel_count(); ++channel) {
      const auto n = static_cast<double>(pilot_paths);
      const PowerSums& pilot = tallies_[channel].radiance;
      const double error = budget_.relative_error * std::max(1e-3, exact_[channel].radiance);
      wanted =
          std::max({wanted, pilot.variance(n) / (error * error), pilot.paths_for_normal_mean(n),
                    tallies_[channel].escaped.paths_for_normal_mean(n)});
    }
    const double work = static_cast<double>(statistics.lookups + statistics.super_voxel_steps) /
                        static_cast<double>(pilot_paths);
    const double most = (slow() ? kSlowShare : 1) * static_cast<double>(budget_.most_paths) *
                        std::min(kMostTimes, kUsualWork / work);
    most_paths_ = std::max(pilot_paths, static_cast<uint64_t>(most));
    const double affordable = wanted <= most ? wanted : kBeyondReach * most;
    return std::clamp(static_cast<uint64_t>(affordable), pilot_paths, most_paths_);
  }

  void walk(uint32_t pixel, uint64_t paths, WalkStatistics& statistics) {
    for (int channel = 0; channel < channels_.count; ++channel) {
      ChannelTally& tally = tallies_[channel];
      tally.radiance = tally.escaped = {};
      tally.bins.assign(tally.edges.size() - 1, {});
    }
    const int turns = shared_ ? 1 : channel_count();
    together_.assign(turns, {});
    FlightStream flights;
    std::vector<double> sums;
    for (int turn = 0; turn < turns; ++turn) {
      const Walker walker(medium_, shared_ ? channels_ : channels_.only(turn), settings_);
      for (uint64_t done = 0; done < paths; done += kBatch) {
        const std::size_t count = std::min<uint64_t>(kBatch, paths - done);
        RayStream rays =
            repeat_ray(ray_.origin, ray_.direction, ray_.t_max, count, static_cast<uint32_t>(done));
        // Channels that take their own paths take their own random numbers.
        std::fill(rays.pixel.begin(), rays.pixel.end(), pixel + (static_cast<uint32_t>(turn) << 8));
        if (test_.history) bring_history(rays, turn);
        sums.assign(count, 0);
        if (test_.free_paths) {
          walker.free_paths(rays, flights, statistics);
        } else {
          walker.transmittance(rays, flights, statistics);
        }
        const int first = shared_ ? 0 : turn;
        const int last = shared_ ? channel_count() : turn + 1;
        for (int channel = first; channel < last; ++channel) {
          const int slot = shared_ ? channel : 0;
          for (std::size_t i = 0; i < count; ++i) sums[i] += add(flights, i, slot, channel);
        }
        for (const double sum : sums) together_[turn].add(sum);
      }
    }
  }

  /// Weights and densities as a path has them that has been through other media.
  void bring_history(RayStream& rays, int turn) const {
    rays.set_weighted(true);
    const double mean = mean_density();
    for (int slot = 0; slot < kMaxChannels; ++slot) {
      const int channel = shared_ ? slot : turn;
      const auto density = static_cast<float>(history_density(channel) / mean);
      std::fill(rays.weight[slot].begin(), rays.weight[slot].end(), history_weight(channel));
      std::fill(rays.density[slot].begin(), rays.density[slot].end(), density);
    }
    std::fill(rays.stream.begin(), rays.stream.end(), kHistoryStream);
  }

  /// Of the history's densities, over the channels of the compiled walk: some may stand twice.
  double mean_density() const {
    const int count = shared_ && !channels_.is_grey() ? channels_.count : 1;
    const std::vector<Kernel>& trackers = kernels(settings_.simd).trackers;
    const auto kernel = std::find_if(
        trackers.begin(), trackers.end(),
        [&](const Kernel& candidate) { return candidate.info.name == test_.method_name(); });
    if (kernel == trackers.end()) return 1;
    const int compiled = compiled_channels(kernel->walks, count);
    double sum = 0;
    for (int row = 0; row < compiled; ++row) sum += history_density(row % count);
    return sum / compiled;
  }

  /// Adds a flight to what is gathered of a channel, relative to the weight that its ray brought.
  /// @return what it has seen
  double add(const FlightStream& flights, std::size_t i, int slot, int channel) {
    ChannelTally& tally = tallies_[channel];
    const double per_weight = test_.history ? 1 / history_weight(channel) : 1;
    const double weight = flights.weight[slot][i] * per_weight;
    if (!test_.free_paths) {
      tally.radiance.add(weight);
      return weight;
    }
    double seen = flights.emitted[slot][i] * per_weight;
    if (flights.event[i] == Event::kEscape) {
      tally.escaped.add(weight);
      seen += weight;
    } else if (flights.event[i] == Event::kScatter) {
      const double t = flights.t[i];
      seen += weight * scattered_radiance(flights.component[i], channel, t);
      const auto& edges = tally.edges;
      const auto found = std::upper_bound(edges.begin(), edges.end(), t) - edges.begin();
      const auto bin = std::clamp<std::ptrdiff_t>(found - 1, 0, std::ssize(tally.bins) - 1);
      tally.bins[bin].add(weight);
    }
    tally.radiance.add(seen);
    return seen;
  }

  Check compare_mean(std::string quantity, const PowerSums& moments, double paths,
                     double exact) const {
    Check check{.quantity = std::move(quantity), .exact = exact};
    check.estimate = moments.sum / paths;
    check.standard_error = std::sqrt(moments.variance(paths) / paths);
    if (exact < kUnderflow) {
      check.z = check.estimate == 0 ? 0 : 1e3;
      return check;
    }
    const bool few = std::min(static_cast<double>(moments.count), exact * paths) < kFew;
    // A radiance may be all of units too, and its quadrature a trifle above 1.
    if (few && moments.unit && moments.count >= kSurelyAnalog && exact <= 1) {
      // That all paths are alike tells nothing where so few would differ.
      const bool all = static_cast<double>(moments.count) == paths;
      if (all && (1 - exact) * paths < kSurelySeen) check.standing = Standing::kRare;
      check.z = z_of_p(binomial_two_sided_p(moments.count, static_cast<uint64_t>(paths), exact));
      return check;
    }
    if (!has_no_variance()) {
      // A mean that is off although nothing but rounding spreads has not seen what makes the
      // spread: no wonder where that is rare.
      const double off = std::abs(check.estimate - exact);
      const bool spreads = moments.variance(paths) > std::pow(kRounding * exact, 2);
      const bool unseen = !spreads && off > kRounding * exact && off * paths < kSurelySeen;
      const bool rare = moments.count < kFew || exact * paths < kFewExpected || unseen;
      const bool heavy = moments.paths_for_normal_mean(paths) > paths;
      check.standing = rare ? Standing::kRare : heavy ? Standing::kHeavy : Standing::kTested;
    }
    const double apart = std::abs(check.estimate - exact) - kRounding * exact;
    const double z = apart <= 0 ? 0 : apart / check.standard_error;  // written so that NaN stays
    check.z = std::isfinite(check.estimate) ? std::min(z, 1e3) : 1e3;
    return check;
  }

  /// Hotelling's form n dᵀ C⁻¹ d of the distances of the bins' sums from what is expected. A flight
  /// adds to one bin at most, so C = D - µµᵀ with D the mean squared weights, inverted by Sherman
  /// and Morrison's formula. With weights of 1 it is Pearson's test.
  Check compare_distribution(int channel, double paths) const {
    const std::vector<PowerSums>& bins = tallies_[channel].bins;
    Check check{.quantity = "free path"};
    double distance = 0;
    double across = 0;
    double inner = 0;
    std::size_t freedom = 0;
    for (std::size_t bin = 0; bin < bins.size(); ++bin) {
      const double expected = exact_[channel].bins[bin];
      check.estimate += bins[bin].sum / paths;
      check.exact += expected;
      if (expected == 0 && bins[bin].count > 0) check.z = 1e3;
      const bool thin =
          bins[bin].count < kFew / 2 || bins[bin].paths_for_normal_mean(paths) > paths;
      if (thin) continue;  // with the escapes, so to speak
      ++freedom;
      const double square = mean_square(bins[bin], expected, paths);
      const double apart = bins[bin].sum / paths - expected;
      distance += apart * apart / square;
      across += apart * expected / square;
      inner += expected * expected / square;
    }
    if (freedom == 0) {
      check.standing = Standing::kRare;
      return check;
    }
    // Where all paths end in bins with the same weight, the last distance follows from the others.
    const bool complete = paths * (1 - inner) < kFewExpected;
    const double statistic =
        paths * (complete ? distance : distance + across * across / (1 - inner));
    const auto degrees = static_cast<double>(complete ? freedom - 1 : freedom);
    if (degrees > 0)
      check.z = std::max(check.z, z_of_p(upper_gamma(0.5 * degrees, 0.5 * statistic)));
    return check;
  }

  /// Of what paths contribute to a bin, in proportion to the exact mean: of fewer contributions
  /// than expected the squares are too small by as much as the sum. Unless the sum is lost in its
  /// noise.
  static double mean_square(const PowerSums& bin, double expected, double paths) {
    const double mean = bin.sum / paths;
    const bool clear = mean > 5 * std::sqrt(bin.variance(paths) / paths);
    return clear ? bin.squares / bin.sum * expected : bin.squares / paths;
  }

  void compare(int channel, double paths, CaseResult& result) const {
    const std::string suffix = channel_count() == 1 ? "" : fmt::format(" {}", channel);
    const ChannelTally& tally = tallies_[channel];
    const Exact& exact = exact_[channel];
    result.variance += tally.radiance.variance(paths);
    if (!test_.free_paths) {
      result.checks.push_back(
          compare_mean("transmittance" + suffix, tally.radiance, paths, exact.transmittance));
      result.checks.back().principal = true;
      return;
    }
    result.checks.push_back(
        compare_mean("radiance" + suffix, tally.radiance, paths, exact.radiance));
    result.checks.back().principal = true;
    result.checks.push_back(
        compare_mean("transmittance" + suffix, tally.escaped, paths, exact.transmittance));
    result.checks.push_back(compare_distribution(channel, paths));
    result.checks.back().quantity += suffix;
  }

  const CertifiedCase& test_;
  const Medium& medium_;
  const MediumChannels& channels_;
  CertifiedRay ray_;
  RayProfile profile_;
  CertifyBudget budget_;
  WalkSettings settings_;
  bool shared_;
  uint64_t most_paths_ = 0;
  std::array<ChannelTally, kMaxChannels> tallies_;
  std::vector<PowerSums> together_;  ///< Of the channels of a path; one for each walker.
  std::array<Exact, kMaxChannels> exact_;
};

}  // namespace

CaseResult measure(const CertifiedCase& test, const CertifyBudget& budget) {
  return Measurement(test, budget).run();
}

}  // namespace freepath::testing
