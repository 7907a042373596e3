#include "freepath/spectra/wavelengths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "freepath/base/random.h"
#include "freepath/spectra/blackbody.h"
#include "freepath/spectra/rgb_spectrum.h"
#include "freepath/spectra/spectral_distribution.h"
#include "tests/statistics.h"

namespace freepath {
namespace {

using testing::check_chi_square;
using testing::check_mean;
using testing::chi_square_test;
using testing::RunningStatistics;

constexpr std::array kDensities = {WavelengthDensity::kUniform, WavelengthDensity::kVisible,
                                   WavelengthDensity::kFilm};

std::string name_of(WavelengthDensity density) {
  if (density == WavelengthDensity::kUniform) return "uniform";
  return density == WavelengthDensity::kVisible ? "visible" : "film";
}

TEST(WavelengthDensity, IntegratesToOneAndToItsInverse) {
  for (const WavelengthDensity density : kDensities) {
    constexpr int kSteps = 47'000;
    const double step = (kLongestWavelength - kShortestWavelength) / kSteps;
    double integral = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double middle = kShortestWavelength + (i + 0.5) * step;
      integral += 0.5 * step * wavelength_pdf(middle, density);
      EXPECT_NEAR(sample_wavelength(integral, density), middle, 1e-3) << name_of(density);
      integral += 0.5 * step * wavelength_pdf(middle, density);
    }
    EXPECT_NEAR(integral, 1, 1e-8) << name_of(density);
    EXPECT_EQ(wavelength_pdf(359.9, density), 0);
    EXPECT_EQ(wavelength_pdf(830.1, density), 0);
  }
}

TEST(WavelengthDensity, IsThePublishedOne) {
  // 0.003939804229 / cosh²(0.0072 (λ - 538)) over 360 nm to 830 nm.
  for (const double wavelength : {360.0, 450.0, 538.0, 700.0, 830.0}) {
    const double cosh = std::cosh(0.0072 * (wavelength - 538));
    EXPECT_NEAR(wavelength_pdf(wavelength, WavelengthDensity::kVisible),
                0.003939804229 / (cosh * cosh), 1e-9);
  }
}

TEST(Wavelengths, StayInRangeAtTheEnds) {
  for (const WavelengthDensity density : kDensities) {
    for (const double u : {0.0, 0.25, 0.5, 0.75, 0x1.fffffep-1, 0x1.fffffffffffffp-1}) {
      const auto wavelengths = sample_wavelengths<4>(u, density);
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_GE(wavelengths.lambda[i], kShortestWavelength);
        EXPECT_LE(wavelengths.lambda[i], kLongestWavelength);
        EXPECT_GT(wavelengths.pdf[i], 0);
      }
    }
  }
}

TEST(Wavelengths, UniformOnesAreRotatedByEqualDistances) {
  const auto [count, lambda, pdf] = sample_wavelengths<4>(0.9, WavelengthDensity::kUniform);
  EXPECT_EQ(count, 4U);
  EXPECT_DOUBLE_EQ(lambda[0], 360 + 0.90 * 470);
  EXPECT_NEAR(lambda[1], 360 + 0.15 * 470, 1e-9);
  EXPECT_NEAR(lambda[2], 360 + 0.40 * 470, 1e-9);
  EXPECT_NEAR(lambda[3], 360 + 0.65 * 470, 1e-9);
  EXPECT_DOUBLE_EQ(pdf[2], 1 / 470.0);
}

TEST(Wavelengths, EachHasTheDensity) {
  constexpr int kBins = 47;
  constexpr int kSamples = 200'000;
  for (const WavelengthDensity density : kDensities) {
    std::vector<double> expected(kBins, 0.0);
    for (int bin = 0; bin < kBins; ++bin) {
      for (int i = 0; i < 100; ++i) {
        const double wavelength = kShortestWavelength + 10 * (bin + (i + 0.5) / 100);
        expected[bin] += 0.1 * wavelength_pdf(wavelength, density) * kSamples;
      }
    }
    for (std::size_t which = 0; which < 4; ++which) {
      std::vector<uint64_t> counts(kBins, 0);
      RandomStream random(1, 0, 0, static_cast<uint32_t>(which));
      for (int sample = 0; sample < kSamples; ++sample) {
        const double wavelength = sample_wavelengths<4>(random.uniform(), density).lambda[which];
        ++counts[std::min(static_cast<std::size_t>((wavelength - 360) / 10), counts.size() - 1)];
      }
      EXPECT_TRUE(check_chi_square(name_of(density) + " " + std::to_string(which),
                                   chi_square_test(counts, expected)));
    }
  }
}

/// X, Y, Z of many paths that carry a spectrum at some wavelengths.
template <std::size_t kCount>
std::array<RunningStatistics, 3> estimates(const SpectralDistribution& spectrum,
                                           WavelengthDensity density, uint32_t stream) {
  constexpr int kPaths = 100'000;
  std::array<RunningStatistics, 3> result;
  RandomStream random(2, 0, 0, stream);
  for (int path = 0; path < kPaths; ++path) {
    const auto wavelengths = sample_wavelengths<kCount>(random.uniform(), density);
    const Vec3d xyz = estimate_xyz(spectrum.at(wavelengths.lambda), wavelengths);
    for (int i = 0; i < 3; ++i) result[static_cast<std::size_t>(i)].add(xyz[i]);
  }
  return result;
}

template <std::size_t kCount>
void expect_unbiased() {
  const RgbColorSpace& space = rgb_color_space("srgb");
  const std::array<SpectralDistribution, 4> spectra = {
      SpectralDistribution(1.0), SpectralDistribution(BlackbodySpectrum(3000)),
      SpectralDistribution(RgbSpectrum::unbounded({5, 0.5, 0.1}, space)),
      SpectralDistribution(RgbSpectrum::illuminant({0.2, 0.3, 0.9}, space))};
  // 4 spectra, 3 densities, 3 components, 3 numbers of wavelengths.
  const double threshold = testing::family_wise_threshold(1e-3, 108);
  uint32_t stream = kCount * 100;
  for (std::size_t i = 0; i < spectra.size(); ++i) {
    const Vec3d expected = observe(spectra[i]);
    for (const WavelengthDensity density : kDensities) {
      const auto found = estimates<kCount>(spectra[i], density, stream++);
      for (int component = 0; component < 3; ++component) {
        const std::string name = "spectrum " + std::to_string(i) + ", " + name_of(density) + ", " +
                                 std::string(1, "XYZ"[component]) + ", " + std::to_string(kCount);
        EXPECT_TRUE(check_mean(name, found[static_cast<std::size_t>(component)],
                               expected[component],
                               {.z = threshold,
                                .absolute = 1e-6 * expected[component],  // of the quadrature
                                .largest_relative_error = 0.01}));
      }
    }
  }
}

TEST(EstimateXyz, IsUnbiasedWithOneWavelength) { expect_unbiased<1>(); }
TEST(EstimateXyz, IsUnbiasedWithFourWavelengths) { expect_unbiased<4>(); }
TEST(EstimateXyz, IsUnbiasedWithEightWavelengths) { expect_unbiased<8>(); }

TEST(EstimateXyz, AnErrorOfOnePercentWouldBeNoticed) {
  const SpectralDistribution lamp(BlackbodySpectrum(3000));
  const Vec3d wrong = observe(lamp) * 1.01;
  const auto found = estimates<4>(lamp, WavelengthDensity::kVisible, 4);
  for (int component = 0; component < 3; ++component) {
    EXPECT_FALSE(
        check_mean("planted", found[static_cast<std::size_t>(component)], wrong[component]));
  }
}

// But for its part of the visible density, all wavelengths add as much to R, G and B together: no
// density has less variance of equal radiances.
TEST(EstimateXyz, FilmDensityLowersTheVarianceOfColours) {
  const RgbChromaticities srgb;
  const Matrix3d to_rgb = rgb_to_xyz_matrix(srgb.primaries, srgb.white).inverse(true);
  const auto rgb = [&](double wavelength) { return color_matching(wavelength) * to_rgb; };
  const auto film_part = [&](double wavelength) {
    return wavelength_pdf(wavelength, WavelengthDensity::kFilm) -
           kFilmVisiblePart * wavelength_pdf(wavelength, WavelengthDensity::kVisible);
  };
  const double expected = film_part(550.5) / rgb(550.5).length();
  double film = 0;
  double visible = 0;
  for (double wavelength = 380.5; wavelength < 780; ++wavelength) {
    EXPECT_NEAR(film_part(wavelength) / rgb(wavelength).length(), expected, 0.01 * expected);
    film += rgb(wavelength).length2() / wavelength_pdf(wavelength, WavelengthDensity::kFilm);
    visible += rgb(wavelength).length2() / wavelength_pdf(wavelength, WavelengthDensity::kVisible);
  }
  EXPECT_LT(film, 0.78 * visible);
}

// Small pictures share 64 wavelengths, whose sum may not tinge them.
TEST(EstimateXyz, FewEquidistantWavelengthsSumUpWhite) {
  constexpr int kNodes = 64;
  const Vec3d white = observe([](double) { return 1.0; });
  for (const WavelengthDensity density : {WavelengthDensity::kVisible, WavelengthDensity::kFilm}) {
    for (const double shift : {0.1, 0.45, 0.8}) {
      Vec3d sum(0);
      for (int i = 0; i < kNodes; ++i) {
        const auto wavelengths = sample_wavelengths<1>((i + shift) / kNodes, density);
        sum += estimate_xyz(std::array<double, 1>{1.0}, wavelengths) / kNodes;
      }
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / white[c], 1, 1e-3) << name_of(density);
    }
  }
}

TEST(EstimateXyz, VisibleDensityAndStratificationLowerTheVariance) {
  const SpectralDistribution white = 1.0;
  const double uniform = estimates<1>(white, WavelengthDensity::kUniform, 1)[1].variance();
  const double visible = estimates<1>(white, WavelengthDensity::kVisible, 2)[1].variance();
  const double four = estimates<4>(white, WavelengthDensity::kVisible, 3)[1].variance();
  EXPECT_LT(visible, 0.7 * uniform);
  EXPECT_LT(four, 0.25 * visible);  // better than four independent ones
}

}  // namespace
}  // namespace freepath
