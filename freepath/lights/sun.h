#pragma once
/// @file The sun: a disc of uniform radiance.

#include <numbers>
#include <optional>

#include "freepath/base/direction_disc.h"
#include "freepath/base/rgb.h"
#include "freepath/base/up_axis.h"
#include "freepath/base/vector.h"

namespace freepath {

/// Units of radiance, shared by sun and sky: 1 is the radiance of a white diffuse surface under an
/// illuminance of 60 klx, about that of the ground under a sun 40 degrees high, so that what the
/// sun shines on is well exposed as it is. Hence an irradiance of π stands for 60 klx and a
/// radiance of π/60 for 1 kcd/m².
inline constexpr double kRadiancePerKilocandela = std::numbers::pi / 60;

/// Irradiance of the sun outside the atmosphere, 128 klx. Its colour is balanced for daylight, as
/// cameras are: the light of a sun 45 degrees high is white on the ground, at a turbidity of 3.
Rgb sun_outside();

/// Where the sun stands and what lies between.
struct SunParameters {
  double elevation = 45;  ///< Above the horizon [degrees], in [-90, 90].
  double azimuth = 0;     ///< Azimuth as on a compass, see sky_direction [degrees].
  double turbidity = 2;   ///< Haze: 2 is very clear, 3 clear, 6 hazy, 10 almost fog.
  /// Irradiance on a surface that faces the sun; by default what direct_sun_irradiance gives.
  std::optional<Rgb> irradiance = {};
};

/// Irradiance of direct sunlight on a surface that faces the sun, in the units above.
///
/// What comes from outside the atmosphere is attenuated for each channel by air and aerosols
/// (air_column) over the relative optical mass [Preetham99, A.1]; the weak bands of ozone, water
/// and mixed gases are left out. Below the horizon the value of the horizon is used: almost
/// nothing.
/// @param elevation [degrees]
Rgb direct_sun_irradiance(double elevation, double turbidity);

/// A disc with an angular radius of 0.2665 degrees.
class Sun {
 public:
  /// @throws Error for an elevation not in [-90, 90], a turbidity not in [2, 10], an irradiance
  /// that
  ///   is negative or not finite
  Sun(const SunParameters& parameters, UpAxis up);

  /// Directions towards it [world].
  const DirectionDisc& disc() const { return disc_; }
  /// Direction towards the centre [world].
  const Vec3f& direction() const { return disc_.middle(); }
  /// Radiance of the disc: irradiance / solid angle.
  const Rgb& radiance() const { return radiance_; }
  const Rgb& irradiance() const { return irradiance_; }
  /// Density of a draw in the disc [1/sr].
  float pdf() const { return 1.0F / disc_.solid_angle(); }

 private:
  DirectionDisc disc_;
  Rgb irradiance_;
  Rgb radiance_;
};

}  // namespace freepath
