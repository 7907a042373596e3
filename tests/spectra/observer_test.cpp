#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "freepath/base/error.h"
#include "freepath/spectra/cie_observer.h"
#include "freepath/spectra/illuminants.h"

namespace freepath {
namespace {

TEST(CieObserver, HasThePublishedIntegrals) {
  // Sums of the CIE's table at steps of 1 nm, of which the trapezoidal rule takes half of both
  // ends.
  const Vec3d sums = observe([](double) { return 1.0; }) * kLuminousIntegral;
  EXPECT_NEAR(sums.x, 106.865469, 1e-3);
  EXPECT_NEAR(sums.y, 106.856895, 5e-5);
  EXPECT_NEAR(sums.z, 106.892251, 1e-3);
  EXPECT_NEAR(sums.y, kLuminousIntegral, 1e-12);
}

TEST(CieObserver, HasThePublishedColourMatchingFunctions) {
  EXPECT_EQ(color_matching(555), Vec3d(0.5120501, 1.0000000, 0.005749999));
  EXPECT_EQ(color_matching(445).z, 1.7826);
  EXPECT_EQ(color_matching(600).x, 1.0622);
  EXPECT_DOUBLE_EQ(color_matching(600.5).x, 0.5 * (color_matching(600).x + color_matching(601).x));
  EXPECT_EQ(color_matching(359.9), Vec3d(0));
  EXPECT_EQ(color_matching(830.1), Vec3d(0));
  EXPECT_GT(color_matching(360).y, 0);
  EXPECT_GT(color_matching(830).y, 0);
}

TEST(Illuminants, HaveThePublishedWhitePoints) {
  struct Case {
    const char* name;
    LinearSpectrum spectrum;
    Chromaticity expected;  // CIE 15:2004
    double tolerance;
  };
  const std::array<Case, 8> cases = {{
      {"A", illuminant_a(), {0.44758, 0.40745}, 2e-5},
      {"D50", illuminant_d50(), {0.34567, 0.35851}, 1e-4},
      {"D65", illuminant_d65(), {0.31272, 0.32903}, 2e-5},
      {"E", illuminant_e(), {0.33333, 0.33333}, 5e-5},
      {"F2", illuminant_f(2), {0.3721, 0.3751}, 3e-4},
      {"F7", illuminant_f(7), {0.3129, 0.3292}, 3e-4},
      {"F11", illuminant_f(11), {0.3805, 0.3769}, 3e-4},
      {"F12", illuminant_f(12), {0.4370, 0.4042}, 3e-4},
  }};
  for (const auto& [name, spectrum, expected, tolerance] : cases) {
    const Vec3d xyz = observe(spectrum);
    EXPECT_NEAR(xyz.y, 1, 1e-12) << name;
    EXPECT_NEAR(chromaticity_of(xyz).x, expected.x, tolerance) << name;
    EXPECT_NEAR(chromaticity_of(xyz).y, expected.y, tolerance) << name;
  }
}

TEST(Illuminants, HaveThePublishedPower) {
  // Relative to 100 at 560 nm, as the CIE tabulates them.
  struct Case {
    LinearSpectrum spectrum;
    double at_400, at_500, at_600, at_700;
  };
  const std::array<Case, 3> cases = {{
      {illuminant_a(), 14.7080, 59.8611, 129.043, 198.261},
      {illuminant_d50(), 49.308, 95.724, 97.688, 91.604},
      {illuminant_d65(), 82.7549, 109.354, 90.0062, 71.6091},
  }};
  for (const Case& illuminant : cases) {
    const auto relative = [&](double wavelength) {
      return 100 * illuminant.spectrum(wavelength) / illuminant.spectrum(560);
    };
    EXPECT_NEAR(relative(400), illuminant.at_400, 6e-4);
    EXPECT_NEAR(relative(500), illuminant.at_500, 6e-4);
    EXPECT_NEAR(relative(600), illuminant.at_600, 6e-4);
    EXPECT_NEAR(relative(700), illuminant.at_700, 6e-4);
  }
}

TEST(Illuminants, DaylightHasTheChromaticityAskedFor) {
  for (const double temperature : {4000.0, 5500.0, 7000.0, 12000.0, 25000.0}) {
    const Chromaticity expected = daylight_chromaticity(temperature);
    const Chromaticity found = chromaticity_of(observe(daylight(expected)));
    EXPECT_NEAR(found.x, expected.x, 2e-4) << temperature;
    EXPECT_NEAR(found.y, expected.y, 2e-4) << temperature;
  }
}

TEST(Illuminants, RefuseWhatIsNotDefined) {
  EXPECT_THROW(illuminant_f(0), Error);
  EXPECT_THROW(illuminant_f(13), Error);
  EXPECT_THROW(daylight_chromaticity(3999), Error);
  EXPECT_THROW(daylight_chromaticity(std::nan("")), Error);
  EXPECT_THROW(normalized_to_luminance(LinearSpectrum({500}, {0})), Error);
}

}  // namespace
}  // namespace freepath
