// The distribution of free paths against quadrature: where flights end, in what events and
// components, and what emission they collect.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "tests/statistics.h"
#include "tests/transport/walk_fixtures.h"

namespace freepath::testing {
namespace {

// ---- Where flights end ------------------------------------------------------------------------

constexpr int kBins = 36;

struct DistanceCase {
  const char* tracker;
  int ray;
  Interpolation interpolation;
  Simd simd;
  std::size_t paths;
};

std::vector<DistanceCase> distance_cases() {
  std::vector<DistanceCase> cases;
  for (const Interpolation interpolation : kInterpolations) {
    for (int ray = 0; ray < 3; ++ray) {
      cases.push_back({"delta", ray, interpolation, Simd::kBest, 1'200'000});
    }
    cases.push_back({"delta", 1, interpolation, Simd::kOneLane, 200'000});
    cases.push_back({"weighted-delta", 0, interpolation, Simd::kBest, 1'200'000});
    cases.push_back({"weighted-delta:rate-scale=0.7", 1, interpolation, Simd::kBest, 2'400'000});
    cases.push_back({"weighted-delta:rate-scale=2", 2, interpolation, Simd::kBest, 1'200'000});
    cases.push_back({"weighted-delta:rate-scale=0.7", 2, interpolation, Simd::kOneLane, 200'000});
    if (interpolation == Interpolation::kStochastic) continue;  // which regular tracking refuses
    cases.push_back({"regular", 1, interpolation, Simd::kBest, 1'200'000});
    cases.push_back({"regular", 2, interpolation, Simd::kBest, 400'000});
  }
  return cases;
}

/// Weights of collisions by the bin they fall into.
struct Bins {
  std::vector<double> sum = std::vector<double>(kBins);
  std::vector<double> squares = std::vector<double>(kBins);
  std::vector<uint64_t> counts = std::vector<uint64_t>(kBins + 1);  ///< The last: escaped.
};

Bins fill_bins(const Walker& walker, const TestRay& ray, const std::vector<double>& edges,
               std::size_t paths) {
  Bins bins;
  for_each_flight(walker, ray, paths, [&](const FlightStream& flights, std::size_t i) {
    if (flights.event[i] == Event::kEscape) {
      ++bins.counts[kBins];
      return;
    }
    const auto found = std::upper_bound(edges.begin(), edges.end(), flights.t[i]);
    const auto bin = std::min<std::size_t>(found - edges.begin(), kBins - 1);
    const double weight = flights.weight[0][i];
    ++bins.counts[bin];
    bins.sum[bin] += weight;
    bins.squares[bin] += weight * weight;
  });
  return bins;
}

/// Hotelling's form n dᵀ C⁻¹ d of the distances d from the expectation. A flight falls into one
/// bin, so the covariance of the bins is C = D - µµᵀ with D the mean squared weights, and its
/// inverse is Sherman and Morrison's D⁻¹ + D⁻¹µµᵀD⁻¹/(1 - µᵀD⁻¹µ). With weights of 1 this is
/// Pearson's test.
ChiSquare weighted_test(const Bins& bins, double expected, std::size_t paths) {
  const auto n = static_cast<double>(paths);
  double distance = 0;
  double across = 0;
  double inner = 0;
  for (int bin = 0; bin < kBins; ++bin) {
    const double square = bins.squares[bin] / n;
    const double apart = bins.sum[bin] / n - expected;
    distance += apart * apart / square;
    across += apart * expected / square;
    inner += expected * expected / square;
  }
  ChiSquare result;
  result.degrees_of_freedom = kBins;
  result.statistic = n * (distance + across * across / (1 - inner));
  result.p_value = upper_gamma(0.5 * kBins, 0.5 * result.statistic);
  return result;
}

/// @param planted factor on the extinction, 1 unless an error is planted
ChiSquare test_distances(const DistanceCase& test, double planted = 1) {
  const TestRay ray = test_rays()[test.ray];
  Component component;
  component.density = lumpy_field();
  component.sigma_a = Rgb(0.5F);
  component.sigma_s = Rgb(1.5F);
  const RayIntegrals exact = integrate(Medium({component}), ray, test.interpolation);
  component.sigma_a *= static_cast<float>(planted);
  component.sigma_s *= static_cast<float>(planted);
  const Medium medium({component}, 4 << test.ray);
  WalkSettings settings;
  settings.tracker = test.tracker;
  settings.interpolation = test.interpolation;
  settings.absorption = Absorption::kAnalog;
  settings.simd = test.simd;
  settings.seed = 77;
  const Bins bins = fill_bins(Walker(medium, settings), ray, exact.equal_bins(kBins), test.paths);
  const double expected = (1 - exact.transmittance()) / kBins;
  if (test.tracker != std::string_view("delta")) return weighted_test(bins, expected, test.paths);
  std::vector<double> counts(kBins, expected * static_cast<double>(test.paths));
  counts.push_back(exact.transmittance() * static_cast<double>(test.paths));
  return chi_square_test(bins.counts, counts);
}

std::string describe(const DistanceCase& test) {
  return std::string(test.tracker) + ", ray " + std::to_string(test.ray) + ", " +
         name_of(test.interpolation) + ", " + std::string(to_string(test.simd));
}

TEST(FreePaths, EndWhereQuadratureSays) {
  const std::vector<DistanceCase> cases = distance_cases();
  const double level = family_wise_level(1e-3, cases.size());
  for (const DistanceCase& test : cases) {
    EXPECT_TRUE(check_chi_square(describe(test), test_distances(test), level));
  }
}

// The power of the test above, for the cases with many paths.
TEST(FreePaths, OnePercentOfTheExtinctionMovesThem) {
  const std::vector<DistanceCase> cases = distance_cases();
  const double level = family_wise_level(1e-3, cases.size());
  for (const DistanceCase& test : cases) {
    const bool sharp = test.simd == Simd::kBest && test.paths > 1'000'000;
    const bool regular = test.tracker == std::string_view("regular");
    if (!sharp || (test.interpolation != Interpolation::kStochastic && !regular)) continue;
    EXPECT_FALSE(check_chi_square(describe(test), test_distances(test, 1.01), level))
        << describe(test);
  }
}

// ---- What happens there -----------------------------------------------------------------------

/// What is compared in each channel: weights of flights by event and component, and the tally.
enum Quantity { kScatterFirst, kScatterSecond, kAbsorb, kEscape, kEmitted, kQuantities };
constexpr const char* kQuantityNames[] = {"scatter by component 0", "scatter by component 1",
                                          "absorb", "escape", "emitted"};

struct EventCase {
  const char* tracker;
  Absorption absorption;
  EmissionTally emission;
  Interpolation interpolation;
  int channel;  ///< The one channel, or Walker::kAllChannels.
  std::size_t paths;
};

std::vector<EventCase> event_cases() {
  std::vector<EventCase> cases;
  for (const char* tracker : {"delta", "weighted-delta", "weighted-delta:rate-scale=0.7",
                              "weighted-delta:rate-scale=2", "regular"}) {
    for (const Absorption absorption : {Absorption::kAnalog, Absorption::kWeighted}) {
      for (const EmissionTally emission : {EmissionTally::kCollision, EmissionTally::kAnalog}) {
        const bool heavy = std::string_view(tracker).find("0.7") != std::string_view::npos;
        const std::size_t paths = heavy ? 1'600'000 : 800'000;
        // Regular tracking refuses the third.
        const int choices = std::string_view(tracker) == "regular" ? 2 : 3;
        const Interpolation interpolation = kInterpolations[cases.size() / 2 % choices];
        cases.push_back(
            {tracker, absorption, emission, interpolation, Walker::kAllChannels, paths});
        cases.push_back({tracker, absorption, emission, interpolation, 1, paths / 4});
      }
    }
  }
  return cases;
}

std::string describe(const EventCase& test) {
  return std::string(test.tracker) +
         (test.absorption == Absorption::kAnalog ? ", analog" : ", weighted") + " absorption, " +
         (test.emission == EmissionTally::kAnalog ? "analog" : "collision") + " emission, " +
         name_of(test.interpolation) +
         (test.channel == Walker::kAllChannels ? ", all channels" : ", one channel");
}

/// Two overlapping components: grey extinction, albedos of different colours. The weights of a
/// channel that both scatter and one that only the other does are both met.
/// @param extinction,split,emission errors to plant: a factor on all coefficients, a share of the
///   first component's extinction that scatters instead of being absorbed, a factor on emission
struct Planted {
  float extinction = 1;
  float split = 0;
  float emission = 1;
};

std::vector<Component> two_components(const Planted& planted = {}) {
  const float scale = 0.8F * planted.extinction;
  std::vector<Component> components(2);
  components[0].density = lumpy_field(0);
  components[0].sigma_s = (Rgb(0.8F, 0.5F, 0.3F) + Rgb(planted.split)) * scale;
  components[0].sigma_a = (Rgb(0.2F, 0.5F, 0.7F) - Rgb(planted.split)) * scale;
  components[0].emission = Rgb(1, 2, 0.5F) * planted.emission;
  components[0].phase = PhaseFunction::henyey_greenstein(0.8F);
  components[1].density = lumpy_field(1);
  components[1].sigma_s = Rgb(0.4F, 0.9F, 0.7F) * scale;
  components[1].sigma_a = Rgb(0.6F, 0.1F, 0.3F) * scale;
  components[1].emission = Rgb(0.3F, 1, 4) * planted.emission;
  components[1].phase = PhaseFunction::henyey_greenstein(-0.2F);
  return components;
}

using Estimates = std::array<std::array<Tally, kQuantities>, kChannels>;
using Expectations = std::array<std::array<double, kQuantities>, kChannels>;

Estimates estimate_events(const EventCase& test, const Planted& planted = {}) {
  const Medium medium(two_components(planted), 8);
  WalkSettings settings;
  settings.tracker = test.tracker;
  settings.interpolation = test.interpolation;
  settings.absorption = test.absorption;
  settings.emission = test.emission;
  settings.seed = 4;
  const Walker walker(medium, settings, test.channel);
  Estimates estimates;
  for_each_flight(walker, test_rays()[0], test.paths,
                  [&](const FlightStream& flights, std::size_t i) {
                    const Quantity end = flights.event[i] == Event::kEscape   ? kEscape
                                         : flights.event[i] == Event::kAbsorb ? kAbsorb
                                         : flights.component[i] == 0          ? kScatterFirst
                                                                              : kScatterSecond;
                    for (int slot = 0; slot < walker.channels(); ++slot) {
                      auto& row = estimates[test.channel < 0 ? slot : test.channel];
                      row[end].add(flights.weight[slot][i]);
                      row[kEmitted].add(flights.emitted[slot][i]);
                    }
                  });
  return estimates;
}

/// µ_s,k, µ_a and µ_a L_e times T, integrated along the ray. Under weighted absorption the absorbed
/// part is the weight that scatterings lose, and no flight ends by it.
Expectations expect_events(const EventCase& test) {
  const Medium medium(two_components());
  const RayIntegrals exact = integrate(medium, test_rays()[0], test.interpolation);
  Expectations expected{};
  for (int channel = 0; channel < kChannels; ++channel) {
    auto& row = expected[channel];
    row[kEscape] = exact.transmittance();
    for (int k = 0; k < 2; ++k) {
      const Component& component = medium.components()[k];
      row[k] = component.sigma_s[channel] * exact.collided[k];
      const double absorbed = component.sigma_a[channel] * exact.collided[k];
      if (test.absorption == Absorption::kAnalog) row[kAbsorb] += absorbed;
      row[kEmitted] += absorbed * component.emission[channel];
    }
  }
  return expected;
}

/// Comparisons of all cases: of three channels or of one.
std::size_t comparisons() { return event_cases().size() / 2 * kQuantities * (kChannels + 1); }

TEST(FreePaths, SplitIntoEventsComponentsAndEmissionAsQuadratureSays) {
  const double threshold = family_wise_threshold(1e-3, comparisons());
  for (const EventCase& test : event_cases()) {
    const Estimates estimates = estimate_events(test);
    const Expectations expected = expect_events(test);
    for (int channel = 0; channel < kChannels; ++channel) {
      if (test.channel != Walker::kAllChannels && test.channel != channel) continue;
      for (int q = 0; q < kQuantities; ++q) {
        const Tally& tally = estimates[channel][q];
        EXPECT_TRUE(check_mean(kQuantityNames[q], tally.mean(test.paths),
                               tally.standard_error(test.paths), test.paths, expected[channel][q],
                               {.z = threshold, .absolute = 5e-6}))
            << describe(test) << ", channel " << channel;
      }
    }
  }
}

// The power of the test above: 1 % of the extinction, 1 % of it scattered instead of absorbed in
// one component, 1 % of the emission.
TEST(FreePaths, OnePercentInAnyPartIsNoticed) {
  const double threshold = family_wise_threshold(1e-3, comparisons());
  for (const EventCase& test : event_cases()) {
    if (test.channel != Walker::kAllChannels || test.emission != EmissionTally::kCollision)
      continue;
    const Expectations expected = expect_events(test);
    for (const Planted& planted :
         {Planted{1.01F, 0, 1}, Planted{1, 0.01F, 1}, Planted{1, 0, 1.01F}}) {
      const Estimates estimates = estimate_events(test, planted);
      double largest = 0;
      for (int channel = 0; channel < kChannels; ++channel) {
        for (int q = 0; q < kQuantities; ++q) {
          const Tally& tally = estimates[channel][q];
          largest = std::max(
              largest, std::abs(z_score(tally.mean(test.paths), tally.standard_error(test.paths),
                                        expected[channel][q])));
        }
      }
      EXPECT_GT(largest, threshold) << describe(test) << ", planted " << planted.extinction << ' '
                                    << planted.split << ' ' << planted.emission;
    }
  }
}

}  // namespace
}  // namespace freepath::testing
