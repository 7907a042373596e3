#pragma once
/// @file The channels of a picture of spectra.

#include <string>

#include "freepath/spectra/cie_observer.h"

namespace freepath {

/// Intervals of wavelengths, of equal width, in which a film gathers spectral radiance.
struct WavelengthBuckets {
  int count = 0;                       ///< 0: none.
  double first = kShortestWavelength;  ///< Where they begin [nm].
  double last = kLongestWavelength;    ///< Where they end [nm].

  /// The one that holds a wavelength [nm], or -1.
  int bucket_of(double wavelength) const;
  /// What a picture calls its channel: "S0." and the wavelength in its middle, with a decimal
  /// comma, as in "S0.374,687500nm" [Fichet21].
  std::string channel(int bucket) const;

  bool operator==(const WavelengthBuckets&) const = default;
};

}  // namespace freepath
