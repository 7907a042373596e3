#pragma once
/// @file The sun: a disc of uniform radiance.

#include <cmath>
#include <numbers>
#include <optional>

#include "freepath/base/rgb.h"
#include "freepath/base/tangent_frame.h"
#include "freepath/base/turn.h"
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

  /// Direction towards the centre [world].
  const Vec3f& direction() const { return direction_; }
  /// Radiance of the disc: irradiance / solid angle.
  const Rgb& radiance() const { return radiance_; }
  const Rgb& irradiance() const { return irradiance_; }
  /// Density of `sample` in the disc [1/sr].
  float pdf() const { return 1.0F / solid_angle(); }
  /// Solid angle of the disc, 2π (1 - cosine of the radius) [sr].
  static constexpr float solid_angle() { return std::numbers::pi_v<float> * largest_distance2(); }

  /// Whether a direction points at the disc. Decided by the distance of two points of the sphere:
  /// the cosine has no digits left for an angle as small as this.
  bool contains(const Vec3f& towards) const {
    return (towards - direction_).length2() <= largest_distance2();
  }

  /// A direction uniformly distributed in the disc, for which `contains` holds.
  Vec3f sample(float u0, float u1) const {
    const float drop = u0 * 0.5F * largest_distance2();  // 1 - cosine
    const float sine = std::sqrt(drop * (2.0F - drop));
    const SinCos azimuth = sincos_of_turn(u1);
    const Vec3f towards = frame_.to_world(sine * azimuth.cosine, sine * azimuth.sine, 1.0F - drop);
    if (contains(towards)) return towards;
    // Rounding put a point of the edge outside, by some 1e-5 of the radius.
    const Vec3f inside = direction_ + (towards - direction_) * 0.9999F;
    return inside * (1.0F / std::sqrt(inside.length2()));
  }

 private:
  /// 2 (1 - cosine of the radius).
  static constexpr float largest_distance2() { return 4 * kSineOfHalfRadius * kSineOfHalfRadius; }

  static constexpr float kSineOfHalfRadius = 2.3256491e-3F;  // sin(0.2665° / 2)

  Vec3f direction_;
  TangentFrame frame_;  // around it
  Rgb irradiance_;
  Rgb radiance_;
};

}  // namespace freepath
