#pragma once
/// @file Linear RGB colour spaces.

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "freepath/base/rgb_primaries.h"
#include "freepath/base/vector.h"
#include "freepath/spectra/cie_observer.h"
#include "freepath/spectra/linear_spectrum.h"

namespace freepath {

class ReflectanceTable;

/// A linear RGB space with the illuminant under which its whites are seen.
///
/// Its white point is the chromaticity of that illuminant as the observer here sees it, which
/// differs from that of the standards by about 0.0001: so a grey surface under the
/// illuminant has exactly equal R, G and B.
///
/// It stays where it is, since spectra refer to the space of their colour.
class RgbColorSpace {
 public:
  /// Wavelengths of the quadrature that fits spectra to colours: every 2 nm.
  static constexpr int kNodes = 236;
  static constexpr double kNodeDistance = 2;  ///< [nm]

  /// @param illuminant any scale
  RgbColorSpace(std::string name, const RgbPrimaries& primaries, const LinearSpectrum& illuminant);
  ~RgbColorSpace();
  RgbColorSpace(const RgbColorSpace&) = delete;
  RgbColorSpace& operator=(const RgbColorSpace&) = delete;

  const std::string& name() const { return name_; }
  const RgbPrimaries& primaries() const { return primaries_; }
  const Chromaticity& white() const { return white_; }
  /// Illuminant of the space, with a luminance of 1.
  const LinearSpectrum& illuminant() const { return illuminant_; }

  Vec3d to_xyz(const Vec3d& rgb) const { return rgb * rgb_to_xyz_; }
  Vec3d from_xyz(const Vec3d& xyz) const { return xyz * xyz_to_rgb_; }
  const Matrix3d& rgb_to_xyz() const { return rgb_to_xyz_; }
  const Matrix3d& xyz_to_rgb() const { return xyz_to_rgb_; }

  /// Weights w_i for which the sum of w_i r(360 nm + 2 nm i) is the RGB of a surface of reflectance
  /// r under the illuminant: exact for an r that is linear between those wavelengths.
  std::span<const Vec3d, kNodes> reflectance_weights() const { return weights_; }

  /// The smooth reflectances that have the colours of the space.
  const ReflectanceTable& reflectances() const { return *reflectances_; }

 private:
  std::string name_;
  RgbPrimaries primaries_;
  LinearSpectrum illuminant_;
  Chromaticity white_;
  Matrix3d rgb_to_xyz_, xyz_to_rgb_;
  std::array<Vec3d, kNodes> weights_;
  std::unique_ptr<const ReflectanceTable> reflectances_;
};

/// The spaces that are known: "srgb" (IEC 61966-2-1, primaries of Rec. 709), "dci-p3" (P3 primaries
/// with D65), "rec2020", "aces-cg" and "aces2065-1".
std::span<const std::string_view> rgb_color_space_names();

/// The space of this name. It lives as long as the program and is made at its first use.
/// @throws Error with the nearest name for an unknown one
const RgbColorSpace& rgb_color_space(std::string_view name);

}  // namespace freepath
