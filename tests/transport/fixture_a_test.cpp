// Every tracker and estimator against the quadrature of Fixture A, on every SIMD target.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "freepath/transport/walker.h"
#include "tests/statistics.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr std::size_t kBatch = 100'000;

struct FixtureCase {
  std::string tracker;
  Absorption absorption;
  EmissionTally emission;
};

const Medium& fixture() {
  static const Medium kMedium = FixtureA::medium();
  return kMedium;
}

WalkSettings settings_for(const FixtureCase& test, Simd simd) {
  WalkSettings settings;
  settings.tracker = test.tracker;
  settings.interpolation = Interpolation::kNearest;
  settings.absorption = test.absorption;
  settings.emission = test.emission;
  settings.simd = simd;
  settings.seed = 20170501;
  return settings;
}

/// Radiance that a flight along x brings back: the tally, and what its end sees.
/// @param slot of the channel in the flight
double radiance(const FlightStream& flights, std::size_t i, int channel, int slot) {
  double ending = 0;
  if (flights.event[i] == Event::kEscape) ending = 1;
  if (flights.event[i] == Event::kScatter) ending = FixtureA::scattered(flights.t[i], channel);
  return flights.emitted[slot][i] + flights.weight[slot][i] * ending;
}

/// Enough paths for a standard error of 0.2 %: weights of both signs, or large ones, need more.
std::size_t paths_for(const FixtureCase& test) {
  const auto has = [&](const char* text) { return test.tracker.find(text) != std::string::npos; };
  if (has("=max") || has("=average")) return 3'000'000;
  if (test.tracker == "regular" || has("ray-marching")) return 60'000;  // slow, with tame weights
  return has("scale=0.7") ? 2'000'000 : has("spectral") ? 1'000'000 : 400'000;
}

/// The same for transmittances.
std::size_t paths_for_transmittance(const std::string& method) {
  if (method == "regular") return 10;  // without variance
  return method == "p-series" || method == "unbiased-ray-marching" ? 100'000 : 600'000;
}

struct FixtureResult {
  std::array<RunningStatistics, kChannels> radiance;
  WalkStatistics walk;
};

/// All channels of one path, or one after the other.
FixtureResult estimate_radiance(const Medium& medium, const WalkSettings& settings,
                                std::size_t paths) {
  FixtureResult result;
  const bool shared = shares_paths(medium, settings);
  FlightStream flights;
  for (int turn = 0; turn < (shared ? 1 : kChannels); ++turn) {
    const Walker walker(medium, settings, shared ? Walker::kAllChannels : turn);
    for (std::size_t done = 0; done < paths; done += kBatch) {
      const std::size_t count = std::min(kBatch, paths - done);
      const RayStream rays =
          repeat_ray(Vec3f(0, 0, 0), Vec3f(1, 0, 0), 10.0F, count, static_cast<uint32_t>(done));
      walker.free_paths(rays, flights, result.walk);
      for (int slot = 0; slot < walker.channels(); ++slot) {
        const int channel = shared ? slot : turn;
        for (std::size_t i = 0; i < count; ++i) {
          result.radiance[channel].add(radiance(flights, i, channel, slot));
        }
      }
    }
  }
  return result;
}

/// What can only be right in another medium, or is known to be wrong with its standard options.
bool applies(const MethodInfo& info) { return info.name != "closed-form" && !info.biased; }

/// Every tracker of the registry, and the options that change its law.
std::vector<std::string> tracker_variants() {
  std::vector<std::string> variants;
  for (const MethodInfo& info : tracker_infos()) {
    if (applies(info)) variants.emplace_back(info.name);
  }
  for (const char* variant :
       {"weighted-delta:rate-scale=0.7", "weighted-delta:rate-scale=2",
        "weighted-delta:energy-partitioning=yes", "weighted-decomposition:control=1.3",
        "weighted-decomposition:control=0.5,rate-scale=0.7", "spectral:collision-probability=max",
        "spectral:collision-probability=average", "spectral:collision-probability=history-max",
        "spectral:rate-scale=0.7", "spectral-decomposition:collision-probability=max",
        "spectral-decomposition:collision-probability=average",
        "spectral-decomposition:collision-probability=history-max,control=1.3",
        "spectral-decomposition:control=1.3,rate-scale=0.7",
        "hero-wavelength:selection=throughput-albedo",
        "ray-marching:step=0.002"}) {  // steps so short that the bias is far below the error
    variants.emplace_back(variant);
  }
  return variants;
}

std::vector<FixtureCase> all_cases() {
  std::vector<FixtureCase> cases;
  for (const std::string& tracker : tracker_variants()) {
    for (const Absorption absorption : {Absorption::kAnalog, Absorption::kWeighted}) {
      for (const EmissionTally emission : {EmissionTally::kCollision, EmissionTally::kAnalog}) {
        cases.push_back({tracker, absorption, emission});
      }
    }
  }
  return cases;
}

std::string title_of(const FixtureCase& test) {
  return test.tracker +
         (test.absorption == Absorption::kAnalog ? ", analog absorption"
                                                 : ", weighted absorption") +
         (test.emission == EmissionTally::kAnalog ? ", analog emission" : ", collision emission");
}

class FixtureATracker : public ::testing::TestWithParam<std::string> {};

TEST_P(FixtureATracker, ReproducesTheRadiance) {
  const double threshold = family_wise_threshold(1e-3, all_cases().size() * 3);
  for (const FixtureCase& test : all_cases()) {
    if (test.tracker != GetParam()) continue;
    // Exact methods tally emission at real collisions in either mode, and are slow.
    if (test.tracker == "regular" && test.emission == EmissionTally::kAnalog) continue;
    const std::string name = title_of(test);
    const FixtureResult result =
        estimate_radiance(fixture(), settings_for(test, Simd::kBest), paths_for(test));
    for (int channel = 0; channel < kChannels; ++channel) {
      EXPECT_TRUE(check_mean(name + ", channel " + std::to_string(channel),
                             result.radiance[channel], FixtureA::kRadiance[channel],
                             {.z = threshold, .absolute = 2e-6, .largest_relative_error = 0.003}));
    }
    EXPECT_EQ(result.walk.bound_violations, 0U) << name;
    EXPECT_EQ(result.walk.tentative_collisions,
              result.walk.null_collisions + result.walk.real_collisions);
  }
}

INSTANTIATE_TEST_SUITE_P(All, FixtureATracker, ::testing::ValuesIn(tracker_variants()),
                         [](const auto& test) {
                           std::string name = test.param;
                           for (char& c : name) {
                             if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                           }
                           return name;
                         });

TEST(FixtureA, EveryTargetAgrees) {
  for (const char* tracker : {"weighted-delta:rate-scale=0.7", "spectral-decomposition",
                              "hero-wavelength", "weighted-decomposition:control=1.3"}) {
    const FixtureCase test{tracker, Absorption::kWeighted, EmissionTally::kCollision};
    for (const Simd simd : available_simd()) {
      const FixtureResult result = estimate_radiance(fixture(), settings_for(test, simd), 200'000);
      EXPECT_TRUE(check_mean(std::string(tracker) + std::string(to_string(simd)),
                             result.radiance[1], FixtureA::kRadiance[1], {.absolute = 2e-6}));
    }
  }
}

// What the history of a path is looked at for: the weights stay below the number of channels, where
// those of `max` grow by every event that suits a channel better than the others.
TEST(FixtureA, HistoryKeepsWeightsBounded) {
  const auto largest_weight = [](const char* tracker) {
    const FixtureCase test{tracker, Absorption::kAnalog, EmissionTally::kCollision};
    return estimate_radiance(fixture(), settings_for(test, Simd::kBest), 3'000'000)
        .walk.largest_weight;
  };
  EXPECT_LE(largest_weight("spectral:collision-probability=history-average"), 3.00001F);  // rounded
  EXPECT_GT(largest_weight("spectral:collision-probability=max"), 50.0F);
}

TEST(FixtureA, EveryEstimatorReproducesTheTransmittance) {
  std::vector<std::string> methods = {
      "ratio:roulette=0",          "ratio:rate-scale=0.7",          "ratio:rate-scale=3",
      "residual-ratio:roulette=0", "residual-ratio:rate-scale=0.7", "next-flight:roulette=0",
      "next-flight:rate-scale=0.7"};
  for (const MethodInfo& info : transmittance_infos()) {
    if (applies(info)) methods.emplace_back(info.name);
  }
  const double threshold = family_wise_threshold(1e-3, methods.size() * 6);
  for (const std::string& method : methods) {
    for (const char* tracker : {"delta", "spectral"}) {  // one channel, and all of one path
      WalkSettings settings = settings_for({tracker, Absorption::kAnalog, {}}, Simd::kBest);
      settings.transmittance = method;
      const bool shared = shares_paths(fixture(), settings);
      for (int turn = 0; turn < (shared ? 1 : kChannels); ++turn) {
        const Walker walker(fixture(), settings, shared ? Walker::kAllChannels : turn);
        ASSERT_EQ(walker.transmittance_channels(), shared ? kChannels : 1);
        std::array<RunningStatistics, kChannels> result;
        WalkStatistics statistics;
        FlightStream flights;
        const std::size_t paths = paths_for_transmittance(method);
        for (std::size_t done = 0; done < paths; done += kBatch) {
          const std::size_t count = std::min(kBatch, paths - done);
          walker.transmittance(
              repeat_ray(Vec3f(-1, 0, 0), Vec3f(1, 0, 0), 10, count, static_cast<uint32_t>(done)),
              flights, statistics);
          for (int slot = 0; slot < walker.transmittance_channels(); ++slot) {
            for (std::size_t i = 0; i < count; ++i) result[slot].add(flights.weight[slot][i]);
          }
        }
        for (int slot = 0; slot < walker.transmittance_channels(); ++slot) {
          const int channel = shared ? slot : turn;
          EXPECT_TRUE(check_mean(method + ", " + tracker, result[slot],
                                 std::exp(-FixtureA::kThickness[channel]),
                                 {.z = threshold, .absolute = 1e-7}));
        }
      }
    }
  }
}

}  // namespace
}  // namespace freepath::testing
