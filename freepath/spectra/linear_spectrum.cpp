#include "freepath/spectra/linear_spectrum.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "freepath/base/counted.h"
#include "freepath/base/error.h"

namespace freepath {
namespace {

/// The inverse of the distance of samples that stand exactly at first + step * index, else 0.
double find_inverse_step(std::span<const double> wavelengths) {
  if (wavelengths.size() < 2) return 0;
  const double step = wavelengths[1] - wavelengths[0];
  for (std::size_t i = 0; i < wavelengths.size(); ++i) {
    if (wavelengths[i] != wavelengths[0] + step * static_cast<double>(i)) return 0;
  }
  return 1 / step;
}

}  // namespace

LinearSpectrum::LinearSpectrum(std::vector<double> wavelengths, std::vector<double> values,
                               OutsideSamples outside) {
  if (wavelengths.empty()) fail("a sampled spectrum needs at least one wavelength and value");
  if (wavelengths.size() != values.size()) {
    fail("a sampled spectrum has {} but {}", counted(wavelengths.size(), "wavelength"),
         counted(values.size(), "value"));
  }
  for (std::size_t i = 0; i < wavelengths.size(); ++i) {
    if (!std::isfinite(wavelengths[i]) || !std::isfinite(values[i])) {
      fail("sample {} of a spectrum is not finite: {} nm, {}", i, wavelengths[i], values[i]);
    }
    if (i > 0 && wavelengths[i] <= wavelengths[i - 1]) {
      fail("the wavelengths of a sampled spectrum have to increase: {} nm follows {} nm",
           wavelengths[i], wavelengths[i - 1]);
    }
  }
  const double inverse_step = find_inverse_step(wavelengths);
  samples_ = std::make_shared<const Samples>(
      Samples{std::move(wavelengths), std::move(values), outside, inverse_step});
}

double LinearSpectrum::operator()(double wavelength) const {
  const std::vector<double>& wavelengths = samples_->wavelengths;
  const std::vector<double>& values = samples_->values;
  const bool is_outside = !(wavelength >= wavelengths.front() && wavelength <= wavelengths.back());
  if (is_outside && samples_->outside == OutsideSamples::kZero) return 0;
  if (wavelength >= wavelengths.back()) return values.back();
  if (!(wavelength > wavelengths.front())) return values.front();
  std::size_t right = 0;
  if (samples_->inverse_step > 0) {
    const double position = (wavelength - wavelengths.front()) * samples_->inverse_step;
    right = std::min(static_cast<std::size_t>(position) + 1, wavelengths.size() - 1);
  } else {
    right = static_cast<std::size_t>(std::ranges::upper_bound(wavelengths, wavelength) -
                                     wavelengths.begin());
  }
  const double share =
      (wavelength - wavelengths[right - 1]) / (wavelengths[right] - wavelengths[right - 1]);
  return values[right - 1] + share * (values[right] - values[right - 1]);
}

LinearSpectrum LinearSpectrum::scaled(double factor) const {
  std::vector<double> values = samples_->values;
  for (double& value : values) value *= factor;
  return {samples_->wavelengths, std::move(values), samples_->outside};
}

}  // namespace freepath
