#include "freepath/spectra/linear_spectrum.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "freepath/base/error.h"
#include "freepath/spectra/spectral_distribution.h"

namespace freepath {
namespace {

TEST(LinearSpectrum, ConnectsSamplesByLines) {
  const LinearSpectrum uneven({400, 500, 520}, {1, 3, -1});
  EXPECT_EQ(uneven(400), 1);
  EXPECT_DOUBLE_EQ(uneven(450), 2);
  EXPECT_EQ(uneven(500), 3);
  EXPECT_DOUBLE_EQ(uneven(515), 0);
  EXPECT_EQ(uneven(520), -1);
}

TEST(LinearSpectrum, FindsEvenSamplesAsItFindsUnevenOnes) {
  const auto function = [](double wavelength) { return std::sin(0.01 * wavelength); };
  const LinearSpectrum even = sample_spectrum(function, 360, 830, 10);
  std::vector<double> wavelengths(even.wavelengths().begin(), even.wavelengths().end());
  std::vector<double> values(even.values().begin(), even.values().end());
  wavelengths.push_back(1000);  // no longer at equal distances
  values.push_back(0);
  const LinearSpectrum uneven(wavelengths, values);
  for (double wavelength = 300; wavelength < 830; wavelength += 0.37) {
    ASSERT_DOUBLE_EQ(even(wavelength), uneven(wavelength)) << wavelength;
  }
}

TEST(LinearSpectrum, HoldsOrVanishesOutside) {
  const LinearSpectrum held({400, 500}, {1, 3});
  EXPECT_EQ(held(360), 1);
  EXPECT_EQ(held(830), 3);
  const LinearSpectrum cut({400, 500}, {1, 3}, OutsideSamples::kZero);
  EXPECT_EQ(cut(399.9), 0);
  EXPECT_EQ(cut(400), 1);
  EXPECT_EQ(cut(500), 3);
  EXPECT_EQ(cut(500.1), 0);
  const LinearSpectrum single({560}, {7});
  EXPECT_EQ(single(360), 7);
  EXPECT_EQ(single(560), 7);
  EXPECT_EQ(single(830), 7);
}

TEST(LinearSpectrum, RefusesSamplesThatMakeNoFunction) {
  EXPECT_THROW(LinearSpectrum({}, {}), Error);
  EXPECT_THROW(LinearSpectrum({400}, {1, 2}), Error);
  EXPECT_THROW(LinearSpectrum({400, 400}, {1, 2}), Error);
  EXPECT_THROW(LinearSpectrum({400}, {INFINITY}), Error);
}

TEST(SpectralDistribution, GivesTheValuesOfEveryKind) {
  const RgbColorSpace& space = rgb_color_space("srgb");
  const LinearSpectrum linear({400, 700}, {1, 4});
  const RgbSpectrum rgb = RgbSpectrum::unbounded({0.1, 2, 0.3}, space);
  const std::array<double, 2> wavelengths = {450, 600};
  EXPECT_EQ(SpectralDistribution(0.5)(600), 0.5);
  EXPECT_EQ(SpectralDistribution(linear)(600), 3);
  EXPECT_EQ(SpectralDistribution(BlackbodySpectrum(3000))(600), BlackbodySpectrum(3000)(600));
  const SpectralDistribution scaled = SpectralDistribution(rgb).scaled(3);
  EXPECT_EQ(scaled(600), 3 * rgb(600));
  EXPECT_EQ(scaled.at(wavelengths), (std::array{scaled(450), scaled(600)}));
}

TEST(SpectralDistribution, KnowsItsLargestValue) {
  EXPECT_EQ(SpectralDistribution(0.5).largest(), 0.5);
  // The maximum is between two whole nanometres.
  const LinearSpectrum peaked({500, 500.5, 501, 900}, {0, 8, 0, 100});
  EXPECT_EQ(SpectralDistribution(peaked).scaled(2).largest(), 2 * peaked(830));
  const LinearSpectrum narrow({500, 500.5, 501}, {0, 8, 0});
  EXPECT_EQ(SpectralDistribution(narrow).largest(), 8);
}

}  // namespace
}  // namespace freepath
