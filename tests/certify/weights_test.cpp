// The weights of paths of many scatterings: what WeightGrowth says of a method is what flights do.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "freepath/transport/weight_growth.h"
#include "tests/certify/cases.h"
#include "tests/statistics.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr std::size_t kPaths = 1024;

/// A thick medium of noise that absorbs nothing, from whose inside no path gets out.
Medium endless_noise() {
  Component component;
  // So wide that bounds along the axis know nothing of its surroundings.
  component.density = make_field(Vec3i(0, -16, -16), Vec3i(63, 15, 15),
                                 [](const Vec3i& p) { return 0.2F + 0.8F * hash_noise(p); });
  component.sigma_s = Rgb(1.0F);
  return Medium({component});
}

/// What the channels of an endless medium are, without absorption or with it.
MediumChannels channels_of_color(const std::array<float, 3>& sigma_s,
                                 const std::array<float, 3>& sigma_a) {
  MediumChannels channels;
  channels.count = 3;
  ComponentChannels& component = channels.components.emplace_back();
  for (int c = 0; c < 3; ++c) {
    component.sigma_s[c] = sigma_s[c];
    component.sigma_a[c] = sigma_a[c];
  }
  return channels;
}

/// Rays that go on where their flights have scattered, with the weights of those.
void go_on_with_the_living(const FlightStream& flights, int channels, RayStream& rays) {
  std::size_t living = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    float largest = 0;
    for (int c = 0; c < channels; ++c) largest = std::max(largest, std::abs(flights.weight[c][i]));
    if (flights.event[i] != Event::kScatter || largest == 0) continue;
    for (int c = 0; c < channels; ++c) {
      rays.weight[c][living] = flights.weight[c][i];
      rays.density[c][living] = flights.density[c][i];
    }
    rays.sample[living++] = rays.sample[i];
  }
  rays.resize(living);
}

/// The largest magnitude of a weight that has been flown from scattering to scattering, always from
/// the same point.
double largest_weight_after(const MediumChannels& channels, const WalkSettings& settings,
                            int scatterings) {
  static const Medium kMedium = endless_noise();
  const bool shared = shares_paths(channels, settings);
  const Walker walker(kMedium, shared ? channels : channels.only(0), settings);
  RayStream rays = repeat_ray(Vec3f(1, 0, 0), Vec3f(1, 0, 0), 60, kPaths);
  rays.set_weighted(true);
  FlightStream flights;
  WalkStatistics counts;
  for (int scattering = 0; scattering < scatterings && rays.size() > 0; ++scattering) {
    std::fill(rays.stream.begin(), rays.stream.end(), static_cast<uint32_t>(scattering));
    walker.free_paths(rays, flights, counts);
    go_on_with_the_living(flights, walker.channels(), rays);
  }
  float largest = 0;
  for (int c = 0; c < walker.channels(); ++c) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      largest = std::max(largest, std::abs(rays.weight[c][i]));
    }
  }
  return largest;
}

// What is called bounded stays so over a hundred scatterings. This holds for every tracker of the
// registry in every spelling.
TEST(PathWeights, OfBoundedMethodsStayBounded) {
  const MediumChannels media[] = {
      channels_of_color({1, 1, 1}, {0, 0, 0}),
      channels_of_color({1, 0.8F, 0.5F}, {0, 0, 0}),
      channels_of_color({1, 0.95F, 0.9F}, {0, 0.05F, 0.1F}),
  };
  int bounded = 0;
  for (const std::string& tracker : certified_variants(true)) {
    for (const MediumChannels& channels : media) {
      for (const Absorption absorption : {Absorption::kWeighted, Absorption::kAnalog}) {
        WalkSettings settings;
        settings.tracker = tracker;
        settings.absorption = absorption;
        settings.interpolation = Interpolation::kNearest;
        if (tracker.starts_with("closed-form")) continue;  // can't walk noise
        const MediumChannels seen = shares_paths(channels, settings) ? channels : channels.only(0);
        if (!weight_growth(seen, settings).bounded()) continue;
        ++bounded;
        // history-max is not bounded by the number of channels, but grows hardly at all.
        const double most = tracker.find("history-max") != std::string::npos ? 150 : 3;
        EXPECT_LE(largest_weight_after(channels, settings, 100), 1.001 * most) << tracker;
      }
    }
  }
  EXPECT_GT(bounded, 70);
}

// And what is refused is refused for a reason.
TEST(PathWeights, OfRefusedMethodsGrow) {
  const MediumChannels grey = channels_of_color({1, 1, 1}, {0, 0, 0});
  const MediumChannels coloured = channels_of_color({1, 0.8F, 0.5F}, {0, 0, 0});
  const MediumChannels albedos = channels_of_color({1, 0.95F, 0.9F}, {0, 0.05F, 0.1F});
  struct Case {
    const MediumChannels& channels;
    const char* tracker;
    Absorption absorption = Absorption::kWeighted;
    int scatterings = 30;
  };
  const Case cases[] = {
      {grey, "weighted-delta:rate-scale=0.7"},
      {grey, "weighted-decomposition:rate-scale=0.7"},
      {coloured, "spectral:collision-probability=max"},
      {coloured, "spectral:collision-probability=average"},
      {coloured, "spectral-decomposition:collision-probability=average"},
      {albedos, "delta", Absorption::kAnalog, 60},
      {albedos, "decomposition", Absorption::kAnalog, 60},
  };
  for (const Case& test : cases) {
    WalkSettings settings;
    settings.tracker = test.tracker;
    settings.absorption = test.absorption;
    settings.interpolation = Interpolation::kNearest;
    EXPECT_FALSE(weight_growth(test.channels, settings).bounded()) << test.tracker;
    EXPECT_GT(largest_weight_after(test.channels, settings, test.scatterings), 10) << test.tracker;
  }
}

// M = (2x - 1) x / (1 - (2x - 1)(x - 1)), x = 1/0.9: 1.5716.
TEST(PathWeights, GrowthOfWeightedDeltaIsTheMeanSquareOfAFlight) {
  Component component;
  component.density = make_field(Vec3i(0), Vec3i(63, 0, 0), [](const Vec3i&) { return 1.0F; });
  component.sigma_s = Rgb(3.0F);
  const Medium medium({component});
  WalkSettings settings;
  settings.tracker = "weighted-delta:rate-scale=0.9";
  settings.interpolation = Interpolation::kNearest;
  constexpr std::size_t kFlights = 500'000;
  const RayStream rays = repeat_ray(Vec3f(1, 0, 0), Vec3f(1, 0, 0), 60, kFlights);
  FlightStream flights;
  WalkStatistics counts;
  Walker(medium, settings).free_paths(rays, flights, counts);
  RunningStatistics squares;
  for (std::size_t i = 0; i < kFlights; ++i) {
    squares.add(double{flights.weight[0][i]} * flights.weight[0][i]);
  }
  const WeightGrowth growth = weight_growth(channels_of(medium), settings);
  EXPECT_TRUE(check_mean("mean square", squares.mean(), squares.standard_error(), kFlights,
                         growth.per_flight, {.z = 4, .largest_relative_error = 0.0025}));
}

}  // namespace
}  // namespace freepath::testing
