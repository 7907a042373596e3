// Every tracker and estimator against the quadrature of Fixture A, on every SIMD target.

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "freepath/transport/walker.h"
#include "tests/statistics.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

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
/// @param planted factors on what emission and scattering contribute, 1 unless an error is planted
double radiance(const FlightStream& flights, std::size_t i, int channel,
                const std::array<double, 2>& planted) {
  double ending = 0;
  if (flights.event[i] == Event::kEscape) ending = 1;
  if (flights.event[i] == Event::kScatter) {
    ending = planted[1] * FixtureA::scattered(flights.t[i], channel);
  }
  return planted[0] * flights.emitted[0][i] + flights.weight[0][i] * ending;
}

/// Enough paths for a standard error of 0.2 %: weights of both signs need more.
std::size_t paths_for(const Case& test) {
  return std::string(test.tracker).find("0.7") != std::string::npos ? 2'000'000 : 400'000;
}

RunningStatistics estimate_radiance(const Medium& medium, const WalkSettings& settings, int channel,
                                    std::size_t paths, WalkStatistics& statistics,
                                    const std::array<double, 2>& planted = {1, 1}) {
  const Walker walker(medium, settings, channel);
  FlightStream flights;
  RunningStatistics result;
  for (std::size_t done = 0; done < paths; done += kBatch) {
    const RayStream rays =
        repeat_ray(Vec3f(0, 0, 0), Vec3f(1, 0, 0), 10.0F, kBatch, static_cast<uint32_t>(done));
    walker.free_paths(rays, flights, statistics);
    for (std::size_t i = 0; i < kBatch; ++i) result.add(radiance(flights, i, channel, planted));
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
      const RunningStatistics result = estimate_radiance(fixture(), settings_for(test, Simd::kBest),
                                                         channel, paths_for(test), statistics);
      const std::string name =
          std::string(test.tracker) + ", channel " + std::to_string(channel) +
          (test.absorption == Absorption::kAnalog ? ", analog absorption"
                                                  : ", weighted absorption") +
          (test.emission == EmissionTally::kAnalog ? ", analog emission" : ", collision emission");
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
        estimate_radiance(fixture(), settings_for(test, simd), 1, 200'000, statistics);
    EXPECT_TRUE(check_mean(to_string(simd), result, FixtureA::kRadiance[1], {.absolute = 2e-6}));
  }
}

// The power of the tests above: 1 % more in the weight of emission or of scattering must fail, for
// every tracker whose weights are tame.
TEST(FixtureA, OnePercentInAWeightIsNoticed) {
  const double threshold = family_wise_threshold(1e-3, all_cases().size() * 3);
  for (const char* tracker : {"delta", "weighted-delta", "weighted-delta:rate-scale=2"}) {
    const Case test{tracker, Absorption::kAnalog, EmissionTally::kCollision};
    for (int mutation = 0; mutation < 2; ++mutation) {
      std::array<double, 2> planted = {1, 1};
      planted[mutation] = 1.01;
      double largest_z = 0;
      for (int channel = 0; channel < 3; ++channel) {
        WalkStatistics statistics;
        const RunningStatistics result =
            estimate_radiance(fixture(), settings_for(test, Simd::kBest), channel, paths_for(test),
                              statistics, planted);
        largest_z = std::max(largest_z, std::abs(z_score(result.mean(), result.standard_error(),
                                                         FixtureA::kRadiance[channel])));
      }
      EXPECT_GT(largest_z, threshold) << tracker << ", mutation " << mutation;
    }
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
      for (std::size_t done = 0; done < 1'000'000; done += kBatch) {
        walker.transmittance(
            repeat_ray(Vec3f(-1, 0, 0), Vec3f(1, 0, 0), 10, kBatch, static_cast<uint32_t>(done)),
            flights, statistics);
        for (std::size_t i = 0; i < kBatch; ++i) result.add(flights.weight[0][i]);
      }
      EXPECT_TRUE(check_mean(method, result, std::exp(-FixtureA::kThickness[channel]),
                             {.z = threshold, .absolute = 1e-7}));
    }
  }
}

}  // namespace
}  // namespace freepath::testing
