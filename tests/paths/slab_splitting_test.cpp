// Paths that split in thick, absorbing layers, against exponential laws and an integral equation.

#include "freepath/paths/slab_splitting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "freepath/paths/slab.h"
#include "tests/paths/slab_quantities.h"

namespace freepath::testing {
namespace {

SlabResult traced(const std::vector<SlabLayer>& layers, uint64_t paths, double mu0 = 1) {
  SlabSettings settings;
  settings.mu0 = mu0;
  settings.paths = paths;
  return trace_slab(layers, settings);
}

TEST(SlabSplitting, LightThatNothingScattersFollowsTheExponentialLawToTheMinus40) {
  for (const auto& [tau, mu0] :
       {std::pair{20.0, 1.0}, std::pair{20.0, 0.5}, std::pair{60.0, 1.0}}) {
    const SlabResult result = traced({{tau, 0, 0}}, 100'000, mu0);
    EXPECT_TRUE(check_mean("transmittance", result.transmittance.mean, result.transmittance.error,
                           result.paths, std::exp(-tau / mu0), {threshold(), 0, 0.08}));
    EXPECT_EQ(result.transmittance.mean, result.unscattered.mean);
  }
}

/// Exponential integral E_2.
double e2(double x) { return x > 0 ? std::exp(-x) + x * std::expint(-x) : 1; }

struct Fluxes {
  double reflectance = 0;
  double transmittance = 0;
};

/// Isotropic scattering in a layer by its integral equation (collisions per depth, of a flux of 1):
///   C(x) = exp(-x/mu0)/mu0 + albedo ∫ C(y) E_1(|x - y|)/2 dy,
/// with C constant in cells and exact integrals of E_1 over them, summed order by order.
Fluxes by_integral_equation(double tau, double albedo, double mu0) {
  constexpr int kCells = 1200;
  const double h = tau / kCells;
  // Mean over a cell of what another, n cells away, sends it: second differences of E_3.
  const auto e3 = [](double x) { return 0.5 * (std::exp(-x) - x * e2(x)); };
  std::vector<double> kernel(kCells);
  kernel[0] = (h - 0.5 + e3(h)) / h;
  for (int n = 1; n < kCells; ++n) {
    kernel[n] = 0.5 * (e3((n + 1) * h) - 2 * e3(n * h) + e3((n - 1) * h)) / h;
  }
  std::vector<double> order(kCells);  // of scattering: collisions in each cell
  for (int i = 0; i < kCells; ++i) order[i] = std::exp(-i * h / mu0) - std::exp(-(i + 1) * h / mu0);
  std::vector<double> sum = order;
  for (double largest = 1; largest > 1e-16;) {
    std::vector<double> next(kCells, 0.0);
    for (int i = 0; i < kCells; ++i) {
      for (int j = 0; j < kCells; ++j) next[i] += albedo * order[j] * kernel[std::abs(i - j)];
    }
    largest = *std::max_element(next.begin(), next.end());
    for (int i = 0; i < kCells; ++i) sum[i] += next[i];
    order = std::move(next);
  }
  Fluxes fluxes{0, std::exp(-tau / mu0)};
  for (int i = 0; i < kCells; ++i) {
    const auto leaves = [&](double x) { return 0.5 * albedo * sum[i] * (e3(x) - e3(x + h)) / h; };
    fluxes.reflectance += leaves(i * h);
    fluxes.transmittance += leaves((kCells - 1 - i) * h);
  }
  return fluxes;
}

TEST(SlabSplitting, ThickAbsorbersAgreeWithTheIntegralEquation) {
  struct Case {
    double tau, albedo, mu0;
    uint64_t paths;
  };
  for (const Case& c : {Case{14, 0.4, 1, 200'000}, Case{9, 0.7, 0.6, 200'000}}) {
    const Fluxes exact = by_integral_equation(c.tau, c.albedo, c.mu0);
    const SlabResult result = traced({{c.tau, c.albedo, 0}}, c.paths, c.mu0);
    EXPECT_TRUE(check_mean("reflectance", result.reflectance.mean, result.reflectance.error,
                           result.paths, exact.reflectance, {threshold(), 0, 0.006}));
    EXPECT_TRUE(check_mean("transmittance", result.transmittance.mean, result.transmittance.error,
                           result.paths, exact.transmittance, {threshold(), 0, 0.015}));
  }
}

TEST(SlabSplitting, ThreadsAndBatchesChangeNoBit) {
  const std::vector<SlabLayer> layers = {{4, 0.6, 0.5}, {5, 0.2, 0}};
  SlabSettings settings;
  settings.paths = 20'000;
  settings.threads = 1;
  const SlabResult result = trace_slab(layers, settings);
  EXPECT_GT(result.transmittance.mean, 0);
  for (const auto& [threads, batch] : {std::pair{2, 2048}, std::pair{2, 1}, std::pair{1, 37}}) {
    settings.threads = threads;
    settings.batch = batch;
    const SlabResult other = trace_slab(layers, settings);
    EXPECT_EQ(other.transmittance.mean, result.transmittance.mean);
    EXPECT_EQ(other.transmittance.error, result.transmittance.error);
    EXPECT_EQ(other.reflectance.mean, result.reflectance.mean);
  }
}

TEST(SlabSplitting, StandardErrorsAreThoseOfRepeatedRuns) {
  constexpr int kRuns = 60;
  RunningStatistics means;
  double stated = 0;  // mean of the squares of the stated errors
  for (int run = 0; run < kRuns; ++run) {
    SlabSettings settings;
    settings.paths = 4000;
    settings.walk.seed = run;
    const SlabResult result = trace_slab(std::vector<SlabLayer>{{10, 0.5, 0}}, settings);
    means.add(result.transmittance.mean);
    stated += result.transmittance.error * result.transmittance.error / kRuns;
  }
  // The variance of 60 means is good to 18 %.
  const double ratio = means.standard_error() * means.standard_error() * kRuns / stated;
  EXPECT_GT(ratio, 0.5);
  EXPECT_LT(ratio, 1.6);
}

TEST(SlabSplitting, WherePathsCannotSplitNothingComesThroughAndALimitIsGiven) {
  // Without splits, of 100 paths none passes exp(-4.9).
  const SlabResult result = traced({{4.9, 0, 0}}, 20);
  ASSERT_TRUE(result.transmittance.upper.has_value());
  EXPECT_NEAR(*result.transmittance.upper, 1 - std::pow(0.05, 1.0 / 20), 1e-12);
  EXPECT_GT(*result.transmittance.upper, std::exp(-4.9));
  // What can't be is no matter of chance.
  EXPECT_FALSE(result.reflectance.upper.has_value());
  EXPECT_FALSE(traced({{kInfinity, 0.5, 0}}, 20).transmittance.upper.has_value());
}

TEST(SlabSplitting, MomentsOfHenyeyGreensteinArePowersOfG) {
  const std::vector<double> moments = legendre_moments(PhaseFunction::henyey_greenstein(0.8F), 12);
  for (int l = 0; l < 12; ++l) EXPECT_NEAR(moments[l], std::pow(0.8, l), 2e-4) << l;
}

TEST(SlabSplitting, TheRelaxationExponentSolvesTheCharacteristicEquation) {
  const std::vector<double> isotropic = legendre_moments(PhaseFunction(), 256);
  for (const double albedo : {0.5, 0.8, 0.99}) {
    const double k = relaxation_exponent(albedo, isotropic);
    EXPECT_NEAR(albedo / (2 * k) * std::log((1 + k) / (1 - k)), 1, 1e-4) << albedo;  // [Case67]
  }
  EXPECT_EQ(relaxation_exponent(1, isotropic), 0);
  EXPECT_EQ(relaxation_exponent(0, isotropic), 1);
}

TEST(SlabSplitting, APhaseFunctionStandsInPlaceOfG) {
  const auto phase = std::make_shared<PhaseFunction>(PhaseFunction::henyey_greenstein(0.6F));
  const SlabResult by_phase = traced({{1, 0.9, 0, phase}, {2, 0.9, 0, phase}}, 20'000);
  const SlabResult by_g = traced({{1, 0.9, 0.6}, {2, 0.9, 0.6}}, 20'000);
  EXPECT_EQ(by_phase.reflectance.mean, by_g.reflectance.mean);
  EXPECT_EQ(by_phase.transmittance.mean, by_g.transmittance.mean);
}

}  // namespace
}  // namespace freepath::testing
