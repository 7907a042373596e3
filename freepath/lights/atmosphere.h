#pragma once
/// @file Sunlight in the air of a round planet.

#include <array>

#include "freepath/base/vector.h"

namespace freepath {

/// What light meets on its way straight up through the whole atmosphere, for the dominant
/// wavelengths of red, green and blue (611, 549, 464 nm): optical depths.
struct AirColumn {
  Vec3d rayleigh;  ///< Depth of air, 0.008735 λ^-4.08 with λ in µm [Preetham99, A.1].
  Vec3d aerosol;   ///< Ångström's formula, (0.04608 T - 0.04586) λ^-1.3 for turbidity T.
};
AirColumn air_column(double turbidity);

/// An atmosphere whose air and aerosol thin out exponentially (scale heights of 8 and 1.2 km) over
/// a ground that reflects diffusely, under a far sun.
///
/// Light that was scattered once is integrated along each ray. All higher orders are added as if
/// they came from everywhere alike, with the sum of a geometric series for their number
/// [Hillaire20, 5.5]: so this is a sky to light pictures by, not an estimator. Its irradiance on
/// the ground is up to 8 % below that of exact transport for turbidities up to 3, and up to 20 % at
/// 6 (measured against slabs, suns 30 and 53 degrees high); what the air sends back of the ground's
/// light is twice too much, 5 % of the sky over a ground of albedo 0.15.
class Atmosphere {
 public:
  static constexpr double kAerosolAlbedo = 0.95;  ///< Single scattering; air absorbs nothing.
  /// Asymmetry of Henyey and Greenstein's phase function.
  static constexpr double kAerosolG = 0.76;

  /// @param sun_height cosine of the angle of the sun from the zenith, where the observer stands
  /// @param turbidity in [2, 10]
  Atmosphere(double sun_height, double turbidity, const Vec3d& ground_albedo);

  /// A view from near the ground.
  struct View {
    double altitude = 0;  ///< Altitude of the observer [km].
    double height = 1;    ///< Cosine of the angle of the line of sight from the zenith.
    double azimuth = 0;   ///< Azimuth of the line of sight from the sun's [radians].
  };

  /// What comes along a line of sight, without the sun's disc, but for the phase functions of
  /// single scattering: per irradiance of the sun outside the atmosphere.
  struct Light {
    /// Single scattering, to be multiplied by the phase functions [1/sr].
    Vec3d rayleigh, aerosol;
    Vec3d rest;  ///< Scattered several times, or reflected by the ground.
  };

  /// @param ground_irradiance what the ground reflects where a line of sight meets it
  Light along(const View& view, const Vec3d& ground_irradiance) const;

  /// Radiance along a line of sight, per irradiance of the sun outside.
  /// @param sun_cosine of the angle between line of sight and sun
  static Vec3d radiance(const Light& light, double sun_cosine);

  /// Irradiance of the sky on the ground, without the sun's, per irradiance outside.
  Vec3d sky_irradiance() const;

 private:
  static constexpr int kAltitudes = 8;
  static constexpr int kSunHeights = 24;

  /// Transmittance of sunlight on its way to a point; 0 where the ground is in the way.
  Vec3d transmittance_to_space(double altitude, double height) const;
  /// Radiance of the light of all orders but the first that is scattered at a place, as if it were
  /// isotropic, per irradiance outside.
  Vec3d higher_orders(double altitude, double sun_height) const;
  Vec3d compute_higher_orders(double altitude, double sun_height) const;

  Vec3d to_sun_;              // where the observer stands, up is y
  Vec3d rayleigh_, aerosol_;  // extinction on the ground [1/km]
  Vec3d ground_albedo_;
  std::array<std::array<Vec3d, kSunHeights>, kAltitudes> higher_orders_;
};

}  // namespace freepath
