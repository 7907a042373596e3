// Paths of any number of channels, of which few are compiled: the others repeat some.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "freepath/base/error.h"
#include "freepath/transport/sampling.h"
#include "tests/media/make_field.h"
#include "tests/statistics.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr std::size_t kNoiseRays = 60'000;
/// Above it one of some 400 comparisons is by chance with a probability of 1e-3.
constexpr double kChannelThreshold = 4.7;

const Medium& noise_medium() {
  static const Medium kMedium({{.density = make_field(Vec3i(-12), Vec3i(11), [](const Vec3i& p) {
                                  return 0.3F + 0.7F * hash_noise(p);
                                })}});
  return kMedium;
}

RayStream rays_through_noise(std::size_t count = kNoiseRays) {
  return repeat_ray(Vec3f(-20, 0.3F, 0.2F), Vec3f(1, 0, 0), 60, count);
}

/// Optical depth of the ray for an extinction of 1.
double depth() {
  double sum = 0;
  for (int x = -12; x < 12; ++x) sum += 0.3 + 0.7 * hash_noise(Vec3i(x, 0, 0));
  return sum;
}

MediumChannels channels(int count) {
  MediumChannels result;
  result.count = count;
  ComponentChannels& values = result.components.emplace_back();
  for (int c = 0; c < count; ++c) {
    values.sigma_s[c] = 0.02F + 0.01F * static_cast<float>(c * 3 % 8);
    values.sigma_a[c] = 0.03F - 0.003F * static_cast<float>(c % 8);
  }
  return result;
}

/// What escapes in every channel, or the transmittance.
void expect_transmittance(const std::string& name, const FlightStream& flights,
                          const MediumChannels& values, bool free_paths) {
  for (int c = 0; c < values.count; ++c) {
    RunningStatistics escaped;
    for (std::size_t i = 0; i < flights.size(); ++i) {
      const bool counts = !free_paths || flights.event[i] == Event::kEscape;
      escaped.add(counts ? flights.weight[c][i] : 0);
    }
    const ComponentChannels& sigma = values.components[0];
    const double expected = std::exp(-depth() * (double{sigma.sigma_a[c]} + sigma.sigma_s[c]));
    EXPECT_TRUE(check_mean(name + ", channel " + std::to_string(c), escaped, expected,
                           {.z = kChannelThreshold}));
  }
}

TEST(ChannelCount, AnyIsCarriedByEveryChromaticMethod) {
  for (int count = 1; count <= kMaxChannels; ++count) {
    const MediumChannels values = channels(count);
    WalkSettings settings;
    settings.interpolation = Interpolation::kNearest;
    const std::string suffix = ", " + std::to_string(count) + " channels";
    for (const char* const tracker : {"spectral", "spectral-decomposition", "hero-wavelength"}) {
      settings.tracker = tracker;
      expect_transmittance(
          tracker + suffix,
          sample_free_paths(noise_medium(), values, rays_through_noise(), settings), values, true);
    }
    settings.tracker = "spectral";
    for (const char* const estimator : {"ratio", "residual-ratio", "delta", "p-series"}) {
      settings.transmittance = estimator;
      expect_transmittance(
          estimator + suffix,
          estimate_transmittance(noise_medium(), values, rays_through_noise(), settings), values,
          false);
    }
  }
}

// A walk of more channels than the path has reads no weight that nobody set.
TEST(ChannelCount, RepeatedChannelsGoOnFromTheWeightsOfTheirSources) {
  const MediumChannels values = channels(5);
  WalkSettings settings;
  settings.tracker = "spectral:collision-probability=history-max";
  const auto walk = [&](float beyond) {
    RayStream rays = rays_through_noise(1000);
    rays.set_weighted(true);
    for (int c = 0; c < kMaxChannels; ++c) {
      rays.weight[c].assign(rays.weight[c].size(), c < 5 ? 1.0F + static_cast<float>(c) : beyond);
    }
    return sample_free_paths(noise_medium(), values, rays, settings);
  };
  const FlightStream one = walk(0);
  const FlightStream other = walk(std::numeric_limits<float>::quiet_NaN());
  for (int c = 0; c < 5; ++c) EXPECT_EQ(one.weight[c], other.weight[c]);
  EXPECT_EQ(one.t, other.t);
}

TEST(ChannelCount, AutoChoosesByTheChannels) {
  WalkSettings settings;
  settings.tracker = "auto";
  settings.interpolation = Interpolation::kNearest;
  WalkStatistics statistics;
  const MediumChannels values = channels(6);
  const FlightStream flights =
      sample_free_paths(noise_medium(), values, rays_through_noise(), settings, &statistics);
  expect_transmittance("auto", flights, values, true);
  EXPECT_GT(statistics.lookups, 0U);
}

TEST(ChannelCount, WhatNoPathCarriesIsRefused) {
  const auto expect_error = [](const MediumChannels& values, const std::string& part) {
    try {
      WalkSettings settings;
      settings.tracker = "spectral";
      sample_free_paths(noise_medium(), values, rays_through_noise(10), settings);
      ADD_FAILURE() << "no error with '" << part << "'";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  MediumChannels values = channels(3);
  values.count = 0;
  expect_error(values, fmt::format("1 to {} channels, not 0", kMaxChannels));
  values.count = kMaxChannels + 1;
  expect_error(values, fmt::format("1 to {} channels, not {}", kMaxChannels, kMaxChannels + 1));
  values = channels(3);
  values.components.emplace_back();
  expect_error(values, "of 2 components, but the medium has 1");
  values = channels(3);
  values.components[0].sigma_s[2] = -1;
  expect_error(values, "component 0 in channel 2");
  values.components[0].sigma_s[2] = std::numeric_limits<float>::quiet_NaN();
  expect_error(values, "not negative");
}

}  // namespace
}  // namespace freepath::testing
