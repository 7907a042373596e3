#include "freepath/spectra/wavelengths.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "freepath/base/rgb_primaries.h"

namespace freepath {
namespace {

constexpr double kSteepness = 0.0072;  // [1/nm]
constexpr double kCentre = 538;        // [nm]

/// tanh of the scaled distance from the centre: the integral of its sech², but for a factor.
double visible_integral(double wavelength) {
  return std::tanh(kSteepness * (wavelength - kCentre));
}

double visible_first() {
  static const double kValue = visible_integral(kShortestWavelength);
  return kValue;
}

/// The integral over all rendered wavelengths.
double visible_total() {
  static const double kValue = visible_integral(kLongestWavelength) - visible_first();
  return kValue;
}

/// kFilm, constant between the wavelengths that the observer is tabulated at.
struct FilmDensity {
  static constexpr std::size_t kParts = kObserverNodes - 1;
  std::array<double, kParts> pdf{};            // [1/nm]
  std::array<double, kParts + 1> integrals{};  // up to the beginning of each part, and to the end

  FilmDensity() {
    const RgbChromaticities srgb;
    const Matrix3d to_rgb = rgb_to_xyz_matrix(srgb.primaries, srgb.white).inverse(true);
    for (std::size_t i = 0; i < kParts; ++i) {
      const Vec3d middle = color_matching(observer_node(i) + 0.5) * to_rgb;
      integrals[i + 1] = integrals[i] + middle.length();
    }
    const double total = integrals.back();
    for (std::size_t i = 0; i <= kParts; ++i) {
      const double visible =
          (visible_integral(observer_node(i)) - visible_first()) / visible_total();
      integrals[i] = std::lerp(integrals[i] / total, visible, kFilmVisiblePart);
    }
    for (std::size_t i = 0; i < kParts; ++i) pdf[i] = integrals[i + 1] - integrals[i];
  }
  std::size_t part_of(double wavelength) const {
    return std::min(static_cast<std::size_t>(wavelength - kShortestWavelength), kParts - 1);
  }
  double sample(double u) const {
    const auto above = std::upper_bound(integrals.begin() + 1, integrals.end() - 1, u);
    const auto part = static_cast<std::size_t>(above - integrals.begin()) - 1;
    return observer_node(part) + std::clamp((u - integrals[part]) / pdf[part], 0.0, 1.0);
  }
};

const FilmDensity& film_density() {
  static const FilmDensity kDensity;
  return kDensity;
}

}  // namespace

double wavelength_pdf(double wavelength, WavelengthDensity density) {
  if (!(wavelength >= kShortestWavelength && wavelength <= kLongestWavelength)) return 0;
  if (density == WavelengthDensity::kUniform) return 1 / (kLongestWavelength - kShortestWavelength);
  if (density == WavelengthDensity::kFilm) {
    return film_density().pdf[film_density().part_of(wavelength)];
  }
  const double sech = 1 / std::cosh(kSteepness * (wavelength - kCentre));
  return kSteepness * sech * sech / visible_total();
}

double sample_wavelength(double u, WavelengthDensity density) {
  double wavelength = 0;
  if (density == WavelengthDensity::kUniform) {
    wavelength = kShortestWavelength + u * (kLongestWavelength - kShortestWavelength);
  } else if (density == WavelengthDensity::kFilm) {
    wavelength = film_density().sample(u);
  } else {
    const double integral = visible_first() + u * visible_total();
    wavelength = kCentre + std::atanh(integral) / kSteepness;
  }
  // Rounding may lead past the ends, where the density is 0.
  return std::clamp(wavelength, kShortestWavelength, kLongestWavelength);
}

}  // namespace freepath
