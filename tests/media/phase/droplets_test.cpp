#include "freepath/media/phase/droplets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "freepath/media/phase/phase_function.h"

namespace freepath {
namespace {

/// A phase function at a cosine between the directions.
double value_at(const PhaseFunction& function, double cosine) {
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return function.evaluate(Vec3f(0, 0, 1), Vec3f(Vec3d(sine, 0, cosine)));
}

TEST(Droplets, TendToRayleighAsTheyShrink) {
  for (double cosine = -1; cosine <= 1; cosine += 0.1) {
    const double expected = value_at(PhaseFunction::rayleigh(), cosine);
    EXPECT_NEAR(value_at(PhaseFunction::droplets(1e-3F), cosine), expected, 2e-3 * expected);
  }
}

// Expected: Mie's series for water (refractive index 1.343) at a wavelength of 0.4 µm, averaged
// over diameters with a relative spread of 8 %, computed apart from this project. The fit's
// agreement is best near that wavelength. Around 1.5 µm the exact value oscillates with the size,
// which the fit smooths.
TEST(Droplets, HaveTheMeanCosineOfMieTheory) {
  struct Exact {
    float diameter;  // [µm]
    float mean_cosine;
    float tolerance;
  };
  for (const Exact& exact : {Exact{0.03F, 0.0110F, 0.005F},
                             {0.06F, 0.0437F, 0.015F},
                             {0.1F, 0.1213F, 0.02F},
                             {0.15F, 0.2834F, 0.03F},
                             {0.3F, 0.6958F, 0.02F},
                             {0.5F, 0.8222F, 0.01F},
                             {0.7F, 0.8424F, 0.01F},
                             {1.0F, 0.7884F, 0.04F},
                             {3.0F, 0.8281F, 0.02F},
                             {5.0F, 0.8284F, 0.02F},
                             {10.0F, 0.8567F, 0.01F},
                             {20.0F, 0.8657F, 0.02F},
                             {50.0F, 0.8741F, 0.02F}}) {
    EXPECT_NEAR(PhaseFunction::droplets(exact.diameter).mean_cosine(), exact.mean_cosine,
                exact.tolerance)
        << exact.diameter;
  }
}

// Expected: the published formulas, evaluated apart from this project.
TEST(Droplets, HaveTheParametersOfThePublishedFit) {
  struct Expected {
    float diameter;  // [µm]
    Droplets::Parameters fit;
  };
  for (const Expected& expected : {Expected{0.05F, {0.0345F, 0.02566118F, 250.0F, 0.2521807F}},
                                   {0.5F, {0.7932952F, 0.7183329F, 250.0F, 0.4042444F}},
                                   {3.0F, {0.9459452F, 0.4219728F, 14.34051F, 0.3809394F}},
                                   {10.0F, {0.9881767F, 0.5556713F, 21.99552F, 0.4819554F}},
                                   {40.0F, {0.9974189F, 0.6192843F, 31.27259F, 0.5060553F}}}) {
    const Droplets::Parameters fit = Droplets::fit(expected.diameter);
    EXPECT_NEAR(fit.g_hg, expected.fit.g_hg, 1e-6) << expected.diameter;
    EXPECT_NEAR(fit.g_d, expected.fit.g_d, 1e-6) << expected.diameter;
    EXPECT_NEAR(fit.alpha, expected.fit.alpha, 1e-5) << expected.diameter;
    EXPECT_NEAR(fit.weight, expected.fit.weight, 1e-6) << expected.diameter;
  }
}

TEST(Droplets, HaveAPeakThatRisesWithTheDiameterOfFogAndCloud) {
  double last = 0;
  for (float diameter = 5; diameter <= 50; diameter += 1) {
    const double peak = value_at(PhaseFunction::droplets(diameter), 1);
    EXPECT_GT(peak, last) << diameter;
    last = peak;
  }
}

TEST(Droplets, ChangeLittleInTheMeanCosineWhereTheFitsMeet) {
  for (const float diameter : {0.1F, 1.5F, 5.0F}) {
    EXPECT_NEAR(PhaseFunction::droplets(diameter).mean_cosine(),
                PhaseFunction::droplets(std::nextafter(diameter, 0.0F)).mean_cosine(), 0.02)
        << diameter;
  }
}

TEST(Droplets, AreProperForEveryDiameter) {
  for (float diameter = 0.001F; diameter < 50; diameter *= 1.01F) {
    const Droplets::Parameters fit = Droplets::fit(diameter);
    EXPECT_LT(std::abs(fit.g_hg), 1) << diameter;
    EXPECT_LT(std::abs(fit.g_d), 1) << diameter;
    EXPECT_GE(fit.alpha, 0) << diameter;
    EXPECT_GT(fit.weight, 0) << diameter;
    EXPECT_LT(fit.weight, 1) << diameter;
  }
}

}  // namespace
}  // namespace freepath
