#include "freepath/render/slab.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "tests/statistics.h"

namespace freepath::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kAnswers = 50;  // z-tests of this file, rounded up
constexpr double kFamilyLevel = 0.01;

/// Never above the 4 standard errors that are asked for.
double threshold() { return std::min(4.0, family_wise_threshold(kFamilyLevel, kAnswers)); }

enum class Quantity { kReflectance, kTransmittance, kUnscattered };

const SlabEstimate& value_of(const SlabResult& result, Quantity quantity) {
  switch (quantity) {
    case Quantity::kTransmittance:
      return result.transmittance;
    case Quantity::kUnscattered:
      return result.unscattered;
    default:
      return result.reflectance;
  }
}

/// An answer that is known, to the digits given.
struct Answer {
  Quantity quantity;
  double value;
  double largest_relative_error = 0.002;  ///< How sharp the estimate must be.
};

/// A problem whose answers are known.
struct Problem {
  std::string name;
  std::vector<SlabLayer> layers;
  double mu0 = 1;  ///< 0: diffuse.
  uint64_t paths = 1'000'000;
  std::vector<Answer> answers;
};

SlabSettings settings_of(const Problem& problem, uint64_t seed) {
  SlabSettings settings;
  settings.diffuse = problem.mu0 == 0;
  if (!settings.diffuse) settings.mu0 = problem.mu0;
  settings.paths = problem.paths;
  settings.walk.seed = seed;
  return settings;
}

/// Whether every answer is met, and sharply so.
::testing::AssertionResult check_problem(const Problem& problem, const SlabSettings& settings) {
  const SlabResult result = trace_slab(problem.layers, settings);
  for (const Answer& answer : problem.answers) {
    const SlabEstimate& estimate = value_of(result, answer.quantity);
    const auto checked = check_mean(problem.name, estimate.mean, estimate.error, result.paths,
                                    answer.value, {threshold(), 0, answer.largest_relative_error});
    if (!checked) return checked;
  }
  return ::testing::AssertionSuccess();
}

/// The manual of MCML [Wang95] quotes [vandeHulst80] in its table 6.1 for mu_a = 10/cm,
/// mu_s = 90/cm, d = 0.02 cm: tau = 2, albedo 0.9.
const Problem kMcmlTable = {"MCML table 6.1",
                            {{2, 0.9, 0.75}},
                            1,
                            2'000'000,
                            {{Quantity::kReflectance, 0.09739},
                             {Quantity::kTransmittance, 0.66096},
                             {Quantity::kUnscattered, 0.135335}}};
/// [vandeHulst80], tables 37 (g = 0.75) and 12 (isotropic).
const Problem kConservative1 = {
    "table 37, tau 1",
    {{1, 1, 0.75}},
    1,
    6'000'000,
    {{Quantity::kReflectance, 0.07874}, {Quantity::kTransmittance, 0.92126}}};
const Problem kConservative8 = {
    "table 37, tau 8",
    {{8, 1, 0.75}},
    1,
    1'000'000,
    {{Quantity::kReflectance, 0.50642}, {Quantity::kTransmittance, 0.49358}}};
const Problem kGrazing = {
    "table 12, mu0 0.1", {{32, 0.2, 0}}, 0.1, 1'000'000, {{Quantity::kReflectance, 0.08266}}};
const Problem kThick = {
    "table 12, diffuse",
    {{32, 0.99, 0}},
    0,
    2'500'000,
    {{Quantity::kReflectance, 0.79456}, {Quantity::kTransmittance, 0.001464, 0.01}}};

/// Isotropic half-spaces: R(mu0) = 1 - sqrt(1-c) H(mu0) [Chandrasekhar60], exact: along the normal,
/// at mu0 = 1/2, and for diffuse light ("white sky").
struct HalfSpace {
  double albedo;
  uint64_t paths;
  std::array<double, 3> reflectance;
};
constexpr HalfSpace kHalfSpaces[] = {{0.5, 1'000'000, {.115226, .160144, .146544}},
                                     {0.8, 500'000, {.285255, .367970, .341867}},
                                     {0.9, 400'000, {.414947, .507939, .478024}},
                                     {0.99, 150'000, {.752721, .815140, .794564}},
                                     {0.999, 50'000, {.912845, .938061, .929713}}};

Problem half_space_problem(const HalfSpace& half_space, std::size_t incidence) {
  constexpr double kMu0[] = {1, 0.5, 0};
  return {"half-space of albedo " + std::to_string(half_space.albedo) + ", mu0 " +
              std::to_string(kMu0[incidence]),
          {{kInfinity, half_space.albedo, 0}},
          kMu0[incidence],
          half_space.paths,
          {{Quantity::kReflectance, half_space.reflectance[incidence]}}};
}

TEST(SlabPublished, AbsorbingSlabWithForwardScattering) {
  EXPECT_TRUE(check_problem(kMcmlTable, settings_of(kMcmlTable, 1)));
}

TEST(SlabPublished, ConservativeSlabs) {
  EXPECT_TRUE(check_problem(kConservative1, settings_of(kConservative1, 2)));
  EXPECT_TRUE(check_problem(kConservative8, settings_of(kConservative8, 3)));
}

TEST(SlabPublished, GrazingLight) {
  EXPECT_TRUE(check_problem(kGrazing, settings_of(kGrazing, 4)));
}

TEST(SlabPublished, ThickSlabInDiffuseLight) {
  EXPECT_TRUE(check_problem(kThick, settings_of(kThick, 5)));
}

TEST(SlabPublished, ExactHalfSpaces) {
  uint64_t seed = 100;
  for (const HalfSpace& half_space : kHalfSpaces) {
    for (std::size_t incidence = 0; incidence < 3; ++incidence) {
      const Problem problem = half_space_problem(half_space, incidence);
      EXPECT_TRUE(check_problem(problem, settings_of(problem, seed++)));
    }
  }
}

TEST(SlabPublished, AnswersDoNotDependOnTheMethod) {
  const auto check = [](const Problem& problem, uint64_t seed, const auto& change) {
    SlabSettings settings = settings_of(problem, seed);
    change(settings);
    EXPECT_TRUE(check_problem(problem, settings)) << settings.walk.tracker;
  };
  check(kMcmlTable, 21, [](SlabSettings& s) { s.walk.simd = Simd::kOneLane; });
  check(half_space_problem(kHalfSpaces[2], 0), 22, [](SlabSettings& s) {
    s.walk.simd = Simd::kOneLane;
    s.super_voxel = 64;
  });
  check(half_space_problem(kHalfSpaces[2], 2), 23,
        [](SlabSettings& s) { s.walk.tracker = "weighted-delta:rate-scale=2"; });
  check(half_space_problem(kHalfSpaces[3], 1), 24,
        [](SlabSettings& s) { s.walk.absorption = Absorption::kAnalog; });
}

// Below a rate scale of 1 the variance is finite only where there is little scattering
// (docs/slab.md).
TEST(SlabPublished, RateBelowTheExtinction) {
  Problem problem = kGrazing;
  problem.paths = 9'000'000;
  SlabSettings settings = settings_of(problem, 31);
  settings.walk.tracker = "weighted-delta:rate-scale=0.7";
  EXPECT_TRUE(check_problem(problem, settings));
}

// The checks above have the power to see an albedo or an optical thickness that is 1 % off.
TEST(SlabPublished, PlantedErrorsOfOnePerCentAreCaught) {
  const auto expect_caught = [](Problem problem, uint64_t seed, double SlabLayer::*parameter) {
    problem.layers[0].*parameter *= 1.01;
    EXPECT_FALSE(check_problem(problem, settings_of(problem, seed))) << problem.name;
  };
  expect_caught(kMcmlTable, 1, &SlabLayer::albedo);
  expect_caught(kMcmlTable, 1, &SlabLayer::tau);
  expect_caught(kConservative1, 2, &SlabLayer::tau);
  expect_caught(kConservative8, 3, &SlabLayer::tau);
  expect_caught(kGrazing, 4, &SlabLayer::albedo);
  for (std::size_t i = 0; i < 3; ++i) {
    expect_caught(half_space_problem(kHalfSpaces[i], 0), 100 + 3 * i, &SlabLayer::albedo);
  }
}

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
  const std::vector<SlabLayer> layers = {{0.25, 0.5, 0}, {0.4, 0.3, 0.5}, {0.01, 0.9, 0}};
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
    const SlabEstimate& a = value_of(whole, quantity);
    const SlabEstimate& b = value_of(cut, quantity);
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
struct Reference {
  RunningStatistics top, bottom;
};
Reference trace_reference(const std::vector<SlabLayer>& layers, double mu0, uint64_t paths) {
  std::mt19937_64 engine(12345);
  std::uniform_real_distribution<double> uniform;
  double total = 0;
  for (const SlabLayer& layer : layers) total += layer.tau;
  Reference reference;
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
    const Reference reference = trace_reference(stack.layers, stack.mu0, 2'000'000);
    SlabSettings settings;
    settings.mu0 = stack.mu0;
    settings.paths = 2'000'000;
    settings.walk.tracker = stack.tracker;
    const SlabResult result = trace_slab(stack.layers, settings);
    const auto check = [&](const SlabEstimate& estimate, const RunningStatistics& expected) {
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
  for (int i = 0; i < 9; ++i) many.push_back({1, 0.1 * i, 0});
  expect_error(many, settings, "9 different pairs of albedo and g");

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
