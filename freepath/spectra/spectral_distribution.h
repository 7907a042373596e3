#pragma once
/// @file Any function of wavelength that a scene can give.

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <variant>

#include "freepath/spectra/blackbody.h"
#include "freepath/spectra/linear_spectrum.h"
#include "freepath/spectra/rgb_spectrum.h"

namespace freepath {

struct ConstantSpectrum {
  double value = 0;

  double operator()(double /*wavelength*/) const { return value; }
};

/// One of the kinds of spectra, times a factor. Copies are cheap: they share samples.
class SpectralDistribution {
 public:
  using Kind = std::variant<ConstantSpectrum, LinearSpectrum, BlackbodySpectrum, RgbSpectrum>;

  SpectralDistribution(double value = 0) : kind_(ConstantSpectrum{value}) {}
  template <class Spectrum>
  requires std::is_constructible_v<Kind, Spectrum> &&
      (!std::is_arithmetic_v<Spectrum>)SpectralDistribution(Spectrum spectrum)
      : kind_(std::move(spectrum)) {}

  /// The value at a wavelength [nm].
  double operator()(double wavelength) const {
    return factor_ *
           std::visit([wavelength](const auto& spectrum) { return spectrum(wavelength); }, kind_);
  }

  /// The values at the first `count` of wavelengths [nm]; the kind is looked up once for all of
  /// them.
  template <std::size_t kMost>
  std::array<double, kMost> at(const std::array<double, kMost>& wavelengths,
                               std::size_t count = kMost) const {
    std::array<double, kMost> values{};
    std::visit(
        [&](const auto& spectrum) {
          for (std::size_t i = 0; i < count; ++i) values[i] = factor_ * spectrum(wavelengths[i]);
        },
        kind_);
    return values;
  }

  SpectralDistribution scaled(double factor) const {
    SpectralDistribution result = *this;
    result.factor_ *= factor;
    return result;
  }

  const Kind& kind() const { return kind_; }
  double factor() const { return factor_; }

  /// The largest of the values at every nanometre of the rendered wavelengths and at every sample
  /// among them: the maximum of what is constant or sampled, and very near it of other kinds.
  double largest() const;

 private:
  Kind kind_;
  double factor_ = 1;
};

}  // namespace freepath
