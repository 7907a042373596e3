#include "freepath/lights/sun.h"

#include <algorithm>
#include <cmath>

#include "freepath/base/error.h"
#include "freepath/lights/atmosphere.h"

namespace freepath {

namespace {

constexpr float kSineOfHalfRadius = 2.3256491e-3F;  // sin(0.2665° / 2)

/// Of direct sunlight to the ground.
Rgb transmittance(double elevation, double turbidity) {
  constexpr double kRadians = std::numbers::pi / 180;
  const double height = std::clamp(elevation, 0.0, 90.0);
  const double mass = 1 / (std::sin(height * kRadians) + 0.15 * std::pow(height + 3.885, -1.253));
  const AirColumn column = air_column(turbidity);
  Rgb result;
  for (int channel = 0; channel < kChannels; ++channel) {
    const double depth = (column.rayleigh[channel] + column.aerosol[channel]) * mass;
    result[channel] = static_cast<float>(std::exp(-depth));
  }
  return result;
}

}  // namespace

Rgb sun_outside() {
  const Rgb balance = Rgb(1) / transmittance(45, 3);
  return balance * static_cast<float>(128 * kRadiancePerKilocandela / luminance(balance));
}

Rgb direct_sun_irradiance(double elevation, double turbidity) {
  return sun_outside() * transmittance(elevation, turbidity);
}

Sun::Sun(const SunParameters& parameters, UpAxis up)
    : disc_(sky_direction(parameters.elevation, parameters.azimuth, up), kSineOfHalfRadius) {
  if (!(parameters.elevation >= -90 && parameters.elevation <= 90)) {
    fail("the sun's elevation is {} degrees; it must lie in [-90, 90]", parameters.elevation);
  }
  if (!std::isfinite(parameters.azimuth)) {
    fail("the sun's azimuth is {}; it must be a finite number of degrees", parameters.azimuth);
  }
  if (!(parameters.turbidity >= 2 && parameters.turbidity <= 10)) {
    fail("the turbidity is {}; it must lie in [2, 10]", parameters.turbidity);
  }
  irradiance_ = parameters.irradiance.value_or(
      direct_sun_irradiance(parameters.elevation, parameters.turbidity));
  if (!is_finite(irradiance_) || std::min({irradiance_.x, irradiance_.y, irradiance_.z}) < 0) {
    fail("the sun's irradiance is {},{},{}; it must be finite and not negative", irradiance_.x,
         irradiance_.y, irradiance_.z);
  }
  radiance_ = irradiance_ * pdf();
}

}  // namespace freepath
