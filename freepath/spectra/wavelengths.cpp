#include "freepath/spectra/wavelengths.h"

#include <algorithm>

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

}  // namespace

double wavelength_pdf(double wavelength, WavelengthDensity density) {
  if (!(wavelength >= kShortestWavelength && wavelength <= kLongestWavelength)) return 0;
  if (density == WavelengthDensity::kUniform) return 1 / (kLongestWavelength - kShortestWavelength);
  const double sech = 1 / std::cosh(kSteepness * (wavelength - kCentre));
  return kSteepness * sech * sech / visible_total();
}

double sample_wavelength(double u, WavelengthDensity density) {
  double wavelength = 0;
  if (density == WavelengthDensity::kUniform) {
    wavelength = kShortestWavelength + u * (kLongestWavelength - kShortestWavelength);
  } else {
    const double integral = visible_first() + u * visible_total();
    wavelength = kCentre + std::atanh(integral) / kSteepness;
  }
  // Rounding may lead past the ends, where the density is 0.
  return std::clamp(wavelength, kShortestWavelength, kLongestWavelength);
}

}  // namespace freepath
