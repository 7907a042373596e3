// The methods that are no null-collision walks: against closed forms and quadrature, what they
// refuse, and what they count. Fixture A and the free-path tests run them too.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "freepath/tracking/reference/cubic_depth.h"
#include "tests/statistics.h"
#include "tests/transport/extremes.h"

namespace freepath::testing {
namespace {

struct Flown {
  FlightStream flights;
  WalkStatistics statistics;
};

WalkSettings settings_of(const std::string& tracker, const std::string& transmittance,
                         Interpolation interpolation) {
  WalkSettings settings;
  settings.tracker = tracker;
  settings.transmittance = transmittance;
  settings.interpolation = interpolation;
  return settings;
}

Flown fly(const Medium& medium, const std::string& tracker, Interpolation interpolation,
          const RayStream& rays) {
  Flown flown;
  Walker(medium, settings_of(tracker, "ratio", interpolation))
      .free_paths(rays, flown.flights, flown.statistics);
  return flown;
}

Flown transmit(const Medium& medium, const std::string& method, Interpolation interpolation,
               const RayStream& rays) {
  Flown flown;
  Walker(medium, settings_of("spectral", method, interpolation))
      .transmittance(rays, flown.flights, flown.statistics);
  return flown;
}

// ---- Closed form ------------------------------------------------------------------------------

constexpr float kSigma = 0.15F;

/// Across the box of 24 along x.
RayStream rays_across(std::size_t count) {
  return repeat_ray(Vec3f(-50, 0.1F, 0.2F), Vec3f(1, 0, 0), kInfinity, count);
}

TEST(ClosedForm, FreePathsAreTheLogarithmOfTheFirstNumber) {
  constexpr std::size_t kPaths = 2000;
  const Medium medium = medium_of(box_field(), kSigma);
  const Flown flown = fly(medium, "closed-form", Interpolation::kNearest, rays_across(kPaths));
  for (std::size_t i = 0; i < kPaths; ++i) {
    const double path = RandomStream(0, 7, uint32_t(i), 0).exponential() / kSigma;
    const bool collides = path < 24;
    EXPECT_EQ(flown.flights.event[i], collides ? Event::kScatter : Event::kEscape) << path;
    EXPECT_NEAR(flown.flights.t[i], 37.5 + std::min(path, 24.0), 1e-5) << path;
    EXPECT_NEAR(flown.flights.weight[0][i], collides ? 0.75 : 1, 1e-6);  // the albedo
    EXPECT_NEAR(flown.flights.emitted[0][i], collides ? 0.25 : 0, 1e-6);
  }
  EXPECT_EQ(flown.statistics.lookups, 0U);
}

TEST(ClosedForm, RegularTrackingDrawsTheSameFlights) {
  constexpr std::size_t kPaths = 2000;
  const Medium medium = medium_of(box_field(), kSigma);
  const Flown a = fly(medium, "closed-form", Interpolation::kNearest, rays_across(kPaths));
  const Flown b = fly(medium, "regular", Interpolation::kNearest, rays_across(kPaths));
  for (std::size_t i = 0; i < kPaths; ++i) {
    EXPECT_EQ(a.flights.event[i], b.flights.event[i]);
    EXPECT_NEAR(a.flights.t[i], b.flights.t[i], 1e-5);
  }
}

TEST(ClosedForm, TransmittanceIsTheExponentialInEveryChannel) {
  Component component;
  component.density = box_field();
  component.sigma_a = Rgb(0.1F, 0.02F, 0);
  component.sigma_s = Rgb(0, 0.03F, 0.3F);
  const Medium medium({component});
  for (const char* method : {"closed-form", "regular"}) {
    const Flown flown = transmit(medium, method, Interpolation::kNearest, rays_across(3));
    for (int channel = 0; channel < kChannels; ++channel) {
      const double sigma_t = double(component.sigma_a[channel]) + component.sigma_s[channel];
      EXPECT_NEAR(flown.flights.weight[channel][1] / std::exp(-24 * sigma_t), 1, 2e-6) << method;
    }
  }
}

// ---- What is refused --------------------------------------------------------------------------

std::string refusal(const Medium& medium, const WalkSettings& settings) {
  try {
    const Walker walker(medium, settings);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ReferenceMethods, ClosedFormNamesTheVoxelThatDiffers) {
  const Medium medium =
      medium_of(make_field(Vec3i(-4), Vec3i(3),
                           [](const Vec3i& p) { return p == Vec3i(3, -2, 1) ? 0.75F : 0.5F; }),
                1);
  for (const bool tracker : {true, false}) {
    const std::string text =
        refusal(medium, settings_of(tracker ? "closed-form" : "delta",
                                    tracker ? "ratio" : "closed-form", Interpolation::kNearest));
    EXPECT_NE(text.find("0.75 at (3, -2, 1)"), std::string::npos) << text;
  }
}

TEST(ReferenceMethods, ClosedFormWantsNoSoftBorder) {
  const Medium medium = medium_of(box_field(), 1);
  EXPECT_EQ(refusal(medium, settings_of("closed-form", "ratio", Interpolation::kNearest)), "");
  for (const Interpolation soft : {Interpolation::kTrilinear, Interpolation::kStochastic}) {
    const std::string text = refusal(medium, settings_of("closed-form", "ratio", soft));
    EXPECT_NE(text.find("nearest"), std::string::npos) << text;
  }
}

TEST(ReferenceMethods, StochasticInterpolationIsRefusedInsideAnExponential) {
  const Medium medium = medium_of(box_field(), 1);
  const char* const refused[][2] = {
      {"regular", "ratio"}, {"ray-marching", "ratio"}, {"delta", "regular"}};
  for (const auto& [tracker, transmittance] : refused) {
    EXPECT_EQ(refusal(medium, settings_of(tracker, transmittance, Interpolation::kTrilinear)), "");
    const std::string text =
        refusal(medium, settings_of(tracker, transmittance, Interpolation::kStochastic));
    EXPECT_NE(text.find("exponential"), std::string::npos) << text;
  }
  for (const char* fine : {"p-series", "unbiased-ray-marching"}) {
    EXPECT_EQ(refusal(medium, settings_of("delta", fine, Interpolation::kStochastic)), "");
  }
}

// ---- Regular tracking -------------------------------------------------------------------------

// One voxel of density 2 is a tent with the filter: 2 (1-|x|)(1-|y|)(1-|z|).
TEST(Regular, IntegratesTheTentOfAVoxelInClosedForm) {
  const auto field = make_field(Vec3i(7, 8, -9), Vec3i(7, 8, -9), [](auto&) { return 2.0F; });
  const Medium medium = medium_of(field, 0.5F);
  const Vec3f centre(7, 8, -9);
  const Vec3f x(1, 0, 0);
  const Vec3f diagonal = Vec3f(1, -1, 1).normalized();
  const struct {
    Vec3f origin, direction;
    double depth;
  } lines[] = {{centre - x * 9.0F, x, 1},
               {centre - x * 9.0F + Vec3f(0, 0.25F, 0), x, 0.75},
               {centre - x * 9.0F + Vec3f(0, 0.25F, -0.5F), x, 0.375},
               {centre, x, 0.5},
               // ∫ (1 - |t|/√3)³ dt from -√3 to √3
               {centre - diagonal * 9.0F, diagonal, std::sqrt(3.0) / 2}};
  for (const auto& [origin, direction, depth] : lines) {
    const Flown flown = transmit(medium, "regular", Interpolation::kTrilinear,
                                 repeat_ray(origin, direction, kInfinity, 1));
    EXPECT_NEAR(flown.flights.weight[0][0], std::exp(-depth), 1e-6) << depth;
  }
}

/// The crooked noise, scaled to an optical depth along a ray.
Medium noise_of_depth(double depth, const TestRay& ray, Interpolation interpolation) {
  const auto field = lumpy_field();
  Component component;
  component.density = field;
  component.sigma_s =
      Rgb(static_cast<float>(depth / optical_depth(*field, Vec3d(ray.origin), Vec3d(ray.direction),
                                                   ray.t_max, interpolation)));
  return Medium({component}, 8);
}

TEST(Regular, TransmittanceAgreesWithQuadrature) {
  for (const Interpolation interpolation : {Interpolation::kNearest, Interpolation::kTrilinear}) {
    // Quadrature of a field that jumps is good to 1e-5.
    const double tolerance = interpolation == Interpolation::kNearest ? 5e-5 : 1e-5;
    for (const TestRay& ray : test_rays()) {
      const Medium medium = noise_of_depth(2, ray, interpolation);
      const Flown flown = transmit(medium, "regular", interpolation, repeat_ray(ray, 1, 0));
      EXPECT_NEAR(-std::log(flown.flights.weight[0][0]), 2, 2 * tolerance);
    }
  }
}

TEST(Regular, CubicsAreInvertedWhereverTheyVanish) {
  const Cubic cubics[] = {{1, 0, 0, 0},       {0, 1, 0, 0},     {0, 0, 0, 1},  {1, -1, 0, 0},
                          {1, -2, 1, 0},      {1, -3, 3, -1},   {0, 0, 1, -1}, {0.25, -1, 1, 0},
                          {1e-12, 0, 0, 1e8}, {1e8, 1e-9, 0, 0}};
  for (const Cubic& cubic : cubics) {
    const double total = integral_to(cubic, 1);
    for (const double share : {0.0, 1e-12, 1e-3, 0.5, 0.999, 1 - 1e-12, 1.0}) {
      const double s = invert_integral(cubic, share * total);
      EXPECT_GE(s, 0);
      EXPECT_LE(s, 1);
      EXPECT_NEAR(integral_to(cubic, s), share * total, 1e-13 * total) << share;
    }
  }
}

TEST(Regular, ReadsEachVoxelOnTheWayOnce) {
  std::vector<Component> components(3);
  for (int k = 0; k < 3; ++k) {
    components[k].density = make_field(Vec3i(0), Vec3i(9, 0, 0), [](auto&) { return 1.0F; });
    components[k].sigma_s = Rgb(k == 2 ? 0.0F : 1.0F);  // the third is nothing to anyone
  }
  const Medium medium(components, 4);
  const Flown flown = transmit(medium, "regular", Interpolation::kNearest,
                               repeat_ray(Vec3f(-9, 0, 0), Vec3f(1, 0, 0), kInfinity, 5));
  EXPECT_EQ(flown.flights.lookups[3], 2U * 10);
  EXPECT_EQ(flown.statistics.lookups, 5U * 2 * 10);
  EXPECT_EQ(flown.statistics.rays, 5U);
  EXPECT_GT(flown.statistics.super_voxel_steps, 0U);
}

// ---- Ray marching -----------------------------------------------------------------------------

/// z of the share of rays that pass, against the transmittance.
double marching_error(const char* tracker) {
  constexpr std::size_t kPaths = 400'000;
  const TestRay ray = test_rays()[0];
  const Medium medium = noise_of_depth(2, ray, Interpolation::kTrilinear);
  const Flown flown = fly(medium, tracker, Interpolation::kTrilinear, repeat_ray(ray, kPaths, 0));
  RunningStatistics passed;
  for (std::size_t i = 0; i < kPaths; ++i) {
    passed.add(flown.flights.event[i] == Event::kEscape ? 1 : 0);
  }
  return z_score(passed.mean(), passed.standard_error(), std::exp(-2.0));
}

// More light passes, by Jensen's inequality: an exponential is convex.
TEST(RayMarching, IsBiasedForCoarseStepsAloneAndLetsMorePass) {
  EXPECT_GT(marching_error("ray-marching:step=1"), 6);
  EXPECT_LT(std::abs(marching_error("ray-marching:step=0.02")), 4);
}

TEST(RayMarching, SaysThatItIsBiased) {
  for (const MethodInfo& info : tracker_infos()) {
    EXPECT_EQ(info.biased, info.name == "ray-marching") << info.name;
  }
  for (const MethodInfo& info : transmittance_infos()) EXPECT_FALSE(info.biased) << info.name;
}

// ---- Power series -----------------------------------------------------------------------------

struct Series {
  const char* name;
  std::array<std::size_t, 3> paths;  ///< At each of kDepths.
  std::array<bool, 3> sharp;         ///< Whether they suffice to see 1 % in the extinction.
};

constexpr std::array<double, 3> kDepths = {1e-3, 1, 10};

// At a depth of 1e-3 the first order of the default p-series is left to roulette; at 10 its other
// roulette costs as much variance as it saves look-ups.
constexpr Series kSeries[] = {
    {"p-series", {100'000, 100'000, 100'000}, {false, true, false}},
    {"p-series:coverage=0.9999,roulette=0", {300'000, 100'000, 200'000}, {true, true, true}},
    {"p-series:rate-scale=0.7", {100'000, 400'000, 100'000}, {false, true, false}},
    {"unbiased-ray-marching", {400'000, 100'000, 100'000}, {true, true, true}},
    {"unbiased-ray-marching:order-zero=0,points-scale=2",
     {100'000, 100'000, 100'000},
     {true, true, false}},
};

/// @param planted factor on the extinction, 1 unless an error is planted
::testing::AssertionResult agrees(const Series& series, std::size_t depth_number,
                                  Interpolation interpolation, double planted = 1) {
  const TestRay ray = test_rays()[depth_number];
  const double depth = kDepths[depth_number];
  const Medium medium =
      noise_of_depth(planted * depth, ray,
                     interpolation == Interpolation::kNearest ? Interpolation::kNearest
                                                              : Interpolation::kTrilinear);
  const std::size_t paths = series.paths[depth_number];
  const Flown flown = transmit(medium, series.name, interpolation, repeat_ray(ray, paths, 0));
  RunningStatistics result;
  for (std::size_t i = 0; i < paths; ++i) result.add(flown.flights.weight[0][i]);
  const double expected = std::exp(-depth);
  return check_mean(
      std::string(series.name) + ", " + name_of(interpolation) + ", depth " + std::to_string(depth),
      result, expected,
      {.z = family_wise_threshold(1e-3, 100), .absolute = 3e-5 * depth * expected});
}

TEST(PowerSeries, AgreeWithQuadratureAtAnyDepth) {
  for (const Series& series : kSeries) {
    for (const Interpolation interpolation : kInterpolations) {
      for (std::size_t depth = 0; depth < kDepths.size(); ++depth) {
        EXPECT_TRUE(agrees(series, depth, interpolation));
      }
    }
  }
}

// The power of the test above.
TEST(PowerSeries, OnePercentOfTheExtinctionIsNoticed) {
  for (const Series& series : kSeries) {
    for (std::size_t depth = 0; depth < kDepths.size(); ++depth) {
      if (!series.sharp[depth]) continue;
      const auto result = agrees(series, depth, Interpolation::kStochastic, 1.01);
      EXPECT_FALSE(result) << result.message();
    }
  }
}

// ---- All of them ------------------------------------------------------------------------------

TEST(ReferenceMethods, FlightsGoOnFromTheWeightsOfTheirRays) {
  Component component;
  component.density = lumpy_field();
  component.sigma_a = Rgb(0.5F, 0.3F, 0.1F);
  component.sigma_s = Rgb(0.5F, 0.7F, 0.9F);
  component.emission = Rgb(1, 2, 3);
  const Medium medium({component});
  constexpr std::size_t kPaths = 200;
  constexpr float kWeights[] = {0.5F, 2, -3};
  const RayStream plain = repeat_ray(test_rays()[0], kPaths, 0);
  RayStream weighted = plain;
  weighted.set_weighted(true);
  for (int channel = 0; channel < kChannels; ++channel) {
    std::fill(weighted.weight[channel].begin(), weighted.weight[channel].end(), kWeights[channel]);
  }
  const auto expect_scaled = [&](const Flown& one, const Flown& other, int channels) {
    for (std::size_t i = 0; i < kPaths; ++i) {
      ASSERT_EQ(one.flights.t[i], other.flights.t[i]);
      for (int c = 0; c < channels; ++c) {
        EXPECT_NEAR(other.flights.weight[c][i], kWeights[c] * one.flights.weight[c][i], 1e-6);
        EXPECT_NEAR(other.flights.emitted[c][i], kWeights[c] * one.flights.emitted[c][i], 1e-6);
      }
    }
  };
  const Interpolation interpolation = Interpolation::kTrilinear;
  for (const char* tracker : {"regular", "ray-marching"}) {
    expect_scaled(fly(medium, tracker, interpolation, plain),
                  fly(medium, tracker, interpolation, weighted), kChannels);
  }
  for (const char* method : {"regular", "p-series", "unbiased-ray-marching"}) {
    expect_scaled(transmit(medium, method, interpolation, plain),
                  transmit(medium, method, interpolation, weighted), 1);
  }
}

TEST(ReferenceMethods, OpticalDepthsOfAHundredMillionLetNothingPass) {
  RayStream rays = repeat_ray(test_rays()[0], 64, 0);
  for (std::size_t i = 0; i < rays.size(); ++i) rays.t_max[i] = kInfinity;
  for (const Interpolation interpolation : {Interpolation::kNearest, Interpolation::kTrilinear}) {
    const Medium medium = noise_of_depth(1e8, test_rays()[0], interpolation);
    for (const char* tracker : {"regular", "ray-marching"}) {
      const Flown flown = fly(medium, tracker, interpolation, rays);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(is_sane(flown.flights, i, true)) << tracker;
        EXPECT_EQ(flown.flights.event[i], Event::kScatter) << tracker;
      }
    }
    for (const char* method : {"regular", "p-series", "unbiased-ray-marching"}) {
      const Flown flown = transmit(medium, method, interpolation, rays);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(is_sane(flown.flights, i, false)) << method;
        EXPECT_EQ(flown.flights.weight[0][i], 0) << method;
        EXPECT_EQ(flown.flights.event[i], Event::kAbsorb) << method;
      }
    }
  }
}

TEST(ReferenceMethods, ARayWhoseEndIsNoNumberMisses) {
  const Medium medium = medium_of(box_field(), 1);
  const RayStream rays = repeat_ray(Vec3f(0.1F), Vec3f(1, 0, 0), kNan, 2);
  for (const char* method : {"closed-form", "regular", "p-series", "unbiased-ray-marching"}) {
    expect_untouched(transmit(medium, method, Interpolation::kNearest, rays).flights, 1);
  }
}

}  // namespace
}  // namespace freepath::testing
