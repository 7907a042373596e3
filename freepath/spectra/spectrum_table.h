#pragma once
/// @file All spectra of a scene, and what they are in the channels of a path.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/vector.h"
#include "freepath/spectra/light_table.h"
#include "freepath/spectra/rgb_color_space.h"
#include "freepath/spectra/spectral_distribution.h"
#include "freepath/spectra/wavelengths.h"

namespace freepath {

/// What a spectrum is of, which decides what it is in R, G, B.
enum class SpectrumRole {
  kReflectance,  ///< Factors and coefficients: the colour of a surface under the space's white.
  kIlluminant,   ///< Light: the colour that the observer sees.
  kIndex,        ///< Refractive indices: the value at 589.3 nm (the sodium line), in all channels.
};

/// A spectrum of a SpectrumTable. The standard one is black.
struct SpectrumId {
  uint32_t index = 0;

  bool operator==(const SpectrumId&) const = default;
};

/// A path's wavelengths in spectral rendering; the first channel need not be their hero.
using PathWavelengths = Wavelengths<kMaxChannels>;

/// The spectra of a table in the channels of a path: R, G, B, or its wavelengths. Cheap to read: a
/// spectrum is evaluated once for all paths that share wavelengths.
class SpectrumValues {
 public:
  const SampledSpectrum& operator[](SpectrumId id) const { return values_[id.index]; }

  /// A colour of a texture (sRGB's primaries, linear) as a reflectance or coefficient: a mixture of
  /// three basis spectra, whose colour comes back exactly. One multiplication per channel and
  /// component, where the smooth fit (RgbSpectrum) would take a table of all three dimensions.
  SampledSpectrum reflectance(const Vec3f& rgb) const { return mix(reflectance_basis_, rgb); }
  /// A colour of an image (sRGB's primaries, linear) as emitted light: what RgbSpectrum::illuminant
  /// is of it, or in R, G, B the colour itself or what is seen of that spectrum.
  /// @param rgb finite and not negative
  SampledSpectrum illuminant(const Vec3f& rgb) const {
    if (keeps_colours_) return {rgb.x, rgb.y, rgb.z};
    if (!lights_) return mix(reflectance_basis_, rgb);
    if (!is_spectral()) return mix(reflectance_basis_, lights_->seen(rgb));
    return light(lights_->light(rgb));
  }

  /// Channels that are in use: 3 of R, G, B, or one for each wavelength. All others are 0.
  int channels() const { return channels_; }
  /// Whether the channels are wavelengths.
  bool is_spectral() const { return wavelengths_[0] > 0; }

  /// The colour of what a path carries, R, G, B of the table's space: an unbiased estimate for
  /// wavelengths that are drawn as sample_wavelengths does.
  Vec3f to_rgb(const SampledSpectrum& radiance) const {
    Vec3f rgb(0);
    for (int i = 0; i < kMaxChannels; ++i) rgb += to_rgb_[i] * radiance[i];
    return rgb;
  }

  /// Value of one channel of a spectrum that is in no table.
  float value_of(const SpectralDistribution& spectrum, SpectrumRole role, int channel) const;
  /// R, G, B of the table's space.
  Vec3d rgb_of_xyz(const Vec3d& xyz) const { return space_->from_xyz(xyz); }

  /// Wavelengths of the channels [nm]; all 0 of R, G, B.
  const std::array<double, kMaxChannels>& wavelengths() const { return wavelengths_; }

 private:
  friend class SpectrumTable;

  static SampledSpectrum mix(const std::array<SampledSpectrum, 3>& basis, const Vec3f& rgb) {
    return basis[0] * rgb.x + basis[1] * rgb.y + basis[2] * rgb.z;
  }
  SampledSpectrum light(const LightTable::Light& light) const {
    SampledSpectrum result;
    for (int i = 0; i < channels_; ++i) result[i] = light(coordinates_[i]);
    return result * white_;
  }

  std::vector<SampledSpectrum> values_;
  std::array<SampledSpectrum, 3> reflectance_basis_;
  bool keeps_colours_ = false;          // whether colours of images are those of the channels
  const LightTable* lights_ = nullptr;  // null where colours stay as they are given
  SampledSpectrum white_;               // of the spectra of lights
  SampledSpectrum coordinates_;         // u of the wavelengths, as SigmoidPolynomial has it
  std::array<Vec3f, kMaxChannels> to_rgb_;
  std::array<double, kMaxChannels> wavelengths_{};
  int channels_ = 3;
  const RgbColorSpace* space_ = nullptr;
};

/// The spectra of a scene. Filled while the scene is built, then shared by all threads.
class SpectrumTable {
 public:
  /// @param space of the film
  explicit SpectrumTable(const RgbColorSpace& space);

  SpectrumId add(const SpectralDistribution& spectrum, SpectrumRole role);

  const SpectralDistribution& spectrum(SpectrumId id) const { return entries_[id.index].spectrum; }
  const RgbColorSpace& space() const { return space_; }
  std::size_t size() const { return entries_.size(); }
  /// Whether an index of refraction has the same value at all wavelengths.
  bool is_constant(SpectrumId id) const;

  /// Values in R, G, B, where a colour is exactly what it was given as.
  SpectrumValues in_rgb() const;
  /// Values in R, G, B as the observer sees the spectra that `at` gives: their means over
  /// wavelengths, which differ from the given colours by what the table of spectra interpolates.
  SpectrumValues seen_in_rgb() const;
  /// Values at wavelengths.
  SpectrumValues at(const PathWavelengths& wavelengths) const;

 private:
  struct Entry {
    SpectralDistribution spectrum;
    SpectrumRole role = SpectrumRole::kReflectance;
    SampledSpectrum rgb;   ///< Colour as given.
    SampledSpectrum seen;  ///< Colour as the spectrum is seen.
  };

  const RgbColorSpace& space_;
  std::vector<Entry> entries_;
  RgbSpectrum red_, blue_;  // of textures; green follows from them
};

}  // namespace freepath
