#include "freepath/spectra/named_spectra.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "freepath/base/error.h"
#include "freepath/spectra/cie_observer.h"

namespace freepath {
namespace {

std::string name_error(std::string_view name) {
  try {
    named_spectrum(name);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(NamedSpectra, AreAllFiniteAndNotNegative) {
  for (const std::string_view name : spectrum_names()) {
    const LinearSpectrum spectrum = named_spectrum(name);
    for (double wavelength = 360; wavelength <= 830; ++wavelength) {
      ASSERT_TRUE(std::isfinite(spectrum(wavelength))) << name;
      ASSERT_GE(spectrum(wavelength), 0) << name;
    }
    if (name.starts_with("stdillum")) {
      EXPECT_NEAR(luminance_of(spectrum), 1, 1e-12) << name;
    }
  }
}

TEST(NamedSpectra, GlassesHaveThePublishedIndices) {
  struct Case {
    std::string_view name;
    double index;  // at the d line of helium, from Schott's data sheets
    double abbe;   // (n_d - 1) / (n_F - n_C)
  };
  constexpr auto kCases = std::to_array<Case>({
      {"glass-BK7", 1.51680, 64.17},
      {"glass-BAF10", 1.67003, 47.11},
      {"glass-FK51A", 1.48656, 84.47},
      {"glass-LASF9", 1.85025, 32.17},
      {"glass-F5", 1.67270, 32.21},
      {"glass-F10", 1.72825, 28.41},
      {"glass-F11", 1.78472, 25.76},
  });
  for (const auto& [name, index, abbe] : kCases) {
    const LinearSpectrum spectrum = named_spectrum(name);
    EXPECT_NEAR(spectrum(587.5618), index, 1e-5) << name;
    const double dispersion = spectrum(486.1327) - spectrum(656.2725);
    EXPECT_NEAR((spectrum(587.5618) - 1) / dispersion, abbe, 0.02) << name;
  }
}

TEST(NamedSpectra, CrystalsHaveThePublishedIndices) {
  EXPECT_NEAR(named_spectrum("metal-MgO-eta")(587.6), 1.7375, 3e-4);
  EXPECT_NEAR(named_spectrum("metal-TiO2-eta")(587.6), 2.614, 2e-3);
  EXPECT_EQ(named_spectrum("metal-MgO-k")(500), 0);
}

TEST(NamedSpectra, MetalsReflectAsMeasured) {
  // ((n - 1)² + k²) / ((n + 1)² + k²) at normal incidence: textbooks give gold 0.35 to 0.4 in the
  // blue and 0.97 in the red, silver 0.98, copper 0.95 in the red, aluminium 0.91.
  const auto reflectance = [](const std::string& metal, double wavelength) {
    const double eta = named_spectrum(metal + "-eta")(wavelength);
    const double k = named_spectrum(metal + "-k")(wavelength);
    return ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
  };
  EXPECT_NEAR(reflectance("metal-Au", 450), 0.39, 0.02);
  EXPECT_NEAR(reflectance("metal-Au", 700), 0.97, 0.01);
  EXPECT_NEAR(reflectance("metal-Ag", 550), 0.98, 0.01);
  EXPECT_NEAR(reflectance("metal-Cu", 700), 0.96, 0.02);
  EXPECT_NEAR(reflectance("metal-Cu", 450), 0.54, 0.02);
  EXPECT_NEAR(reflectance("metal-Al", 550), 0.91, 0.02);
}

TEST(NamedSpectra, UnknownNameIsAnErrorWithTheNearest) {
  EXPECT_EQ(name_error("metal-Au-n"),
            "there is no spectrum 'metal-Au-n'; did you mean 'metal-Au-k'?");
  EXPECT_EQ(name_error("stdillum-d65"),
            "there is no spectrum 'stdillum-d65'; did you mean 'stdillum-D65'?");
  EXPECT_EQ(name_error("unobtainium"), "there is no spectrum 'unobtainium'");
}

}  // namespace
}  // namespace freepath
