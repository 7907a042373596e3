#include "freepath/spectra/rgb_spectrum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/spectra/cie_observer.h"
#include "tests/spectra/largest_difference.h"

namespace freepath {
namespace {

using testing::largest_difference;

/// RGB that the observer sees of a surface of this reflectance under the illuminant of the space,
/// by the quadrature at every nanometre.
template <class Reflectance>
Vec3d observed(const Reflectance& reflectance, const RgbColorSpace& space) {
  return space.from_xyz(observe(
      [&](double wavelength) { return reflectance(wavelength) * space.illuminant()(wavelength); }));
}

/// The colours r, g, b = 0, 0.1, ..., 1.
std::vector<Vec3d> color_grid() {
  std::vector<Vec3d> colors;
  for (int r = 0; r <= 10; ++r) {
    for (int g = 0; g <= 10; ++g) {
      for (int b = 0; b <= 10; ++b) colors.push_back(Vec3d(r, g, b) / 10.0);
    }
  }
  return colors;
}

TEST(FitReflectance, ReturnsEveryColourOfSrgb) {
  const RgbColorSpace& space = rgb_color_space("srgb");
  for (const Vec3d& rgb : color_grid()) {
    const Vec3d found = observed(fit_reflectance(rgb, space), space);
    EXPECT_LT(largest_difference(found, rgb), 0.0002) << rgb;
  }
}

TEST(FitReflectance, ReturnsDarkColoursWithTheSameRelativePrecision) {
  const RgbColorSpace& space = rgb_color_space("srgb");
  for (const double size : {0.1, 0.01, 0.001}) {
    for (const Vec3d& direction : color_grid()) {
      const Vec3d rgb = direction * size;
      const Vec3d found = observed(fit_reflectance(rgb, space), space);
      EXPECT_LT(largest_difference(found, rgb), 0.005 * size) << rgb;
    }
  }
}

TEST(FitReflectance, ReturnsTheColoursOfSrgbInEverySpace) {
  const RgbColorSpace& srgb = rgb_color_space("srgb");
  for (const std::string_view name : rgb_color_space_names()) {
    const RgbColorSpace& space = rgb_color_space(name);
    const Vec3d white = space.from_xyz(srgb.to_xyz(Vec3d(1)));
    for (const Vec3d& color : color_grid()) {
      Vec3d rgb = space.from_xyz(srgb.to_xyz(color)) / white;
      for (int i = 0; i < 3; ++i) rgb[i] = std::clamp(rgb[i], 0.0, 1.0);
      const Vec3d found = observed(fit_reflectance(rgb, space), space);
      EXPECT_LT(largest_difference(found, rgb), 0.005) << name << ' ' << rgb;
    }
  }
}

TEST(RgbReflectance, OfGreyIsExactlyConstant) {
  const RgbColorSpace& space = rgb_color_space("srgb");
  for (const double grey : {0.0, 1e-6, 0.18, 0.5, 0.99, 1.0}) {
    const RgbSpectrum spectrum = RgbSpectrum::reflectance(Vec3d(grey), space);
    for (double wavelength = 360; wavelength <= 830; wavelength += 47) {
      EXPECT_NEAR(spectrum(wavelength), grey, 1e-15);
    }
    EXPECT_LT(largest_difference(observed(spectrum, space), Vec3d(grey)), 1e-12);
  }
}

TEST(RgbReflectance, StaysBetweenZeroAndOne) {
  const RgbColorSpace& space = rgb_color_space("rec2020");
  for (const Vec3d& rgb : {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1), Vec3d(1, 1, 0),
                           Vec3d(0, 1, 1), Vec3d(1, 0, 1), Vec3d(1e-9, 0, 0)}) {
    const RgbSpectrum spectrum = RgbSpectrum::reflectance(rgb, space);
    for (double wavelength = 360; wavelength <= 830; ++wavelength) {
      ASSERT_GE(spectrum(wavelength), 0);
      ASSERT_LE(spectrum(wavelength), 1);
    }
  }
}

TEST(RgbUnbounded, ReturnsColoursOfAnySize) {
  const RgbColorSpace& space = rgb_color_space("srgb");
  for (const double size : {1e-8, 0.5, 1.0, 40.0, 1e9}) {
    for (const Vec3d& direction :
         {Vec3d(1, 1, 1), Vec3d(1, 0.5, 0.2), Vec3d(0, 1, 0.3), Vec3d(0.1, 0, 1), Vec3d(1, 1, 0)}) {
      const Vec3d rgb = direction * size;
      const RgbSpectrum spectrum = RgbSpectrum::unbounded(rgb, space);
      EXPECT_LT(largest_difference(observed(spectrum, space), rgb), 0.002 * size) << rgb;
    }
  }
  EXPECT_EQ(RgbSpectrum::unbounded(Vec3d(0), space)(500), 0);
}

TEST(RgbIlluminant, IsSeenAsItsColour) {
  const RgbColorSpace& space = rgb_color_space("aces-cg");
  for (const Vec3d& rgb : {Vec3d(1, 1, 1), Vec3d(3, 2, 1), Vec3d(0.2, 0.4, 0.9)}) {
    const Vec3d found = space.from_xyz(observe(RgbSpectrum::illuminant(rgb, space)));
    EXPECT_LT(largest_difference(found, rgb), 0.001) << rgb;
  }
  const RgbSpectrum white = RgbSpectrum::illuminant(Vec3d(2), space);
  EXPECT_NEAR(white(500), 2 * space.illuminant()(500), 1e-14);
}

TEST(RgbSpectrum, RefusesWhatIsNoColour) {
  const RgbColorSpace& space = rgb_color_space("srgb");
  EXPECT_THROW(RgbSpectrum::reflectance({0, 1.01, 0}, space), Error);
  EXPECT_THROW(RgbSpectrum::reflectance({0, -0.01, 0}, space), Error);
  EXPECT_THROW(RgbSpectrum::reflectance({0, std::nan(""), 0}, space), Error);
  EXPECT_THROW(RgbSpectrum::unbounded({0, 0, -1}, space), Error);
  EXPECT_THROW(RgbSpectrum::illuminant({INFINITY, 0, 0}, space), Error);
}

}  // namespace
}  // namespace freepath
