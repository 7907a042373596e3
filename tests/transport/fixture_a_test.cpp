// Every tracker and estimator against the quadrature of Fixture A, on every SIMD target.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "freepath/transport/walker.h"
#include "tests/statistics.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr std::size_t kPaths = 1'000'000;
constexpr std::size_t kBatch = 100'000;

struct Case {
  const char* tracker;
  Absorption absorption;
  EmissionTally emission;
};

const Medium& fixture() {
  static const Medium kMedium = FixtureA::medium();
  return kMedium;
}

WalkSettings settings_for(const Case& test, Simd simd) {
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
double radiance(const FlightStream& flights, std::size_t i, int channel) {
  double ending = 0;
  if (flights.event[i] == Event::kEscape) ending = 1;
  if (flights.event[i] == Event::kScatter) ending = FixtureA::scattered(flights.t[i], channel);
  return flights.emitted[0][i] + flights.weight[0][i] * ending;
}

RunningStatistics estimate_radiance(const Medium& medium, const WalkSettings& settings,
                                    int channel, std::size_t paths, WalkStatistics& statistics) {
  const Walker walker(medium, settings, channel);
  FlightStream flights;
  WalkScratch scratch;
  RunningStatistics result;
  for (std::size_t done = 0; done < paths; done += kBatch) {
    const RayStream rays = repeat_ray(Vec3f(0, 0, 0), Vec3f(1, 0, 0), 10.0F, kBatch,
                                      static_cast<uint32_t>(done));
    walker.free_paths(rays, flights, scratch, statistics);
    for (std::size_t i = 0; i < kBatch; ++i) result.add(radiance(flights, i, channel));
  }
  return result;
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const char* tracker : {"delta", "weighted-delta", "weighted-delta:rate-scale=0.7",
                              "weighted-delta:rate-scale=2"}) {
    for (const Absorption absorption : {Absorption::kAnalog, Absorption::kWeighted}) {
      for (const EmissionTally emission : {EmissionTally::kCollision, EmissionTally::kAnalog}) {
        cases.push_back({tracker, absorption, emission});
      }
    }
  }
  return cases;
}

TEST(FixtureA, EveryTrackerReproducesTheRadiance) {
  const std::vector<Case> cases = all_cases();
  const double threshold = family_wise_threshold(1e-3, cases.size() * 3);
  for (const Case& test : cases) {
    for (int channel = 0; channel < 3; ++channel) {
      WalkStatistics statistics;
      const RunningStatistics result = estimate_radiance(
          fixture(), settings_for(test, Simd::kBest), channel, kPaths, statistics);
      const std::string name = std::string(test.tracker) + ", channel " + std::to_string(channel) +
                               (test.absorption == Absorption::kAnalog ? ", analog absorption"
                                                                       : ", weighted absorption") +
                               (test.emission == EmissionTally::kAnalog ? ", analog emission"
                                                                        : ", collision emission");
      EXPECT_TRUE(check_mean(name, result, FixtureA::kRadiance[channel],
                             {.z = threshold, .absolute = 2e-6, .largest_relative_error = 0.002}));
      EXPECT_EQ(statistics.bound_violations, 0U) << name;
      EXPECT_EQ(statistics.tentative_collisions,
                statistics.null_collisions + statistics.real_collisions);
    }
  }
}

TEST(FixtureA, EveryTargetAgrees) {
  const Case test{"weighted-delta:rate-scale=0.7", Absorption::kWeighted,
                  EmissionTally::kCollision};
  for (const Simd simd : available_simd()) {
    WalkStatistics statistics;
    const RunningStatistics result =
        estimate_radiance(fixture(), settings_for(test, simd), 1, kPaths / 5, statistics);
    EXPECT_TRUE(check_mean(to_string(simd), result, FixtureA::kRadiance[1], {.absolute = 2e-6}));
  }
}

// The power of the tests above: coefficients that are 1 % off, with all else equal, must fail.
TEST(FixtureA, OnePercentOffIsNoticed) {
  const Case test{"delta", Absorption::kAnalog, EmissionTally::kCollision};
  for (int wrong = 0; wrong < 2; ++wrong) {
    std::vector<Component> components = fixture().components();
    for (Component& component : components) {
      if (wrong == 0) component.sigma_a *= 1.01F;
      if (wrong == 1) component.sigma_s *= 1.01F;
    }
    const Medium medium(components);
    double largest_z = 0;
    for (int channel = 0; channel < 3; ++channel) {
      WalkStatistics statistics;
      const RunningStatistics result = estimate_radiance(
          medium, settings_for(test, Simd::kBest), channel, kPaths, statistics);
      largest_z = std::max(largest_z, std::abs(z_score(result.mean(), result.standard_error(),
                                                       FixtureA::kRadiance[channel])));
    }
    EXPECT_GT(largest_z, family_wise_threshold(1e-3, 48)) << "mutation " << wrong;
  }
}

TEST(FixtureA, EveryEstimatorReproducesTheTransmittance) {
  const std::vector<std::string> methods = {"delta", "ratio", "ratio:roulette=0",
                                            "ratio:rate-scale=0.7", "ratio:rate-scale=3"};
  const double threshold = family_wise_threshold(1e-3, methods.size() * 3);
  for (const std::string& method : methods) {
    for (int channel = 0; channel < 3; ++channel) {
      WalkSettings settings = settings_for({"delta", Absorption::kAnalog, {}}, Simd::kBest);
      settings.transmittance = method;
      const Walker walker(fixture(), settings, channel);
      RunningStatistics result;
      WalkStatistics statistics;
      FlightStream flights;
      WalkScratch scratch;
      for (std::size_t done = 0; done < kPaths; done += kBatch) {
        walker.transmittance(repeat_ray(Vec3f(-1, 0, 0), Vec3f(1, 0, 0), 10, kBatch,
                                        static_cast<uint32_t>(done)),
                             flights, scratch, statistics);
        for (std::size_t i = 0; i < kBatch; ++i) result.add(flights.weight[0][i]);
      }
      EXPECT_TRUE(check_mean(method, result, std::exp(-FixtureA::kThickness[channel]),
                             {.z = threshold, .absolute = 1e-7}));
    }
  }
}

}  // namespace
}  // namespace freepath::testing
