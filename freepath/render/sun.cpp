#include "freepath/render/sun.h"

#include <algorithm>
#include <array>

#include "freepath/base/error.h"

namespace freepath {

Spectrum direct_sun_irradiance(double elevation, double turbidity) {
  constexpr double kRadians = std::numbers::pi / 180;
  const double height = std::clamp(elevation, 0.0, 90.0);
  const double mass = 1 / (std::sin(height * kRadians) + 0.15 * std::pow(height + 3.885, -1.253));
  const double beta = 0.04608 * turbidity - 0.04586;                          // amount of aerosol
  constexpr std::array<double, kChannels> kWavelengths{0.611, 0.549, 0.464};  // [µm]
  constexpr double kOutside = 128 * kRadiancePerKilocandela;                  // 128 klx
  Spectrum irradiance;
  for (int channel = 0; channel < kChannels; ++channel) {
    const double wavelength = kWavelengths[channel];
    const double rayleigh = 0.008735 * std::pow(wavelength, -4.08);
    const double aerosol = beta * std::pow(wavelength, -1.3);
    irradiance[channel] = static_cast<float>(kOutside * std::exp(-(rayleigh + aerosol) * mass));
  }
  return irradiance;
}

Sun::Sun(const SunParameters& parameters, UpAxis up)
    : direction_(sky_direction(parameters.elevation, parameters.azimuth, up)) {
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
  radiance_ = irradiance_ * (1.0F / solid_angle());
}

}  // namespace freepath
