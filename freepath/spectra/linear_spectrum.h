#pragma once
/// @file Spectra given by samples.

#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace freepath {

/// What a sampled spectrum is where it has no samples.
enum class OutsideSamples {
  kHold,  ///< What it is at the nearest sample.
  kZero,
};

/// A function of wavelength whose samples are connected by straight lines. Copies share the
/// samples.
class LinearSpectrum {
 public:
  /// @param wavelengths increasing [nm]
  /// @param values as many
  /// @throws Error unless there is a sample, all are finite and the wavelengths increase
  LinearSpectrum(std::vector<double> wavelengths, std::vector<double> values,
                 OutsideSamples outside = OutsideSamples::kHold);

  /// The value at a wavelength [nm].
  double operator()(double wavelength) const;

  /// [nm]
  std::span<const double> wavelengths() const { return samples_->wavelengths; }
  std::span<const double> values() const { return samples_->values; }
  OutsideSamples outside() const { return samples_->outside; }

  /// This, with all values multiplied by a factor.
  LinearSpectrum scaled(double factor) const;

 private:
  struct Samples {
    std::vector<double> wavelengths, values;
    OutsideSamples outside = OutsideSamples::kHold;
    double inverse_step = 0;  ///< [1/nm] of samples at equal distances, else 0.
  };
  std::shared_ptr<const Samples> samples_;
};

/// Samples of a function at equally spaced wavelengths [nm].
template <class Function>
LinearSpectrum sample_spectrum(const Function& function, int first, int last, int step,
                               OutsideSamples outside = OutsideSamples::kHold) {
  std::vector<double> wavelengths, values;
  for (int wavelength = first; wavelength <= last; wavelength += step) {
    wavelengths.push_back(wavelength);
    values.push_back(function(static_cast<double>(wavelength)));
  }
  return {std::move(wavelengths), std::move(values), outside};
}

}  // namespace freepath
