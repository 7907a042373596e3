#include <gtest/gtest.h>

#include <array>
#include <string>

#include "freepath/transport/walker.h"
#include "tests/statistics.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr float kDensity = 0.75F;
const std::array<Rgb, 2> kScattering = {Rgb(1, 0.5F, 0.25F), Rgb(0.2F, 0.4F, 0.8F)};

/// Noise, and beside it a constant density, of other colours each.
Medium noise_and_haze() {
  std::array<Component, 2> components;
  components[0].density = make_field(Vec3i(0), Vec3i(7), hash_noise);
  components[1].density = make_field(Vec3i(0), Vec3i(7), [](const Vec3i&) { return kDensity; });
  for (std::size_t k = 0; k < components.size(); ++k) {
    components[k].sigma_s = kScattering[k];
    components[k].sigma_a = Rgb(0.1F, 0.3F, 0.2F);
  }
  return Medium({components[0], components[1]});
}

FlightStream scattering_at(const Vec3f& origin, float t, uint32_t count) {
  const Medium medium = noise_and_haze();
  WalkSettings settings;
  settings.tracker = "spectral";
  settings.interpolation = Interpolation::kNearest;
  FlightStream flights;
  WalkStatistics statistics;
  Walker(medium, settings)
      .scattering_at_ends(repeat_ray(origin, {1, 0, 0}, t, count), flights, statistics);
  return flights;
}

// What is drawn of a component is on average its scattering coefficient.
TEST(EndScattering, IsThatOfTheVoxelWhereTheRayEnds) {
  constexpr uint32_t kRays = 400'000;
  const FlightStream flights = scattering_at({-2, 4.1F, 5.3F}, 5.2F, kRays);
  const std::array<float, 2> densities = {hash_noise(Vec3i(3, 4, 5)), kDensity};
  for (std::size_t k = 0; k < densities.size(); ++k) {
    for (int c = 0; c < 3; ++c) {
      RunningStatistics drawn;
      for (uint32_t i = 0; i < kRays; ++i) {
        ASSERT_EQ(flights.event[i], Event::kScatter);
        drawn.add(flights.component[i] == k ? flights.weight[c][i] : 0);
      }
      EXPECT_TRUE(check_mean("component " + std::to_string(k), drawn,
                             double{densities[k]} * kScattering[k][c],
                             {.z = 4, .largest_relative_error = 0.0025}));
    }
  }
}

TEST(EndScattering, NothingScattersOutside) {
  for (const float t : {1.0F, 12.0F}) {  // before and behind the voxels
    EXPECT_EQ(scattering_at({-2, 4, 5}, t, 1).event[0], Event::kEscape);
  }
}

}  // namespace
}  // namespace freepath::testing
