// Media whose density a program computes.

#include "freepath/media/density_function.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "freepath/base/error.h"
#include "freepath/transport/sampling.h"
#include "tests/statistics.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr std::size_t kFunctionRays = 200'000;

/// 0.5 + 0.5 sin²(pi x) in [0,2] × [-1,1]²: along x its integral over [0,2] is 1.5.
DensityFunction wave() {
  DensityFunction function;
  function.evaluate = [](std::span<const Vec3f> positions, std::span<float> densities) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const float sine = std::sin(std::numbers::pi_v<float> * positions[i].x);
      densities[i] = 0.5F + 0.5F * sine * sine;
    }
  };
  // sin² has its extremes at multiples of a half.
  function.bounds = [](const Box3f& part) -> DensityFunction::Bounds {
    float low = 1;
    float high = 0;
    for (int i = 0; i <= 64; ++i) {
      const float x = part.min.x + (part.max.x - part.min.x) * static_cast<float>(i) / 64;
      const float sine = std::sin(std::numbers::pi_v<float> * x);
      low = std::min(low, 0.5F + 0.5F * sine * sine);
      high = std::max(high, 0.5F + 0.5F * sine * sine);
    }
    return {std::max(low - 0.01F, 0.0F), high + 0.01F};
  };
  function.box = Box3f(Vec3f(0, -1, -1), Vec3f(2, 1, 1));
  function.cells = Vec3i(8, 1, 1);
  return function;
}

Medium wave_medium(const Rgb& sigma_a, const Rgb& sigma_s) {
  return Medium(
      {{.density = make_function_field("wave", wave()), .sigma_a = sigma_a, .sigma_s = sigma_s}});
}

RayStream rays_through(std::size_t count) {
  return repeat_ray(Vec3f(-1, 0.3F, 0.2F), Vec3f(1, 0, 0), std::numeric_limits<float>::infinity(),
                    count);
}

/// Methods that go from voxel to voxel refuse computed densities. @return whether this one has to
bool refuses(const Medium& medium, const WalkSettings& settings, std::string_view name) {
  for (const char* reference :
       {"closed-form", "regular", "ray-marching", "p-series", "unbiased-ray-marching"}) {
    if (name != reference) continue;
    EXPECT_THROW(Walker(medium, settings, 0), Error) << name;
    return true;
  }
  return false;
}

TEST(DensityFunction, EveryTrackerEscapesAsOftenAsItsIntegralSays) {
  const Rgb sigma_a(0.2F, 0.1F, 0.5F);
  const Rgb sigma_s(0.8F, 0.4F, 0.7F);
  const Medium medium = wave_medium(sigma_a, sigma_s);
  const double threshold = family_wise_threshold(1e-3, tracker_infos().size() * 3);
  for (const MethodInfo& info : tracker_infos()) {
    WalkSettings settings;
    settings.tracker = info.name;
    settings.absorption = Absorption::kAnalog;
    settings.interpolation = Interpolation::kNearest;
    if (refuses(medium, settings, info.name)) continue;
    const bool shared = shares_paths(medium, settings);
    for (int turn = 0; turn < (shared ? 1 : kChannels); ++turn) {
      const Walker walker(medium, settings, shared ? Walker::kAllChannels : turn);
      FlightStream flights;
      WalkStatistics statistics;
      walker.free_paths(rays_through(kFunctionRays), flights, statistics);
      EXPECT_EQ(statistics.bound_violations, 0U) << info.name;
      for (int slot = 0; slot < walker.channels(); ++slot) {
        RunningStatistics escaped;
        for (std::size_t i = 0; i < kFunctionRays; ++i) {
          escaped.add(flights.event[i] == Event::kEscape ? flights.weight[slot][i] : 0.0);
        }
        const int channel = shared ? slot : turn;
        EXPECT_TRUE(check_mean(std::string(info.name), escaped,
                               std::exp(-1.5 * (sigma_a + sigma_s)[channel]), {.z = threshold}));
      }
    }
  }
}

TEST(DensityFunction, EveryEstimatorFindsItsTransmittance) {
  const Medium medium = wave_medium(Rgb(0.3F), Rgb(0.7F));
  for (const MethodInfo& info : transmittance_infos()) {
    WalkSettings settings;
    settings.transmittance = info.name;
    settings.interpolation = Interpolation::kNearest;
    if (refuses(medium, settings, info.name)) continue;
    const FlightStream flights =
        estimate_transmittance(medium, rays_through(kFunctionRays), settings);
    RunningStatistics transmittance;
    for (std::size_t i = 0; i < kFunctionRays; ++i) transmittance.add(flights.weight[0][i]);
    EXPECT_TRUE(check_mean(std::string(info.name), transmittance, std::exp(-1.5), {}));
  }
}

TEST(DensityFunction, AutoChoosesATrackerAndSamplesWithIt) {
  const Medium medium = wave_medium(Rgb(0.0F), Rgb(1.0F));
  WalkSettings settings;
  settings.tracker = "auto";
  WalkStatistics statistics;
  const FlightStream flights =
      sample_free_paths(medium, rays_through(1000), settings, Walker::kAllChannels, &statistics);
  EXPECT_EQ(flights.size(), 1000U);
  EXPECT_GT(statistics.control_collisions, 0U);  // the minima are most of the maxima
}

TEST(DensityFunction, ValuesThatAreNoDensitiesAreErrorsThatNameThePlace) {
  for (const float value :
       {-1.0F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    DensityFunction function = wave();
    function.evaluate = [value](std::span<const Vec3f> /*positions*/, std::span<float> densities) {
      std::fill(densities.begin(), densities.end(), value);
    };
    const Medium medium({{.density = make_function_field("broken", function)}});
    try {
      sample_free_paths(medium, rays_through(100));
      FAIL() << value;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("'broken'"), std::string::npos) << error.what();
    }
  }
}

TEST(DensityFunction, BoundsBelowTheDensityAreCounted) {
  DensityFunction function = wave();
  function.bounds = [](const Box3f& /*part*/) { return DensityFunction::Bounds{0, 0.6F}; };
  const Medium medium({{.density = make_function_field("loose", function)}});
  WalkStatistics statistics;
  sample_free_paths(medium, rays_through(1000), {}, Walker::kAllChannels, &statistics);
  EXPECT_GT(statistics.bound_violations, 0U);
}

TEST(DensityFunction, RefusesWhatCanNotBeAMedium) {
  DensityFunction none = wave();
  none.bounds = nullptr;
  EXPECT_THROW(make_function_field("none", none), Error);
  DensityFunction flat = wave();
  flat.box.max.y = flat.box.min.y;
  EXPECT_THROW(make_function_field("flat", flat), Error);
  DensityFunction many = wave();
  many.cells.x = 5000;
  EXPECT_THROW(make_function_field("many", many), Error);
  DensityFunction upside_down = wave();
  upside_down.bounds = [](const Box3f& /*part*/) { return DensityFunction::Bounds{1, 0.5F}; };
  EXPECT_THROW(Medium({{.density = make_function_field("upside down", upside_down)}}), Error);
}

}  // namespace
}  // namespace freepath::testing
