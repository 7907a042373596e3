// Slabs whose reflectance and transmittance are published or known exactly.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/paths/slab_quantities.h"

namespace freepath::testing {
namespace {

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
    const Estimate& estimate = value_of(result, answer.quantity);
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
    600'000,
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

// Every tracker of the registry, under loose bounds, so that it meets null collisions.
class SlabTracker : public ::testing::TestWithParam<std::string> {};

TEST_P(SlabTracker, ReproducesThePublishedNumbers) {
  SlabSettings settings = settings_of(kMcmlTable, 41);
  settings.walk.tracker = GetParam();
  if (GetParam() != "closed-form") settings.bound_scale = 2;  // which refuses loose ones
  EXPECT_TRUE(check_problem(kMcmlTable, settings));
}

std::vector<std::string> unbiased_trackers() {
  std::vector<std::string> names;
  for (const MethodInfo& info : tracker_infos()) {
    if (!info.biased) names.emplace_back(info.name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, SlabTracker, ::testing::ValuesIn(unbiased_trackers()),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

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

}  // namespace
}  // namespace freepath::testing
