#include "freepath/spectra/spectrum_table.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace freepath {
namespace {

constexpr double kSodiumLine = 589.3;  // [nm], where refractive indices are tabulated

Vec3d reflected_rgb(const SpectralDistribution& spectrum, const RgbColorSpace& space) {
  Vec3d rgb(0);
  const auto weights = space.reflectance_weights();
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double wavelength =
        kShortestWavelength + RgbColorSpace::kNodeDistance * static_cast<double>(i);
    rgb += weights[i] * spectrum(wavelength);
  }
  return rgb;
}

SampledSpectrum to_channels(const Vec3d& rgb) {
  return {static_cast<float>(rgb.x), static_cast<float>(rgb.y), static_cast<float>(rgb.z)};
}

SampledSpectrum to_channels(const std::array<double, kMaxChannels>& values) {
  SampledSpectrum channels;
  for (int i = 0; i < kMaxChannels; ++i) channels[i] = static_cast<float>(values[i]);
  return channels;
}

SampledSpectrum seen_rgb_of(const SpectralDistribution& spectrum, SpectrumRole role,
                            const RgbColorSpace& space) {
  if (role == SpectrumRole::kIndex)
    return SampledSpectrum(static_cast<float>(spectrum(kSodiumLine)));
  if (std::holds_alternative<ConstantSpectrum>(spectrum.kind()) &&
      role == SpectrumRole::kReflectance) {
    const auto value = static_cast<float>(spectrum(kSodiumLine));
    return {value, value, value};
  }
  return to_channels(role == SpectrumRole::kReflectance ? reflected_rgb(spectrum, space)
                                                        : space.from_xyz(observe(spectrum)));
}

bool same_white(const RgbColorSpace& a, const RgbColorSpace& b) {
  return a.white().x == b.white().x && a.white().y == b.white().y;
}

/// What a spectrum is in R, G, B: the colour that it was made of, if it was made of one. Only its
/// spectrum says what a surface looks like under another white.
SampledSpectrum rgb_of(const SpectralDistribution& spectrum, SpectrumRole role,
                       const RgbColorSpace& space) {
  const auto* const made = std::get_if<RgbSpectrum>(&spectrum.kind());
  const bool light = role == SpectrumRole::kIlluminant;
  if (made == nullptr || role == SpectrumRole::kIndex || made->is_light() != light) {
    return seen_rgb_of(spectrum, role, space);
  }
  const Vec3d rgb = made->rgb() * spectrum.factor();
  if (&made->space() == &space || made->is_constant()) return to_channels(rgb);
  if (!light && !same_white(made->space(), space)) return seen_rgb_of(spectrum, role, space);
  return to_channels(space.from_xyz(made->space().to_xyz(rgb)));
}

const RgbColorSpace& texture_space() { return rgb_color_space("srgb"); }

const LightTable& texture_lights() {
  static const LightTable kLights(texture_space());
  return kLights;
}

}  // namespace

SpectrumTable::SpectrumTable(const RgbColorSpace& space)
    : space_(space),
      red_(RgbSpectrum::reflectance({1, 0, 0}, texture_space())),
      blue_(RgbSpectrum::reflectance({0, 0, 1}, texture_space())) {
  add(SpectralDistribution(0), SpectrumRole::kReflectance);
}

float SpectrumValues::value_of(const SpectralDistribution& spectrum, SpectrumRole role,
                               int channel) const {
  if (is_spectral()) return static_cast<float>(spectrum(wavelengths_[channel]));
  return rgb_of(spectrum, role, *space_)[channel];
}

SpectrumId SpectrumTable::add(const SpectralDistribution& spectrum, SpectrumRole role) {
  entries_.push_back(
      {spectrum, role, rgb_of(spectrum, role, space_), seen_rgb_of(spectrum, role, space_)});
  return {static_cast<uint32_t>(entries_.size() - 1)};
}

bool SpectrumTable::is_constant(SpectrumId id) const {
  const SpectralDistribution::Kind& kind = entries_[id.index].spectrum.kind();
  if (std::holds_alternative<ConstantSpectrum>(kind)) return true;
  if (const auto* const linear = std::get_if<LinearSpectrum>(&kind)) {
    const auto values = linear->values();
    return linear->outside() == OutsideSamples::kHold &&
           std::all_of(values.begin(), values.end(),
                       [&](double value) { return value == values.front(); });
  }
  if (const auto* const rgb = std::get_if<RgbSpectrum>(&kind)) return rgb->is_constant();
  return false;
}

SpectrumValues SpectrumTable::in_rgb() const {
  SpectrumValues values;
  values.keeps_colours_ = &space_ == &texture_space();
  for (const Entry& entry : entries_) values.values_.push_back(entry.rgb);
  for (int i = 0; i < 3; ++i) {
    Vec3d unit(0);
    unit[i] = 1;
    values.reflectance_basis_[i] = values.keeps_colours_
                                       ? to_channels(unit)
                                       : to_channels(space_.from_xyz(texture_space().to_xyz(unit)));
    values.to_rgb_[i] = Vec3f(unit);
  }
  // Times channels that are 0, but must not be NaN.
  std::fill(values.to_rgb_.begin() + 3, values.to_rgb_.end(), Vec3f(0));
  values.channels_ = 3;
  values.space_ = &space_;
  return values;
}

SpectrumValues SpectrumTable::seen_in_rgb() const {
  SpectrumValues values = in_rgb();
  for (std::size_t i = 0; i < entries_.size(); ++i) values.values_[i] = entries_[i].seen;
  values.lights_ = &texture_lights();
  values.keeps_colours_ = false;
  return values;
}

SpectrumValues SpectrumTable::at(const PathWavelengths& wavelengths) const {
  SpectrumValues values;
  values.values_.reserve(entries_.size());
  for (const Entry& entry : entries_) {
    values.values_.push_back(to_channels(entry.spectrum.at(wavelengths.lambda, wavelengths.count)));
  }
  values.channels_ = static_cast<int>(wavelengths.count);
  values.to_rgb_.fill(Vec3f(0));
  const LinearSpectrum& white = texture_space().illuminant();
  for (int i = 0; i < values.channels_; ++i) {
    const double lambda = wavelengths.lambda[i];
    // Red and blue are smooth fits; green is what they leave of white, so that greys are constant
    // and every colour comes back exactly. It falls to -0.03 where little is seen, near 420 nm.
    const double red = red_(lambda);
    const double blue = blue_(lambda);
    const double green = 1 - red - blue;
    const double mix[3] = {red, green, blue};
    for (int c = 0; c < 3; ++c) {
      values.reflectance_basis_[c][i] = static_cast<float>(mix[c]);
    }
    values.white_[i] = static_cast<float>(white(lambda));
    values.coordinates_[i] = static_cast<float>(SigmoidPolynomial::coordinate(lambda));
    const Vec3d xyz =
        color_matching(lambda) /
        (wavelengths.pdf[i] * static_cast<double>(values.channels_) * kLuminousIntegral);
    values.to_rgb_[i] = Vec3f(space_.from_xyz(xyz));
  }
  values.lights_ = &texture_lights();
  values.wavelengths_ = wavelengths.lambda;
  values.space_ = &space_;
  return values;
}

}  // namespace freepath
