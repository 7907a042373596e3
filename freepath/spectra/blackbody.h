#pragma once
/// @file Thermal radiation.

namespace freepath {

/// Radiance of a black body per metre of wavelength, Planck's law [W/(m² sr m)]. Never overflows or
/// is NaN: 0 where it is below the smallest number, and at 0 K.
/// @param wavelength [nm], > 0
/// @param temperature [K], >= 0
double planck_radiance(double wavelength, double temperature);

/// The wavelength at which Planck's law has its maximum, by Wien's displacement law [nm].
/// @param temperature [K], > 0
double planck_peak(double temperature);

/// What a black body's spectrum is multiplied by.
enum class BlackbodyScale {
  kRadiance,  ///< 1: radiance per metre of wavelength [W/(m² sr m)].
  kPeak,      ///< The inverse of the maximum over all wavelengths, the convention of pbrt's scenes.
};

class BlackbodySpectrum {
 public:
  /// @param temperature [K]
  /// @throws Error unless it is finite and positive
  explicit BlackbodySpectrum(double temperature, BlackbodyScale scale = BlackbodyScale::kPeak);

  /// @param wavelength [nm]
  double operator()(double wavelength) const {
    return factor_ * planck_radiance(wavelength, temperature_);
  }
  /// [K]
  double temperature() const { return temperature_; }

 private:
  double temperature_;
  double factor_ = 1;
};

}  // namespace freepath
