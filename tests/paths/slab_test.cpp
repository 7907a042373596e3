// Properties of slabs: conservation, exponential laws, layers, independence of threads, errors.

#include "freepath/paths/slab.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "tests/paths/slab_quantities.h"

namespace freepath::testing {
namespace {

TEST(Slab, WithoutAbsorptionAllLightLeaves) {
  const std::vector<SlabLayer> layers = {{0.7, 1, 0.8}, {1.9, 1, -0.4}, {0.3, 1, 0}};
  SlabSettings settings;
  settings.diffuse = true;
  settings.paths = 100'000;
  const SlabResult result = trace_slab(layers, settings);
  EXPECT_NEAR(result.reflectance.mean + result.transmittance.mean, 1, 1e-6);
  EXPECT_NEAR(result.total.mean, 1, 1e-6);
  EXPECT_LT(result.total.error, 1e-6);  // in every single path
}

TEST(Slab, UnscatteredLightFollowsTheExponentialLaw) {
  const std::vector<SlabLayer> layers = {{0.25, 0.5, 0}, {0.4, 0.3, 0}, {0.01, 0.5, 0}};
  SlabSettings settings;
  settings.mu0 = 0.6;
  settings.paths = 500'000;
  for (const char* tracker : {"delta", "weighted-delta:rate-scale=0.7"}) {
    settings.walk.tracker = tracker;
    const SlabResult result = trace_slab(layers, settings);
    EXPECT_TRUE(check_mean(tracker, result.unscattered.mean, result.unscattered.error, result.paths,
                           std::exp(-0.66 / 0.6), {threshold(), 0, 0.005}));
  }
}

TEST(Slab, DiffuseLightPassesAnAbsorberByTheExponentialIntegral) {
  SlabSettings settings;
  settings.diffuse = true;
  settings.paths = 1'000'000;
  const SlabResult result = trace_slab(std::vector<SlabLayer>{{0.5, 0, 0}}, settings);
  // 2 E_3(1/2), E_3(0.5) = 0.2216044 (Abramowitz and Stegun, table 5.4).
  EXPECT_TRUE(check_mean("2 E_3", result.transmittance.mean, result.transmittance.error,
                         result.paths, 0.4432088, {threshold(), 0, 0.002}));
  EXPECT_EQ(result.reflectance.mean, 0);
}

TEST(Slab, ALayerCutInTwoStaysTheSame) {
  SlabSettings settings;
  settings.mu0 = 0.7;
  settings.paths = 500'000;
  const SlabResult whole = trace_slab(std::vector<SlabLayer>{{1.5, 0.9, 0.6}}, settings);
  settings.walk.seed = 1;
  const SlabResult cut =
      trace_slab(std::vector<SlabLayer>{{0.2, 0.9, 0.6}, {1.3, 0.9, 0.6}}, settings);
  for (const Quantity quantity : {Quantity::kReflectance, Quantity::kTransmittance}) {
    const Estimate& a = value_of(whole, quantity);
    const Estimate& b = value_of(cut, quantity);
    EXPECT_TRUE(check_mean("difference", a.mean - b.mean, std::hypot(a.error, b.error),
                           settings.paths, 0, {threshold(), 0}));
  }
}

TEST(Slab, AHalfSpaceBelowALayerOfItsKindStaysTheSame) {
  SlabSettings settings;
  settings.paths = 400'000;
  const SlabResult result =
      trace_slab(std::vector<SlabLayer>{{0.5, 0.9, 0}, {kInfinity, 0.9, 0}}, settings);
  EXPECT_TRUE(check_mean("half-space in two parts", result.reflectance.mean,
                         result.reflectance.error, result.paths, .414947, {threshold(), 0, 0.002}));
  EXPECT_EQ(result.transmittance.mean, 0);
}

/// An independent answer for layers: the vertical place is the optical depth itself, so that a
/// flight needs neither voxels nor null collisions, directions are their cosines alone, absorption
/// ends paths, and everything is in double precision.
struct SlabReference {
  RunningStatistics top, bottom;
};
SlabReference trace_reference(const std::vector<SlabLayer>& layers, double mu0, uint64_t paths) {
  std::mt19937_64 engine(12345);
  std::uniform_real_distribution<double> uniform;
  double total = 0;
  for (const SlabLayer& layer : layers) total += layer.tau;
  SlabReference reference;
  for (uint64_t path = 0; path < paths; ++path) {
    double mu = mu0;
    double depth = 0;
    bool absorbed = false;
    while (true) {
      depth -= mu * std::log1p(-uniform(engine));
      if (depth < 0 || depth > total) break;
      std::size_t i = 0;
      for (double bottom = layers[0].tau; bottom < depth; bottom += layers[++i].tau) {
      }
      absorbed = uniform(engine) >= layers[i].albedo;
      if (absorbed) break;
      const double g = layers[i].g;
      const double u = 2 * uniform(engine) - 1;
      const double ratio = (1 - g * g) / (1 + g * u);
      const double cosine = g == 0 ? u : (1 + g * g - ratio * ratio) / (2 * g);
      const double azimuth = 2 * std::numbers::pi * uniform(engine);
      mu = mu * cosine + std::sqrt((1 - mu * mu) * (1 - cosine * cosine)) * std::cos(azimuth);
      mu = std::clamp(mu, -1.0, 1.0);
    }
    reference.top.add(!absorbed && depth < 0 ? 1 : 0);
    reference.bottom.add(!absorbed && depth > total ? 1 : 0);
  }
  return reference;
}

TEST(Slab, LayersOfDifferentKindsAgreeWithAnIndependentCalculation) {
  struct Stack {
    std::vector<SlabLayer> layers;
    double mu0;
    const char* tracker;
  };
  const Stack stacks[] = {
      {{{0.7, 0.9, 0.8}, {1.3, 0.4, -0.3}, {0.5, 1, 0}}, 0.6, "delta"},
      {{{0.05, 1, 0}, {3, 0.8, 0.9}, {0.2, 0.6, -0.6}}, 1, "weighted-delta:rate-scale=1.5"},
      {{{0.25, 0.5, 0}, {0.25, 0.3, 0}}, 1, "weighted-delta:rate-scale=0.7"}};
  for (const Stack& stack : stacks) {
    const SlabReference reference = trace_reference(stack.layers, stack.mu0, 2'000'000);
    SlabSettings settings;
    settings.mu0 = stack.mu0;
    settings.paths = 2'000'000;
    settings.walk.tracker = stack.tracker;
    const SlabResult result = trace_slab(stack.layers, settings);
    const auto check = [&](const Estimate& estimate, const RunningStatistics& expected) {
      EXPECT_LT(estimate.error, 0.006 * estimate.mean);
      EXPECT_TRUE(check_mean(stack.tracker, estimate.mean - expected.mean(),
                             std::hypot(estimate.error, expected.standard_error()), settings.paths,
                             0, {threshold(), 0}));
    };
    check(result.reflectance, reference.top);
    check(result.transmittance, reference.bottom);
  }
}

void expect_same_bits(const SlabResult& a, const SlabResult& b) {
  EXPECT_EQ(a.reflectance.mean, b.reflectance.mean);
  EXPECT_EQ(a.reflectance.error, b.reflectance.error);
  EXPECT_EQ(a.transmittance.mean, b.transmittance.mean);
  EXPECT_EQ(a.transmittance.error, b.transmittance.error);
  EXPECT_EQ(a.unscattered.mean, b.unscattered.mean);
}

TEST(Slab, ThreadsBatchesAndLaneWidthsChangeNoBit) {
  const std::vector<SlabLayer> layers = {{1, 0.9, 0.7}, {2, 0.4, 0}};
  SlabSettings settings;
  settings.paths = 100'000;  // the last chunk is not full
  settings.threads = 1;
  const SlabResult result = trace_slab(layers, settings);
  for (const auto& [threads, batch] :
       {std::pair{2, 2048}, std::pair{2, 1}, std::pair{2, 37}, std::pair{1, 1 << 20}}) {
    settings.threads = threads;
    settings.batch = batch;
    expect_same_bits(trace_slab(layers, settings), result);
  }
  for (const Simd simd : available_simd()) {
    if (simd != Simd::kAvx2 && simd != Simd::kAvx512) continue;
    settings.walk.simd = simd;
    SlabSettings best = settings;
    best.walk.simd = Simd::kBest;
    expect_same_bits(trace_slab(layers, settings), trace_slab(layers, best));
  }
  settings.walk.seed = 1;
  EXPECT_NE(trace_slab(layers, settings).reflectance.mean, result.reflectance.mean);
}

TEST(Slab, StopsEarlyWithTheLightSoFar) {
  SlabSettings settings;
  settings.paths = 1'000'000;
  settings.threads = 1;
  uint64_t reported = 0;
  const SlabResult result =
      trace_slab(std::vector<SlabLayer>{{1, 1, 0}}, settings, [&](uint64_t done, uint64_t total) {
        reported = done;
        EXPECT_EQ(total, settings.paths);
        return done < 30'000;
      });
  EXPECT_EQ(result.paths, reported);
  EXPECT_LT(result.paths, 100'000);
  EXPECT_NEAR(result.total.mean, 1, 1e-6);
}

void expect_error(const std::vector<SlabLayer>& layers, const SlabSettings& settings,
                  const std::string& part) {
  try {
    trace_slab(layers, settings);
    ADD_FAILURE() << "no error, expected: " << part;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Slab, ErrorsNameParameterAndValue) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const SlabSettings settings;
  expect_error({}, settings, "tau has 0 layers");
  expect_error({{0, 1, 0}}, settings, "tau of layer 1 is 0");
  expect_error({{1, 1, 0}, {-2, 1, 0}}, settings, "tau of layer 2 is -2");
  expect_error({{nan, 1, 0}}, settings, "tau of layer 1 is nan");
  expect_error({{kInfinity, 0.5, 0}, {1, 1, 0}}, settings, "tau of layer 1 is inf");
  expect_error({{1e9, 0.5, 0}}, settings, "sum of tau is 1000000000");
  expect_error({{1, 1.5, 0}}, settings, "albedo of layer 1 is 1.5");
  expect_error({{1, -0.5, 0}}, settings, "albedo of layer 1 is -0.5");
  expect_error({{1, 1, 1}}, settings, "g of layer 1 is 1");
  expect_error({{1, 1, -1.5}}, settings, "g of layer 1 is -1.5");
  expect_error({{kInfinity, 1, 0}}, settings, "albedo of the half-space (tau inf) is 1");
  std::vector<SlabLayer> many;
  many.reserve(17);
  for (int i = 0; i < 17; ++i) many.push_back({1, 0.05 * i, 0});
  expect_error(many, settings, "17 different pairs of albedo and phase function");

  const auto with = [](auto member, auto value) {
    SlabSettings changed;
    changed.*member = value;
    return changed;
  };
  expect_error({{1, 1, 0}}, with(&SlabSettings::mu0, 0.0), "mu0 is 0");
  expect_error({{1, 1, 0}}, with(&SlabSettings::mu0, 1.5), "mu0 is 1.5");
  expect_error({{1, 1, 0}}, with(&SlabSettings::paths, uint64_t{0}), "paths is 0");
  expect_error({{1, 1, 0}}, with(&SlabSettings::threads, -1), "threads is -1");
  expect_error({{1, 1, 0}}, with(&SlabSettings::super_voxel, 5), "super-voxel of 5");
}

}  // namespace
}  // namespace freepath::testing
