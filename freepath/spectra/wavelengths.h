#pragma once
/// @file Random wavelengths for a path, and the colour of what it carries.

#include <array>
#include <cmath>
#include <cstddef>

#include "freepath/base/vector.h"
#include "freepath/spectra/cie_observer.h"

namespace freepath {

/// How a wavelength is drawn.
enum class WavelengthDensity {
  kUniform,
  kVisible,  ///< Density in proportion to sech²(0.0072 (λ - 538 nm)) [Radziszewski09].
  /// For the most part in proportion to the length of what a wavelength adds to R, G and B of sRGB,
  /// so that all add as much: the density of least variance, in R, G and B together, of equal
  /// radiances. For kFilmVisiblePart it is kVisible, which makes what samples add vary smoothly
  /// from end to end, so that few equidistant ones sum it up well.
  kFilm,
};

inline constexpr double kFilmVisiblePart = 0.3;

/// Probability per nanometre of drawing a wavelength [1/nm]; its integral over the rendered
/// wavelengths is 1, and it is 0 outside.
double wavelength_pdf(double wavelength, WavelengthDensity density);

/// The wavelength below which the fraction u in [0, 1) of the probability lies [nm].
double sample_wavelength(double u, WavelengthDensity density);

/// The wavelengths that a path carries.
template <std::size_t kMost>
struct Wavelengths {
  std::size_t count = 0;
  std::array<double, kMost> lambda{};  ///< [nm]; the first is the hero.
  std::array<double, kMost> pdf{};     ///< Density of each alone [1/nm].
};

/// A hero wavelength drawn by u, and the others at equal distances of probability from it, going
/// round at the end [Wilkie14]. Each alone has the density's distribution, and together
/// they stratify it.
/// @param u [0, 1)
/// @param count at most kMost
template <std::size_t kMost>
Wavelengths<kMost> sample_wavelengths(double u, WavelengthDensity density,
                                      std::size_t count = kMost) {
  Wavelengths<kMost> result;
  result.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    double rotated = u + static_cast<double>(i) / static_cast<double>(count);
    if (rotated >= 1) rotated -= 1;
    result.lambda[i] = sample_wavelength(rotated, density);
    result.pdf[i] = wavelength_pdf(result.lambda[i], density);
  }
  return result;
}

/// X, Y, Z of the radiance that a path carries at its wavelengths, with Y = 1 for a radiance of 1
/// at all wavelengths. Unbiased if the radiances are, for wavelengths from sample_wavelengths.
template <std::size_t kMost>
Vec3d estimate_xyz(const std::array<double, kMost>& radiance,
                   const Wavelengths<kMost>& wavelengths) {
  Vec3d sum(0);
  for (std::size_t i = 0; i < wavelengths.count; ++i) {
    sum += color_matching(wavelengths.lambda[i]) * (radiance[i] / wavelengths.pdf[i]);
  }
  return sum / (static_cast<double>(wavelengths.count) * kLuminousIntegral);
}

}  // namespace freepath
