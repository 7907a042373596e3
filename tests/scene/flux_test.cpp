// Fluxes through volumes that repeat sideways, against closed forms, slabs and published columns.

#include "freepath/scene/flux_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/paths/slab.h"
#include "tests/scene/periodic_volumes.h"
#include "tests/statistics.h"

namespace freepath::testing {
namespace {

namespace fs = std::filesystem;

constexpr double kRadians = std::numbers::pi / 180;

/// The direction of light from a sun that stands in the west, as seen with z up.
Vec3f beam_from_west(double zenith) {
  return {static_cast<float>(std::sin(zenith * kRadians)), 0,
          static_cast<float>(-std::cos(zenith * kRadians))};
}

Vec3f view_to(double zenith, double azimuth) {
  return sky_direction(90 - zenith, azimuth, UpAxis::kZ);
}

FluxSettings flux_settings(uint64_t paths, uint64_t seed) {
  FluxSettings settings;
  settings.paths = paths;
  settings.walk.interpolation = Interpolation::kNearest;
  settings.walk.seed = seed;
  return settings;
}

FluxScene domain_of(const VolumeMedium& medium, const std::optional<Ground>& ground = {}) {
  return make_flux_scene(medium, UpAxis::kZ, ground, Interpolation::kNearest);
}

Ground ground_of(float albedo) { return {.albedo = Rgb(albedo), .up = UpAxis::kZ}; }

/// @param largest_error relative, of the standard error: else a planted error of 1 % would pass
void expect_estimate(const std::string& name, const Estimate& estimate, double expected,
                     double largest_error = 0.0025) {
  EXPECT_LT(estimate.error, largest_error * expected) << name;
  EXPECT_LT(std::abs(z_score(estimate.mean, estimate.error, expected)), 4)
      << name << ": " << estimate.mean << " +- " << estimate.error << " is not " << expected;
}

/// E_3, by midpoints of its integral over cosines.
double exponential_integral_3(double x) {
  constexpr int kSteps = 100000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double mu = (i + 0.5) / kSteps;
    sum += mu * std::exp(-x / mu);
  }
  return sum / kSteps;
}

/// A tower of voxels, 8 high and `width` wide, of an optical depth.
PeriodicVoxels even_layer(double depth, int width) {
  return {Vec3i(width, 3, 8), 0.25, [=](const Vec3i&) { return static_cast<float>(depth / 2); }};
}

// However narrow a homogeneous domain is, it is a slab.
TEST(Flux, AHomogeneousDomainIsASlab) {
  struct Method {
    const char* tracker;
    Absorption absorption;
    int width;
  };
  const SlabLayer layer{2, 0.9, 0.75};
  for (const double zenith : {0.0, 60.0}) {
    SlabSettings slab;
    slab.mu0 = std::cos(zenith * kRadians);
    slab.paths = 4'000'000;
    slab.walk.seed = 3;
    const SlabResult exact = trace_slab(std::span(&layer, 1), slab);
    uint64_t seed = 10;
    for (const Method& method : {Method{"delta", Absorption::kWeighted, 3},
                                 {"delta", Absorption::kAnalog, 1},
                                 {"weighted-decomposition", Absorption::kWeighted, 40}}) {
      const VolumeMedium medium =
          even_layer(2, method.width).medium(0.9F, PhaseFunction::henyey_greenstein(0.75F));
      FluxScene scene = domain_of(medium);
      scene.meter.beam = beam_from_west(zenith);
      FluxSettings settings = flux_settings(1'000'000, seed++);
      settings.walk.tracker = method.tracker;
      settings.walk.absorption = method.absorption;
      const FluxResult result = trace_flux(scene.scene, scene.meter, settings);
      const auto check = [&](const char* name, const Estimate& a, const Estimate& b,
                             double complement, double largest_error = 0.005) {
        const double expected = complement + (complement > 0 ? -b.mean : b.mean);
        const double error = std::hypot(a.error, b.error);
        EXPECT_LT(error, largest_error * expected) << name;
        EXPECT_LT(std::abs(a.mean - expected), 4 * error)
            << name << ", " << method.tracker << ", zenith " << zenith;
      };
      check("reflectance", result.reflectance.all, exact.reflectance, 0);
      check("transmittance", result.transmittance.all, exact.transmittance, 0);
      check("unscattered", result.unscattered.all, exact.unscattered, 0, 0.01);
      check("absorptance", result.absorptance.all, exact.total, 1);
    }
  }
}

// A ground of albedo a under an absorber of depth t: exp(-t/mu) comes down, twice E_3(t) of what it
// reflects comes up, and exp(-t/mu_v) of the radiance towards a view.
TEST(Flux, AGroundUnderAnAbsorberHasAClosedForm) {
  constexpr double kDepth = 0.7;
  constexpr float kAlbedo = 0.6F;
  constexpr double kZenith = 40;
  const VolumeMedium medium = even_layer(kDepth, 3).medium(0);
  FluxScene scene = domain_of(medium, ground_of(kAlbedo));
  scene.meter.views = {view_to(0, 0), view_to(70, 30), view_to(120, 0)};
  scene.meter.beam = beam_from_west(kZenith);
  const FluxResult result = trace_flux(scene.scene, scene.meter, flux_settings(2'000'000, 1));
  const double down = std::exp(-kDepth / std::cos(kZenith * kRadians));
  const double up = 2 * exponential_integral_3(kDepth);
  expect_estimate("transmittance", result.transmittance.all, down);
  expect_estimate("unscattered", result.unscattered.all, down);
  expect_estimate("reflectance", result.reflectance.all, down * kAlbedo * up);
  expect_estimate("absorptance", result.absorptance.all, 1 - down + down * kAlbedo * (1 - up));
  expect_estimate("nadir", result.radiances[0].all, down * kAlbedo * std::exp(-kDepth));
  expect_estimate("slanted", result.radiances[1].all,
                  down * kAlbedo * std::exp(-kDepth / std::cos(70 * kRadians)), 0.004);
  EXPECT_EQ(result.radiances[2].all.mean, 0);
  // Light from all over the sky comes down as it comes up.
  scene.meter.beam.reset();
  const FluxResult diffuse = trace_flux(scene.scene, scene.meter, flux_settings(2'000'000, 2));
  expect_estimate("transmittance", diffuse.transmittance.all, up);
  expect_estimate("reflectance", diffuse.reflectance.all, up * kAlbedo * up);
}

// Rays that are almost level pass thousands of sides, where roulette is played for them.
TEST(Flux, AlmostLevelLightPassesThousandsOfSides) {
  constexpr double kDepth = 1e-3;
  constexpr double kZenith = 89.8;
  const VolumeMedium medium = even_layer(kDepth, 1).medium(0);
  FluxScene scene = domain_of(medium, ground_of(1));
  const double thousands = 2 / 0.25 * std::tan(kZenith * kRadians) / 1024;
  ASSERT_GT(thousands, 2);
  const double passed = std::exp(-kDepth / std::cos(kZenith * kRadians));
  scene.meter.beam = beam_from_west(kZenith);
  FluxResult result = trace_flux(scene.scene, scene.meter, flux_settings(20'000, 1));
  expect_estimate("transmittance", result.transmittance.all, passed, 0.03);
  scene.meter.beam = beam_from_west(0);
  scene.meter.views = {view_to(kZenith, 90)};
  result = trace_flux(scene.scene, scene.meter, flux_settings(20'000, 2));
  expect_estimate("view", result.radiances[0].all, passed * std::exp(-kDepth), 0.03);
}

// Energy: what falls in is reflected, absorbed or kept by the ground, in every column together.
TEST(Flux, NothingGetsLost) {
  PeriodicVoxels voxels{Vec3i(5, 4, 6), 0.5, [](const Vec3i& v) {
                          return static_cast<float>((v.x * 7 + v.y * 3 + v.z * 5) % 4);
                        }};
  for (const float albedo : {0.0F, 0.5F, 1.0F}) {
    FluxScene scene = domain_of(voxels.medium(0.95F), ground_of(albedo));
    EXPECT_EQ(scene.meter.counts, (std::array{5U, 4U}));
    scene.meter.beam = beam_from_west(50);
    const FluxResult result = trace_flux(scene.scene, scene.meter, flux_settings(400'000, 7));
    const double sum = result.reflectance.all.mean + result.absorptance.all.mean +
                       (1 - albedo) * result.transmittance.all.mean;
    EXPECT_NEAR(sum, 1, 0.004) << albedo;
    double columns = 0;
    for (const Estimate& column : result.absorptance.columns) columns += column.mean;
    EXPECT_NEAR(columns / 20, result.absorptance.all.mean, 1e-9);
  }
}

// A component that absorbs and never scatters beside one that scatters and never absorbs.
TEST(Flux, AbsorbersBesideScatterersCount) {
  PeriodicVoxels voxels = even_layer(0.8, 2);
  VolumeMedium medium = voxels.medium(1);
  std::vector<Component> components = medium.medium->components();
  components.push_back(components[0]);
  components[1].sigma_a = Rgb(0.5F);
  components[1].sigma_s = Rgb(0.0F);
  medium.medium = std::make_shared<const Medium>(components);
  FluxScene scene = domain_of(medium);
  scene.meter.beam = beam_from_west(0);
  const FluxResult result = trace_flux(scene.scene, scene.meter, flux_settings(1'000'000, 4));
  const SlabLayer layer{1.2, 1 / 1.5, 0};
  SlabSettings slab;
  slab.paths = 4'000'000;
  const SlabResult exact = trace_slab(std::span(&layer, 1), slab);
  const double error = std::hypot(result.absorptance.all.error, exact.total.error);
  EXPECT_LT(std::abs(result.absorptance.all.mean - (1 - exact.total.mean)), 4 * error);
  EXPECT_LT(error, 0.002);
}

TEST(Flux, ThreadsBatchesAndLaneWidthsChangeNoBit) {
  PeriodicVoxels voxels{Vec3i(6, 3, 5), 0.5,
                        [](const Vec3i& v) { return static_cast<float>((v.x * v.y + v.z) % 3); }};
  FluxScene scene = domain_of(voxels.medium(0.9F), ground_of(0.4F));
  scene.meter.beam = beam_from_west(30);
  scene.meter.views = {view_to(20, 130)};
  FluxSettings settings = flux_settings(50'000, 9);
  const FluxResult whole = trace_flux(scene.scene, scene.meter, settings);
  const auto same = [&](const FluxResult& other) {
    const auto same_map = [](const FluxMap& a, const FluxMap& b) {
      ASSERT_EQ(a.columns.size(), b.columns.size());
      for (std::size_t i = 0; i < a.columns.size(); ++i) {
        EXPECT_EQ(a.columns[i].mean, b.columns[i].mean);
        EXPECT_EQ(a.columns[i].error, b.columns[i].error);
      }
      EXPECT_EQ(a.all.mean, b.all.mean);
      EXPECT_EQ(a.all.error, b.all.error);
    };
    same_map(whole.reflectance, other.reflectance);
    same_map(whole.transmittance, other.transmittance);
    same_map(whole.absorptance, other.absorptance);
    same_map(whole.radiances[0], other.radiances[0]);
  };
  for (const int threads : {1, 3}) {
    for (const std::size_t batch : {std::size_t{1}, std::size_t{37}, std::size_t{4096}}) {
      settings.threads = threads;
      settings.batch = batch;
      same(trace_flux(scene.scene, scene.meter, settings));
    }
  }
  settings.walk.simd = Simd::kOneLane;
  same(trace_flux(scene.scene, scene.meter, settings));
}

// The error bars of columns are those of the spread between seeds.
TEST(Flux, ErrorsOfColumnsAreThoseOfTheirSpread) {
  PeriodicVoxels voxels{Vec3i(4, 1, 4), 0.5,
                        [](const Vec3i& v) { return static_cast<float>(v.x + 1); }};
  FluxScene scene = domain_of(voxels.medium(0.9F));
  scene.meter.beam = beam_from_west(30);
  scene.meter.views = {view_to(0, 0)};
  constexpr int kSeeds = 300;
  std::array<RunningStatistics, 4> means, stated;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const FluxResult result =
        trace_flux(scene.scene, scene.meter, flux_settings(2000, 1000 + seed));
    const std::array<const Estimate*, 4> values{
        &result.reflectance.columns[2], &result.transmittance.columns[0],
        &result.absorptance.columns[3], &result.radiances[0].columns[1]};
    for (std::size_t i = 0; i < values.size(); ++i) {
      means[i].add(values[i]->mean);
      stated[i].add(values[i]->error * values[i]->error);
    }
  }
  for (std::size_t i = 0; i < means.size(); ++i) {
    // The variance of so many has a standard error of 8 %, more where tails are long.
    EXPECT_NEAR(means[i].variance() / stated[i].mean(), 1, 0.35) << i;
  }
}

TEST(Flux, WhatCantBeIsRefused) {
  const PeriodicVoxels voxels = even_layer(1, 3);
  VolumeMedium open = voxels.medium(1);
  EXPECT_THROW(domain_of(open, Ground{.albedo = Rgb(0.5F), .height = 1.0, .up = UpAxis::kZ}),
               Error);
  open.sides.axes[1] = false;
  EXPECT_THROW(domain_of(open), Error);
  FluxScene scene = domain_of(voxels.medium(1));
  EXPECT_THROW(trace_flux(scene.scene, scene.meter, flux_settings(0, 1)), Error);
}

/// 32 values, one a column; nothing where the file is not there.
std::vector<double> published(const std::string& experiment, const std::string& quantity) {
  std::ifstream file(fs::path(FREEPATH_TEST_DATA) / "i3rc" /
                     ("I3RC_cons_res_case1_exp" + experiment + "_" + quantity + ".txt"));
  std::vector<double> values;
  for (double value; file >> value;) values.push_back(value);
  return values;
}

/// The step cloud of the Intercomparison of 3D Radiation Codes, case 1 [Cahalan05].
PeriodicVoxels step_cloud() {
  constexpr double kVoxel = 0.5 / 32;  // [km]
  return {Vec3i(32, 16, 16), kVoxel,
          [](const Vec3i& v) { return v.x < 16 ? 2 / 0.25F : 18 / 0.25F; }};
}

TEST(Flux, TheI3rcStepCloudColumnByColumn) {
  if (!fs::exists(fs::path(FREEPATH_TEST_DATA) / "i3rc")) {
    GTEST_SKIP() << "no I3RC results in " << FREEPATH_TEST_DATA;
  }
  struct Experiment {
    const char* name;
    double zenith;
    float albedo;
  };
  int files = 0;
  for (const Experiment& experiment :
       {Experiment{"1", 0, 1}, {"2", 60, 1}, {"3", 0, 0.99F}, {"4", 60, 0.99F}}) {
    const VolumeMedium medium =
        step_cloud().medium(experiment.albedo, PhaseFunction::henyey_greenstein(0.85F));
    FluxScene scene = domain_of(medium);
    scene.meter.counts = {32, 1};
    scene.meter.beam = beam_from_west(experiment.zenith);
    const auto check = [&](const char* quantity, const FluxMap& map, bool is_radiance) {
      const std::vector<double> expected = published(experiment.name, quantity);
      if (expected.empty()) return;
      ++files;
      ASSERT_EQ(expected.size(), 32U);
      double mean = 0;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        const Estimate& column = map.columns[i];
        mean += expected[i] / 32;
        // Beside the steps on the thin side a mean over codes, some of which average over cells,
        // has 5 % more radiance than paths of light, and than paths of the camera.
        if (is_radiance && (i == 0 || i == 15)) continue;
        EXPECT_LT(std::abs(column.mean - expected[i]), 0.01 * expected[i] + 4 * column.error)
            << "experiment " << experiment.name << ", " << quantity << ", column " << i << ": "
            << column.mean << " +- " << column.error << ", published " << expected[i];
      }
      EXPECT_LT(std::abs(map.all.mean - mean), 0.002 * mean + 3 * map.all.error)
          << "experiment " << experiment.name << ", " << quantity << ": " << map.all.mean << " +- "
          << map.all.error << ", published " << mean;
    };
    const FluxResult fluxes = trace_flux(scene.scene, scene.meter, flux_settings(1'000'000, 21));
    check("R", fluxes.reflectance, false);
    check("T", fluxes.transmittance, false);
    check("A", fluxes.absorptance, false);
    // Seen from above, from below, and at 60 degrees from where light goes on to and comes from.
    scene.meter.views = {view_to(0, 0), view_to(180, 0), view_to(60, 90), view_to(60, 270)};
    const FluxResult seen = trace_flux(scene.scene, scene.meter, flux_settings(200'000, 22));
    check("Iu", seen.radiances[0], true);
    check("Id", seen.radiances[1], true);
    check("I601", seen.radiances[2], true);
    check("I602", seen.radiances[3], true);
  }
  EXPECT_GE(files, 12);
}

}  // namespace
}  // namespace freepath::testing
