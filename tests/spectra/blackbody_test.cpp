#include "freepath/spectra/blackbody.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "freepath/base/error.h"

namespace freepath {
namespace {

TEST(Blackbody, FollowsPlancksLaw) {
  // 2 h c² / λ⁵ / (exp(h c / (λ k T)) - 1), evaluated with 40 digits.
  struct Case {
    double wavelength, temperature, radiance;
  };
  for (const auto& [wavelength, temperature, radiance] : {
           Case{483, 6000, 3.18479658034343e+13},
           Case{500, 3700, 1.59836691897183e+12},
           Case{600, 4500, 7.46470636165598e+12},
           Case{360, 1000, 8.65747163652861e-02},
           Case{830, 100000, 1.59748303139503e+15},
           Case{700, 300, 1.24606071129838e-15},
       }) {
    EXPECT_NEAR(planck_radiance(wavelength, temperature) / radiance, 1, 1e-12)
        << wavelength << " nm, " << temperature << " K";
  }
}

TEST(Blackbody, FollowsRayleighAndJeansAtLongWavelengths) {
  const double wavelength = 1e12;  // [nm], a kilometre
  const double temperature = 1e5;
  const double expected = 2 * 299792458.0 * 1.380649e-23 * temperature / std::pow(1e3, 4);
  EXPECT_NEAR(planck_radiance(wavelength, temperature) / expected, 1, 1e-9);
}

TEST(Blackbody, FollowsStefanAndBoltzmann) {
  constexpr double kStefanBoltzmann = 5.670374419e-8;  // [W/(m² K⁴)], CODATA 2018
  for (const double temperature : {1.0, 300.0, 5778.0, 1e5}) {
    // The trapezoidal rule over the logarithm of the wavelength; the integrand vanishes at the
    // ends.
    const double step = 1e-3;
    double integral = 0;
    for (double log_ratio = -3.5; log_ratio < 12; log_ratio += step) {
      const double wavelength = planck_peak(temperature) * std::exp(log_ratio);
      integral += planck_radiance(wavelength, temperature) * wavelength * 1e-9 * step;
    }
    const double expected = kStefanBoltzmann * std::pow(temperature, 4) / std::numbers::pi;
    EXPECT_NEAR(integral / expected, 1, 1e-8) << temperature << " K";
  }
}

TEST(Blackbody, HasItsMaximumWhereWienSays) {
  EXPECT_NEAR(planck_peak(5778), 501.5, 0.05);  // the Sun
  for (const double temperature : {1.0, 300.0, 2856.0, 6504.0, 1e5}) {
    const double peak = planck_peak(temperature);
    const double largest = planck_radiance(peak, temperature);
    for (const double factor : {0.9, 0.999, 1.001, 1.1}) {
      EXPECT_LT(planck_radiance(peak * factor, temperature), largest);
    }
    // Near a maximum a relative distance e changes the value by the order of e².
    EXPECT_NEAR(planck_radiance(peak * (1 + 1e-6), temperature) / largest, 1, 1e-10);
  }
}

TEST(Blackbody, IsFiniteAndGrowsWithTemperatureEverywhere) {
  for (double wavelength = 360; wavelength <= 830; wavelength += 10) {
    double before = 0;
    for (double temperature = 1; temperature <= 1e5; temperature *= 1.1) {
      const double radiance = planck_radiance(wavelength, temperature);
      ASSERT_TRUE(std::isfinite(radiance));
      ASSERT_GE(radiance, before);
      before = radiance;
      const double relative = BlackbodySpectrum(temperature)(wavelength);
      ASSERT_GE(relative, 0);
      ASSERT_LE(relative, 1 + 1e-12);
    }
    EXPECT_GT(before, 0);
  }
  EXPECT_EQ(planck_radiance(500, 1), 0);  // exp(-28776) is below the smallest number
  EXPECT_EQ(planck_radiance(500, 0), 0);
}

TEST(Blackbody, IsScaledAsAsked) {
  const BlackbodySpectrum radiance(4000, BlackbodyScale::kRadiance);
  EXPECT_EQ(radiance(600), planck_radiance(600, 4000));
  const BlackbodySpectrum relative(4000);
  EXPECT_NEAR(relative(planck_peak(4000)), 1, 1e-14);
  EXPECT_NEAR(relative(400) / relative(700), radiance(400) / radiance(700), 1e-14);
}

TEST(Blackbody, RefusesWhatIsNoTemperature) {
  EXPECT_THROW(BlackbodySpectrum{0}, Error);
  EXPECT_THROW(BlackbodySpectrum{-1}, Error);
  EXPECT_THROW(BlackbodySpectrum{std::nan("")}, Error);
  EXPECT_THROW(BlackbodySpectrum{INFINITY}, Error);
}

}  // namespace
}  // namespace freepath
