#pragma once
/// @file Spectra that have a given colour.

#include <array>

#include "freepath/base/vector.h"
#include "freepath/spectra/rgb_color_space.h"

namespace freepath {

/// A smooth spectrum between 0 and 1: S(c0 u² + c1 u + c2), where S(x) = 1/2 + x / (2 sqrt(1 +
/// x²)), and u goes from -1 to 1 over the rendered wavelengths [Jakob19].
struct SigmoidPolynomial {
  std::array<double, 3> c = {};  ///< c2 may be infinite, if the others are 0.

  /// @param wavelength [nm]
  double operator()(double wavelength) const;

  /// u of a wavelength [nm]: from -1 to 1, where the monomials are of one size and the fit is well
  /// conditioned.
  static double coordinate(double wavelength);
};

/// The smooth reflectance whose colour is RGB under the illuminant of the space, by Gauss-Newton
/// steps [Jakob19] with Levenberg and Marquardt's damping. Equal components give a constant
/// spectrum exactly; other colours of sRGB come back within 0.0002. Bright saturated colours of
/// wider gamuts, which no reflectance can have, give one whose RGB is near.
/// @throws Error unless all components are in [0, 1]
SigmoidPolynomial fit_reflectance(const Vec3d& rgb, const RgbColorSpace& space);

/// A spectrum made of a colour: scale · S · illuminant, where S is of the ReflectanceTable of the
/// space. It has nearly that colour, and remembers the colour itself. The space must outlive it.
class RgbSpectrum {
 public:
  /// A reflectance or an albedo: values in [0, 1].
  /// @throws Error unless all components are in [0, 1]
  static RgbSpectrum reflectance(const Vec3d& rgb, const RgbColorSpace& space);

  /// Any coefficient without an upper bound: 2 m S, where S has the colour rgb / (2 m) and m is the
  /// largest component, so that S stays where it is smoothest.
  /// @throws Error unless all components are finite and not negative
  static RgbSpectrum unbounded(const Vec3d& rgb, const RgbColorSpace& space);

  /// Emitted light: `unbounded` times the illuminant of the space. The observer sees it nearly as
  /// rgb.
  /// @throws Error unless all components are finite and not negative
  static RgbSpectrum illuminant(const Vec3d& rgb, const RgbColorSpace& space);

  /// @param wavelength [nm]
  double operator()(double wavelength) const {
    const double value = scale_ * polynomial_(wavelength);
    return is_light_ ? value * space_->illuminant()(wavelength) : value;
  }

  /// Whether it has one value at all wavelengths.
  bool is_constant() const {
    return !is_light_ && (scale_ == 0 || (polynomial_.c[0] == 0 && polynomial_.c[1] == 0));
  }

  const SigmoidPolynomial& polynomial() const { return polynomial_; }
  double scale() const { return scale_; }

  /// The colour that it was made of, in its space.
  const Vec3d& rgb() const { return rgb_; }
  const RgbColorSpace& space() const { return *space_; }
  /// Whether it is emitted light, else a reflectance or coefficient.
  bool is_light() const { return is_light_; }

 private:
  RgbSpectrum(const SigmoidPolynomial& polynomial, double scale, const Vec3d& rgb,
              const RgbColorSpace& space)
      : polynomial_(polynomial), scale_(scale), rgb_(rgb), space_(&space) {}

  SigmoidPolynomial polynomial_;
  double scale_;
  Vec3d rgb_;
  const RgbColorSpace* space_;
  bool is_light_ = false;
};

}  // namespace freepath
