#pragma once
/// @file The sky on a clear day.

#include "freepath/base/spectrum.h"
#include "freepath/render/environment.h"
#include "freepath/render/sun.h"
#include "freepath/render/up_axis.h"

namespace freepath {

/// The analytic model of daylight of [Preetham99]: luminance and chromaticity of the sky by the
/// formula of Perez, for a sun's elevation and a turbidity.
class DaylightSky {
 public:
  /// @param sun its direction and turbidity count, not its irradiance
  /// @throws Error for a sun below the horizon, where the model says nothing, or a turbidity not in
  ///   [2, 10]
  explicit DaylightSky(const SunParameters& sun);

  /// Radiance of the sky, linear Rec. 709, in the units of sun.h; colours outside the gamut are
  /// clipped.
  /// @param height cosine of the angle from the zenith, in [0, 1]
  /// @param sun_cosine cosine of the angle from the sun
  Spectrum radiance(double height, double sun_cosine) const;

 private:
  /// The five coefficients and what the formula is scaled with, for Y, x or y.
  struct Perez {
    double a, b, c, d, e;
    double scale;  // value at the zenith / formula at the zenith
    double evaluate(double height, double sun_cosine) const;
  };

  Perez luminance_, x_, y_;
};

/// The sky baked into an image of 512×256 pixels, without the sun's disc. Below the horizon lies a
/// ground that reflects some 18 % of the light of sun and sky; it fades into the horizon over some
/// degrees, as in haze.
/// @throws Error as DaylightSky
ImageEnvironment make_sky(const SunParameters& sun, UpAxis up);

}  // namespace freepath
