// Overlapping fields of different transforms and layouts against quadrature: transmittance, where
// flights end, in which events and components, and what emission they collect.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "freepath/base/error.h"
#include "tests/statistics.h"
#include "tests/transport/walk_fixtures.h"

namespace freepath::testing {
namespace {

/// Larger voxels, turned otherwise, mirrored, and partly beside the first field.
Matrix4d second_transform() {
  Matrix4d matrix;
  matrix.setScale(Vec3d(-0.13, 0.11, 0.09));
  matrix *= Matrix4d().rotate(Vec3d(-0.7, 0.2, 1.1));
  matrix *= Matrix4d().setTranslation(Vec3d(0.9, 0.2, -0.3));
  return matrix;
}

/// Two components that absorb, scatter and emit in different colours.
/// @param grey whether the extinction is the same in all channels
/// @param planted factor on the extinction, 1 unless an error is planted
std::vector<Component> overlapping(std::shared_ptr<Field> second, bool grey, float planted = 1) {
  std::vector<Component> components(2);
  components[0].density = lumpy_field(0);
  components[0].sigma_s = Rgb(0.8F, 0.5F, 0.3F) * planted;
  components[0].sigma_a = Rgb(0.2F, 0.5F, 0.7F) * planted;
  components[0].emission = Rgb(1, 2, 0.5F);
  components[0].phase = PhaseFunction::henyey_greenstein(0.8F);
  components[1].density = std::move(second);
  components[1].sigma_s = Rgb(0.4F, 0.9F, 0.7F) * planted;
  components[1].sigma_a = Rgb(0.6F, 0.1F, 0.3F) * planted;
  components[1].emission = Rgb(0.3F, 1, 4);
  components[1].phase = PhaseFunction::henyey_greenstein(-0.2F);
  if (!grey) {
    components[0].sigma_s *= Rgb(1, 0.5F, 0.25F);
    components[1].sigma_a *= Rgb(0.5F, 1.5F, 1);
  }
  return components;
}

/// Noise on a pedestal, so that minima decide some collisions.
std::shared_ptr<Field> second_field() {
  return make_field(
      Vec3i(-12, -9, -14), Vec3i(11, 10, 8),
      [](const Vec3i& p) { return 0.3F + 0.6F * hash_noise(p); }, second_transform());
}

/// Quadrature along a ray, for every channel; what was once asked for is kept. Of a field that
/// jumps it is good to 1e-5, of one that does not to 1e-6.
const std::array<RayIntegrals, kChannels>& exact(int ray, Interpolation interpolation, bool grey) {
  static std::map<std::tuple<int, bool, bool>, std::array<RayIntegrals, kChannels>> known;
  const bool nearest = interpolation == Interpolation::kNearest;
  const auto [found, added] = known.try_emplace({ray, nearest, grey});
  for (int channel = 0; added && channel < kChannels; ++channel) {
    const Medium medium(overlapping(second_field(), grey));
    const int steps = nearest ? 800'000 : 40'000;
    found->second[channel] =
        grey && channel > 0 ? found->second[0]
                            : integrate(medium, test_rays()[ray], interpolation, steps, channel);
  }
  return found->second;
}

const double kOverlapThreshold =
    family_wise_threshold(1e-3, 600);  // of all comparisons in this file
constexpr double kQuadrature = 1e-5;   // what quadrature may be off

// ---- Transmittance ----------------------------------------------------------------------------

struct TransmittanceCase {
  const char* estimator;
  Interpolation interpolation;
  std::size_t paths;
};

std::vector<TransmittanceCase> transmittance_cases() {
  std::vector<TransmittanceCase> cases;
  for (const Interpolation interpolation : kInterpolations) {
    cases.push_back({"delta", interpolation, 500'000});
    cases.push_back({"ratio", interpolation, 300'000});
    cases.push_back({"residual-ratio", interpolation, 300'000});
    cases.push_back({"next-flight", interpolation, 300'000});
    cases.push_back({"p-series", interpolation, 10'000});
    cases.push_back({"unbiased-ray-marching", interpolation, 10'000});
    if (interpolation != Interpolation::kStochastic) cases.push_back({"regular", interpolation, 1});
  }
  return cases;
}

/// The largest z of all channels along a ray.
double transmittance_z(const TransmittanceCase& test, int ray, float planted = 1) {
  const Medium medium(overlapping(second_field(), false, planted), 8);
  WalkSettings settings;
  settings.tracker = "spectral";
  settings.transmittance = test.estimator;
  settings.interpolation = test.interpolation;
  settings.seed = 21;
  const Walker walker(medium, settings);
  std::array<RunningStatistics, kChannels> results;
  FlightStream flights;
  WalkStatistics statistics;
  constexpr std::size_t kBatch = 20'000;
  for (std::size_t done = 0; done < test.paths; done += kBatch) {
    const std::size_t count = std::min(kBatch, test.paths - done);
    walker.transmittance(repeat_ray(test_rays()[ray], count, done), flights, statistics);
    for (std::size_t i = 0; i < count; ++i) {
      for (int channel = 0; channel < kChannels; ++channel) {
        results[channel].add(flights.weight[channel][i]);
      }
    }
  }
  double largest = 0;
  for (int channel = 0; channel < kChannels; ++channel) {
    const double expected = exact(ray, test.interpolation, false)[channel].transmittance();
    const double error = std::hypot(results[channel].standard_error(), kQuadrature * expected);
    const double z = (results[channel].mean() - expected) / error;
    largest = std::isnan(z) ? HUGE_VAL : std::max(largest, std::abs(z));
  }
  return largest;
}

std::string describe(const TransmittanceCase& test) {
  return std::string(test.estimator) + ", " + name_of(test.interpolation);
}

TEST(OverlappingTransmittance, AgreesWithQuadrature) {
  for (const TransmittanceCase& test : transmittance_cases()) {
    for (const int ray : {0, 2}) {
      EXPECT_LT(transmittance_z(test, ray), kOverlapThreshold) << describe(test);
    }
  }
}

// The power of the test above.
TEST(OverlappingTransmittance, OnePercentOfTheExtinctionIsNoticed) {
  for (const TransmittanceCase& test : transmittance_cases()) {
    if (test.paths > 1 && test.paths < 100'000) continue;
    EXPECT_GT(transmittance_z(test, 0, 1.01F), kOverlapThreshold) << describe(test);
  }
}

// ---- Free paths -------------------------------------------------------------------------------

constexpr int kLengthBins = 6;
/// Weights of flights that scatter in a component, are absorbed, escape, end in a part of the ray;
/// and the tally of emission.
enum TalliedQuantity {
  kTalliedScatterFirst,
  kTalliedScatterSecond,
  kTalliedAbsorb,
  kTalliedEscape,
  kTalliedEmitted,
  kTalliedBin,
  kTallied = kTalliedBin + kLengthBins
};

struct FlightCase {
  const char* tracker;
  Interpolation interpolation;
  bool grey;
  int channel;  ///< The one channel, or Walker::kAllChannels.
  std::size_t paths;
};

std::vector<FlightCase> flight_cases() {
  constexpr int kAll = Walker::kAllChannels;
  const auto nearest = Interpolation::kNearest;
  const auto trilinear = Interpolation::kTrilinear;
  const auto stochastic = Interpolation::kStochastic;
  return {{"delta", nearest, true, kAll, 600'000},
          {"delta", trilinear, true, kAll, 600'000},
          {"delta", stochastic, false, 1, 600'000},
          {"weighted-delta:rate-scale=0.8", trilinear, true, kAll, 900'000},
          {"decomposition", nearest, true, kAll, 600'000},
          {"decomposition", stochastic, true, kAll, 600'000},
          {"weighted-decomposition", stochastic, true, kAll, 600'000},
          {"spectral", nearest, false, kAll, 600'000},
          {"spectral", stochastic, false, kAll, 600'000},
          {"spectral-decomposition", trilinear, false, kAll, 600'000},
          {"hero-wavelength", stochastic, false, kAll, 600'000},
          {"multi-volume", nearest, true, kAll, 600'000},
          {"multi-volume", trilinear, false, 2, 1'200'000},
          {"multi-volume", stochastic, true, kAll, 600'000},
          {"regular", nearest, true, kAll, 100'000},
          {"regular", trilinear, true, kAll, 50'000}};
}

std::string describe(const FlightCase& test) {
  return std::string(test.tracker) + ", " + name_of(test.interpolation) +
         (test.grey ? ", grey" : ", chromatic");
}

using Tallies = std::array<std::array<Tally, kTallied>, kChannels>;
using ExpectedTallies = std::array<std::array<double, kTallied>, kChannels>;

int bin_of(double t, const TestRay& ray) {
  return std::clamp(static_cast<int>(kLengthBins * t / ray.t_max), 0, kLengthBins - 1);
}

Tallies fly(const std::vector<Component>& components, const FlightCase& test) {
  const Medium medium(components, 8);
  WalkSettings settings;
  settings.tracker = test.tracker;
  settings.interpolation = test.interpolation;
  settings.absorption = Absorption::kAnalog;
  settings.seed = 8;
  const Walker walker(medium, settings, test.channel);
  const TestRay ray = test_rays()[0];
  Tallies tallies;
  for_each_flight(walker, ray, test.paths, [&](const FlightStream& flights, std::size_t i) {
    const TalliedQuantity end = flights.event[i] == Event::kEscape   ? kTalliedEscape
                                : flights.event[i] == Event::kAbsorb ? kTalliedAbsorb
                                : flights.component[i] == 0          ? kTalliedScatterFirst
                                                                     : kTalliedScatterSecond;
    for (int slot = 0; slot < walker.channels(); ++slot) {
      auto& row = tallies[test.channel < 0 ? slot : test.channel];
      row[end].add(flights.weight[slot][i]);
      row[kTalliedEmitted].add(flights.emitted[slot][i]);
      if (end != kTalliedEscape)
        row[kTalliedBin + bin_of(flights.t[i], ray)].add(flights.weight[slot][i]);
    }
  });
  return tallies;
}

ExpectedTallies expect(const std::vector<Component>& components,
                       const std::array<RayIntegrals, kChannels>& integrals) {
  ExpectedTallies expected{};
  for (int channel = 0; channel < kChannels; ++channel) {
    const RayIntegrals& along = integrals[channel];
    auto& row = expected[channel];
    row[kTalliedEscape] = along.transmittance();
    for (int k = 0; k < 2; ++k) {
      const Component& component = components[k];
      row[k] = component.sigma_s[channel] * along.collided[k];
      const double absorbed = component.sigma_a[channel] * along.collided[k];
      row[kTalliedAbsorb] += absorbed;
      row[kTalliedEmitted] += absorbed * component.emission[channel];
    }
    for (int bin = 0; bin < kLengthBins; ++bin) {
      const auto passed = [&](int edge) {
        return std::exp(-along.depth_at(double(test_rays()[0].t_max) * edge / kLengthBins));
      };
      row[kTalliedBin + bin] = passed(bin) - passed(bin + 1);
    }
  }
  return expected;
}

/// The largest z of all quantities in the channels that are walked.
double largest_z(const Tallies& tallies, const ExpectedTallies& expected, const FlightCase& test) {
  double largest = 0;
  for (int channel = 0; channel < kChannels; ++channel) {
    if (test.channel >= 0 && channel != test.channel) continue;
    for (int q = 0; q < kTallied; ++q) {
      const Tally& tally = tallies[channel][q];
      const double error = tally.standard_error(test.paths);
      const double z =
          (tally.mean(test.paths) - expected[channel][q]) / std::hypot(error, kQuadrature);
      largest = std::isnan(z) ? HUGE_VAL : std::max(largest, std::abs(z));
    }
  }
  return largest;
}

/// @param planted factor on the extinction, 1 unless an error is planted
double flight_z(const FlightCase& test, float planted = 1) {
  const std::vector<Component> components = overlapping(second_field(), test.grey);
  return largest_z(fly(overlapping(second_field(), test.grey, planted), test),
                   expect(components, exact(0, test.interpolation, test.grey)), test);
}

TEST(OverlappingFreePaths, EndWhereAndHowQuadratureSays) {
  ASSERT_FALSE(Medium(overlapping(second_field(), true)).aligned());
  for (const FlightCase& test : flight_cases()) {
    EXPECT_LT(flight_z(test), kOverlapThreshold) << describe(test);
  }
}

// The power of the test above.
TEST(OverlappingFreePaths, OnePercentOfTheExtinctionIsNoticed) {
  for (const FlightCase& test : flight_cases()) {
    if (test.tracker == std::string_view("regular")) continue;  // fewer paths: it is slow
    EXPECT_GT(flight_z(test, 1.01F), kOverlapThreshold) << describe(test);
  }
}

// Padding parts the layouts of bricks, and changes nothing that can be seen.
TEST(OverlappingFreePaths, AnAlignedPairGivenAsUnalignedIsTheSame) {
  for (const Interpolation interpolation : kInterpolations) {
    const auto aligned = overlapping(lumpy_field(1), true);
    const auto padded = overlapping(lumpy_field(1, crooked_transform(), 13), true);
    ASSERT_TRUE(Medium(aligned).aligned());
    ASSERT_FALSE(Medium(padded).aligned());
    std::array<RayIntegrals, kChannels> integrals;
    integrals.fill(integrate(Medium(aligned), test_rays()[0], interpolation, 200'000));
    const ExpectedTallies expected = expect(aligned, integrals);
    for (const char* tracker : {"delta", "decomposition", "multi-volume"}) {
      const FlightCase test{tracker, interpolation, true, Walker::kAllChannels, 200'000};
      EXPECT_LT(largest_z(fly(aligned, test), expected, test), kOverlapThreshold) << describe(test);
      EXPECT_LT(largest_z(fly(padded, test), expected, test), kOverlapThreshold) << describe(test);
    }
  }
}

// ---- What can't be or must not matter ---------------------------------------------------------

TEST(OverlappingMedia, AreWalkedBitForBitAlikeByEveryTarget) {
  const Medium medium(overlapping(second_field(), true), 8);
  for (const Interpolation interpolation : kInterpolations) {
    for (const char* tracker : {"delta", "decomposition", "multi-volume"}) {
      FlightStream one_lane;
      for (const Simd simd : {Simd::kOneLane, Simd::kSse4, Simd::kAvx2, Simd::kAvx512}) {
        if (std::ranges::count(available_simd(), simd) == 0) continue;
        WalkSettings settings;
        settings.tracker = tracker;
        settings.interpolation = interpolation;
        settings.simd = simd;
        WalkStatistics statistics;
        FlightStream flights;
        Walker(medium, settings)
            .free_paths(repeat_ray(test_rays()[0], 5000, 0), flights, statistics);
        if (simd == Simd::kOneLane) one_lane = flights;
        EXPECT_EQ(one_lane.t, flights.t) << tracker << ", " << name_of(interpolation);
        EXPECT_EQ(one_lane.weight[1], flights.weight[1]) << tracker;
      }
    }
  }
}

TEST(OverlappingMedia, NoBoundIsBroken) {
  const Medium medium(overlapping(second_field(), true), 4);
  for (const Interpolation interpolation : kInterpolations) {
    for (const char* tracker : {"delta", "decomposition", "multi-volume"}) {
      WalkSettings settings;
      settings.tracker = tracker;
      settings.interpolation = interpolation;
      const Walker walker(medium, settings);
      WalkStatistics statistics;
      for (const TestRay& ray : test_rays()) {
        FlightStream flights;
        walker.free_paths(repeat_ray(ray, 20'000, 0), flights, statistics);
      }
      EXPECT_EQ(statistics.bound_violations, 0) << tracker << ", " << name_of(interpolation);
      EXPECT_EQ(statistics.negative_weights, 0) << tracker << ", " << name_of(interpolation);
    }
  }
}

TEST(OverlappingMedia, AreRefusedInClosedFormInOneSentence) {
  const Medium medium(overlapping(second_field(), true));
  WalkSettings settings;
  settings.tracker = "closed-form";
  settings.interpolation = Interpolation::kNearest;
  try {
    const Walker walker(medium, settings);
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "'closed-form' needs a homogeneous medium: grid 'test' and another differ in "
                 "transform or bounds; take 'regular', or a null-collision method");
  }
}

}  // namespace
}  // namespace freepath::testing
