// Every transmittance estimator against quadrature, for every interpolation and SIMD target.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "tests/statistics.h"
#include "tests/transport/walk_fixtures.h"

namespace freepath::testing {
namespace {

/// One of the rays, how thick the medium is along it, and its super-voxels.
struct Thickness {
  double depth;
  int ray;
  int super_voxel;
};

constexpr std::array<Thickness, 3> kThicknesses = {{{0.5, 0, 16}, {3, 1, 8}, {10, 2, 4}}};

/// An estimator, and how many paths it gets at each thickness. The first is what it takes to see 1
/// % in the extinction at seven standard errors, (7 σ / (0.01 depth T))², with a measured σ.
struct Estimator {
  const char* name;
  std::array<std::size_t, 3> paths;
};

constexpr Estimator kEstimators[] = {
    {"delta", {900'000, 400'000, 1'000'000}},
    {"ratio", {700'000, 300'000, 300'000}},
    {"ratio:roulette=0", {700'000, 300'000, 200'000}},
    {"ratio:rate-scale=0.7", {900'000, 400'000, 400'000}},
    {"ratio:rate-scale=3", {250'000, 100'000, 100'000}},
};

/// Family of all comparisons in this file.
const double kTransmittanceThreshold = family_wise_threshold(1e-3, 150);

/// Optical depth of unit cross section, by quadrature of what the interpolation means.
double unit_depth(int ray, Interpolation interpolation) {
  static const auto kDepths = [] {
    std::array<std::array<double, 2>, 3> depths;
    const auto field = lumpy_field();
    for (int i = 0; i < 3; ++i) {
      const TestRay line = test_rays()[i];
      for (const bool nearest : {false, true}) {
        depths[i][nearest ? 1 : 0] =
            optical_depth(*field, Vec3d(line.origin), Vec3d(line.direction), line.t_max,
                          nearest ? Interpolation::kNearest : Interpolation::kTrilinear);
      }
    }
    return depths;
  }();
  return kDepths[ray][interpolation == Interpolation::kNearest ? 1 : 0];
}

/// Compares one estimator with exp(-depth).
/// @param planted factor on the extinction, 1 unless an error is planted
::testing::AssertionResult agrees(const Estimator& estimator, const Thickness& thickness,
                                  Interpolation interpolation, Simd simd, std::size_t paths,
                                  double planted = 1) {
  const TestRay ray = test_rays()[thickness.ray];
  const double depth = unit_depth(thickness.ray, interpolation);
  Component component;
  component.density = lumpy_field();
  component.sigma_s = Rgb(static_cast<float>(thickness.depth / depth * planted));
  const Medium medium({component}, thickness.super_voxel);
  WalkSettings settings;
  settings.transmittance = estimator.name;
  settings.interpolation = interpolation;
  settings.simd = simd;
  settings.seed = 5;
  const Walker walker(medium, settings);
  RunningStatistics result;
  WalkStatistics statistics;
  FlightStream flights;
  constexpr std::size_t kBatch = 20'000;
  for (std::size_t done = 0; done < paths; done += kBatch) {
    const std::size_t count = std::min(kBatch, paths - done);
    walker.transmittance(repeat_ray(ray, count, done), flights, statistics);
    for (std::size_t i = 0; i < count; ++i) result.add(flights.weight[0][i]);
  }
  const std::string name = std::string(estimator.name) + ", " + name_of(interpolation) + ", " +
                           std::string(to_string(simd)) + ", depth " +
                           std::to_string(thickness.depth);
  const double expected = std::exp(-thickness.depth);
  // The quadrature of a field that jumps is good to 1e-5.
  return check_mean(name, result, expected,
                    {.z = kTransmittanceThreshold, .absolute = 2e-5 * expected});
}

TEST(Transmittance, EveryEstimatorAgreesWithQuadrature) {
  for (const Estimator& estimator : kEstimators) {
    for (const Interpolation interpolation : kInterpolations) {
      for (std::size_t i = 0; i < kThicknesses.size(); ++i) {
        EXPECT_TRUE(
            agrees(estimator, kThicknesses[i], interpolation, Simd::kBest, estimator.paths[i]));
      }
    }
  }
}

TEST(Transmittance, EveryTargetAgreesWithQuadrature) {
  for (const Simd simd : available_simd()) {
    for (const Estimator& estimator : kEstimators) {
      for (const Interpolation interpolation : kInterpolations) {
        EXPECT_TRUE(agrees(estimator, kThicknesses[1], interpolation, simd, 40'000));
      }
    }
  }
}

// The power of the tests above.
TEST(Transmittance, OnePercentOfTheExtinctionIsNoticed) {
  for (const Estimator& estimator : kEstimators) {
    for (const Interpolation interpolation : kInterpolations) {
      const auto result =
          agrees(estimator, kThicknesses[0], interpolation, Simd::kBest, estimator.paths[0], 1.01);
      EXPECT_FALSE(result) << result.message();
    }
  }
}

/// Every unbiased estimator, without roulette, which looks at the size of weights.
std::vector<std::string> estimators_without_roulette() {
  std::vector<std::string> names;
  for (const MethodInfo& info : transmittance_infos()) {
    const bool plays = std::any_of(info.options.begin(), info.options.end(),
                                   [](const auto& option) { return option.name == "roulette"; });
    if (info.name == "closed-form" || info.biased) continue;  // can't walk noise
    names.push_back(std::string(info.name) + (plays ? ":roulette=0" : ""));
  }
  return names;
}

// Powers of two leave every digit as it is.
TEST(Transmittance, IsMultipliedByTheWeightsThatRaysBring) {
  constexpr std::array<float, 3> kBrought = {4, -0.5F, 0.25F};
  constexpr std::size_t kRays = 500;
  Component component;
  component.density = lumpy_field();
  component.sigma_s = Rgb(0.5F, 1.5F, 4.0F);
  const Medium medium({component});
  const RayStream fresh = repeat_ray(test_rays()[0], kRays, 0);
  RayStream weighted = fresh;
  weighted.set_weighted(true);
  for (int channel = 0; channel < 3; ++channel) {
    std::fill_n(weighted.weight[channel].begin(), kRays, kBrought[channel]);
    std::fill_n(weighted.density[channel].begin(), kRays, 1.0F);
  }
  for (const std::string& name : estimators_without_roulette()) {
    WalkSettings settings;
    settings.tracker = "spectral";
    settings.transmittance = name;
    settings.interpolation = Interpolation::kNearest;
    const Walker walker(medium, settings);
    FlightStream alone;
    FlightStream together;
    WalkStatistics statistics;
    walker.transmittance(fresh, alone, statistics);
    walker.transmittance(weighted, together, statistics);
    std::size_t others = 0;
    for (int channel = 0; channel < 3; ++channel) {
      for (std::size_t i = 0; i < kRays; ++i) {
        const float expected = kBrought[channel] * alone.weight[channel][i];
        others += together.weight[channel][i] != expected ? 1 : 0;
      }
    }
    EXPECT_EQ(others, 0U) << name;
  }
}

}  // namespace
}  // namespace freepath::testing
