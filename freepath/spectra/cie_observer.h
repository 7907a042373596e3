#pragma once
/// @file The CIE 1931 standard colorimetric observer: from spectra to tristimulus values.

#include <cstddef>

#include "freepath/base/rgb_primaries.h"
#include "freepath/base/vector.h"
#include "freepath/spectra/cie_1931_table.h"

namespace freepath {

/// The wavelengths that are rendered: outside them the observer sees next to nothing [nm].
inline constexpr double kShortestWavelength = 360;
inline constexpr double kLongestWavelength = 830;

/// The colour matching functions x, y, z at a wavelength [nm], linear between those that the CIE
/// tabulates every nanometre, 0 outside [Cie06].
Vec3d color_matching(double wavelength);

/// The quadrature over wavelengths: the trapezoidal rule with a node every nanometre.
inline constexpr std::size_t kObserverNodes = kCie1931Table.size();
constexpr double observer_node(std::size_t i) {  // [nm]
  return kShortestWavelength + static_cast<double>(i);
}
constexpr double observer_node_width(std::size_t i) {  // [nm]
  return i == 0 || i + 1 == kObserverNodes ? 0.5 : 1.0;
}

/// The integral of y, which makes a constant spectrum 1 have Y = 1 [nm].
inline constexpr double kLuminousIntegral = [] {
  double sum = 0;
  for (std::size_t i = 0; i < kObserverNodes; ++i) {
    sum += kCie1931Table[i][1] * observer_node_width(i);
  }
  return sum;
}();

/// What node i of the quadrature contributes to X, Y, Z of a spectrum that is 1 there.
inline Vec3d observer_weight(std::size_t i) {
  const auto& [x, y, z] = kCie1931Table[i];
  return Vec3d(x, y, z) * (observer_node_width(i) / kLuminousIntegral);
}

/// X, Y, Z of a spectrum: its integrals over the colour matching functions, divided by that of y.
template <class Spectrum>
Vec3d observe(const Spectrum& spectrum) {
  Vec3d xyz(0);
  for (std::size_t i = 0; i < kObserverNodes; ++i) {
    xyz += observer_weight(i) * spectrum(observer_node(i));
  }
  return xyz;
}

/// Y of a spectrum.
template <class Spectrum>
double luminance_of(const Spectrum& spectrum) {
  return observe(spectrum).y;
}

Chromaticity chromaticity_of(const Vec3d& xyz);

}  // namespace freepath
