#include "freepath/lights/sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "freepath/base/error.h"
#include "freepath/lights/atmosphere.h"

namespace freepath {

namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kAltitude = 0.4;  // of the observer [km]
const Vec3d kGroundAlbedo(0.15, 0.15, 0.12);

void check(const SunParameters& sun) {
  if (!(sun.elevation >= 0 && sun.elevation <= 90)) {
    fail(
        "the daylight sky needs a sun above the horizon, but its elevation is {} degrees; choose "
        "one in [0, 90] or another environment",
        sun.elevation);
  }
  if (!(sun.turbidity >= 2 && sun.turbidity <= 10)) {
    fail("the turbidity is {}; it must lie in [2, 10]", sun.turbidity);
  }
}

}  // namespace

ImageEnvironment make_sky(const SunParameters& sun, UpAxis up) {
  check(sun);
  const double sun_height = std::sin(sun.elevation * kRadians);
  const Atmosphere atmosphere(sun_height, sun.turbidity, kGroundAlbedo);
  const Rgb direct = sun.irradiance.value_or(direct_sun_irradiance(sun.elevation, sun.turbidity));
  const Rgb outside = sun_outside();
  const Vec3d ground_irradiance =
      Vec3d(direct / outside) * sun_height + atmosphere.sky_irradiance();

  constexpr int kHeight = 256;
  constexpr int kWidth = 2 * kHeight;
  constexpr int kAzimuths = 12;  // between them light changes little but for the phase functions
  // The image is made with y up; its convention does not depend on the up axis.
  const Vec3f to_sun = sky_direction(sun.elevation, sun.azimuth, UpAxis::kY);
  Image image{.width = kWidth, .height = kHeight, .channels = {"R", "G", "B"}};
  image.values.resize(image.pixel_count() * 3);
  for (int row = 0; row < kHeight; ++row) {
    const double height = std::cos(std::numbers::pi * (row + 0.5) / kHeight);
    std::array<Atmosphere::Light, kAzimuths> lights;
    for (int i = 0; i < kAzimuths; ++i) {
      lights[i] = atmosphere.along({kAltitude, height, std::numbers::pi * i / (kAzimuths - 1)},
                                   ground_irradiance);
    }
    for (int column = 0; column < kWidth; ++column) {
      const Vec3f towards = lat_long_direction((static_cast<float>(column) + 0.5F) / kWidth,
                                               static_cast<float>(height), UpAxis::kY);
      const double azimuth = std::abs(std::remainder(
          std::atan2(towards.x, -towards.z) - sun.azimuth * kRadians, 2 * std::numbers::pi));
      const double position = azimuth / std::numbers::pi * (kAzimuths - 1);
      const int i = std::min(static_cast<int>(position), kAzimuths - 2);
      const double weight = position - i;
      const double sun_cosine = std::clamp<double>(towards.dot(to_sun), -1, 1);
      const Vec3d radiance = Atmosphere::radiance(lights[i], sun_cosine) * (1 - weight) +
                             Atmosphere::radiance(lights[i + 1], sun_cosine) * weight;
      for (int channel = 0; channel < 3; ++channel) {
        image.pixel(column, row)[channel] =
            static_cast<float>(radiance[channel] * outside[channel]);
      }
    }
  }
  return {image, up, "sky"};
}

}  // namespace freepath
