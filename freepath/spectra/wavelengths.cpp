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

/// kFilm, linear between the wavelengths that the observer is tabulated at.
class FilmDensity {
 public:
  FilmDensity() {
    const RgbChromaticities srgb;
    const Matrix3d to_rgb = rgb_to_xyz_matrix(srgb.primaries, srgb.white).inverse(true);
    double sum = 0;
    for (std::size_t i = 0; i < kObserverNodes; ++i) {
      pdf_[i] = (color_matching(observer_node(i)) * to_rgb).length();
      sum += pdf_[i] * observer_node_width(i);
    }
    for (std::size_t i = 0; i < kObserverNodes; ++i) {
      const double visible = wavelength_pdf(observer_node(i), WavelengthDensity::kVisible);
      pdf_[i] = std::lerp(pdf_[i] / sum, visible, kFilmVisiblePart);
    }
    for (std::size_t i = 0; i < kParts; ++i) {
      integrals_[i + 1] = integrals_[i] + (pdf_[i] + pdf_[i + 1]) / 2;
    }
    const double total = integrals_.back();
    for (double& value : pdf_) value /= total;
    for (double& value : integrals_) value /= total;
  }

  double at(double wavelength) const {
    const double way = wavelength - kShortestWavelength;
    const std::size_t part = std::min(static_cast<std::size_t>(way), kParts - 1);
    return std::lerp(pdf_[part], pdf_[part + 1], way - static_cast<double>(part));
  }

  double sample(double u) const {
    const auto above = std::upper_bound(integrals_.begin() + 1, integrals_.end() - 1, u);
    const auto part = static_cast<std::size_t>(above - integrals_.begin()) - 1;
    const double left = std::max(u - integrals_[part], 0.0);
    const double begin = pdf_[part];
    const double root = std::sqrt(begin * begin + 2 * left * (pdf_[part + 1] - begin));
    return observer_node(part) + std::min(2 * left / (begin + root), 1.0);
  }

 private:
  static constexpr std::size_t kParts = kObserverNodes - 1;
  std::array<double, kObserverNodes> pdf_{};        // [1/nm]
  std::array<double, kObserverNodes> integrals_{};  // up to each
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
    return film_density().at(wavelength);
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
