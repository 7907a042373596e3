#pragma once
/// @file The illuminants that the CIE defines [Cie04]. All are relative spectral power
/// distributions scaled to a luminance (Y) of 1, by wavelength in nm.

#include "freepath/spectra/cie_observer.h"
#include "freepath/spectra/linear_spectrum.h"

namespace freepath {

/// A spectrum scaled to a luminance (Y) of 1.
/// @throws Error if its luminance is not positive
LinearSpectrum normalized_to_luminance(const LinearSpectrum& spectrum);

/// Standard illuminant A, a lamp with a tungsten filament.
LinearSpectrum illuminant_a();

/// Illuminant E: equal power at all wavelengths.
LinearSpectrum illuminant_e();

/// Standard illuminants D50 and D65, phases of daylight.
LinearSpectrum illuminant_d50();
LinearSpectrum illuminant_d65();

/// Daylight of a chromaticity on or near the daylight locus, from the CIE's components of daylight.
LinearSpectrum daylight(const Chromaticity& chromaticity);

/// The daylight of a correlated colour temperature.
/// @param temperature [K], from 4000 to 25000
/// @throws Error outside that range
Chromaticity daylight_chromaticity(double temperature);

/// Illuminants F1 to F12, fluorescent lamps.
/// @throws Error for another number
LinearSpectrum illuminant_f(int number);

}  // namespace freepath
