#pragma once
/// @file Refractive indices of glasses and metals, by wavelength in nm.

#include <array>
#include <complex>

#include "freepath/spectra/linear_spectrum.h"

namespace freepath {

/// Coefficients of the Sellmeier equation n² = 1 + sum of b_i λ² / (λ² - c_i).
struct Sellmeier {
  std::array<double, 3> b;
  std::array<double, 3> c;  ///< [µm²]

  /// The refractive index at a wavelength [nm].
  double operator()(double wavelength) const;
};

// As Schott AG publishes them in its catalogues of optical glass [Schott23].
inline constexpr Sellmeier kGlassBk7 = {{1.03961212, 0.231792344, 1.01046945},
                                        {0.00600069867, 0.0200179144, 103.560653}};
inline constexpr Sellmeier kGlassBaf10 = {{1.5851495, 0.143559385, 1.08521269},
                                          {0.00926681282, 0.0424489805, 105.613573}};
inline constexpr Sellmeier kGlassFk51a = {{0.971247817, 0.216901417, 0.904651666},
                                          {0.00472301995, 0.0153575612, 168.68133}};
inline constexpr Sellmeier kGlassLasf9 = {{2.00029547, 0.298926886, 1.80691843},
                                          {0.0121426017, 0.0538736236, 156.530829}};
inline constexpr Sellmeier kGlassSf5 = {{1.46141885, 0.247713019, 0.949995832},
                                        {0.0111826126, 0.0508594669, 112.041888}};
inline constexpr Sellmeier kGlassSf10 = {{1.61625977, 0.259229334, 1.07762317},
                                         {0.0127534559, 0.0581983954, 116.60768}};
inline constexpr Sellmeier kGlassSf11 = {{1.73848403, 0.311168974, 1.17490871},
                                         {0.0136068604, 0.0615960463, 121.922711}};

/// Magnesium oxide, a crystal without absorption [Stephens52].
double magnesium_oxide_index(double wavelength);

/// Titanium dioxide (rutile, ordinary ray) [DeVore51].
double titanium_dioxide_index(double wavelength);

/// Aluminium, by the Lorentz-Drude model fitted to measurements [Rakic98]: n + i k.
std::complex<double> aluminium_index(double wavelength);

/// A metal's index n + i k, as two spectra.
struct MetalIndex {
  LinearSpectrum eta;  ///< n
  LinearSpectrum k;
};

/// Measurements on films [Johnson72].
MetalIndex copper_index();
MetalIndex silver_index();
MetalIndex gold_index();

}  // namespace freepath
