#include "freepath/render/sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "freepath/base/error.h"

namespace freepath {

namespace {

constexpr double kRadians = std::numbers::pi / 180;

/// Chromaticity at the zenith: a polynomial in the turbidity and the sun's zenith angle. Rows
/// belong to T², T, 1, columns to θ³, θ², θ, 1 [Preetham99, A.2].
using ZenithMatrix = std::array<std::array<double, 4>, 3>;
constexpr ZenithMatrix kZenithX{{{0.00166, -0.00375, 0.00209, 0},
                                 {-0.02903, 0.06377, -0.03202, 0.00394},
                                 {0.11693, -0.21196, 0.06052, 0.25886}}};
constexpr ZenithMatrix kZenithY{{{0.00275, -0.00610, 0.00317, 0},
                                 {-0.04214, 0.08970, -0.04153, 0.00516},
                                 {0.15346, -0.26756, 0.06670, 0.26688}}};

double zenith_chromaticity(const ZenithMatrix& matrix, double turbidity, double sun_angle) {
  double value = 0;
  for (const auto& row : matrix) {
    const double polynomial =
        ((row[0] * sun_angle + row[1]) * sun_angle + row[2]) * sun_angle + row[3];
    value = value * turbidity + polynomial;
  }
  return value;
}

/// [kcd/m²] [Preetham99, A.2].
double zenith_luminance(double turbidity, double sun_angle) {
  const double chi = (4.0 / 9 - turbidity / 120) * (std::numbers::pi - 2 * sun_angle);
  return (4.0453 * turbidity - 4.9710) * std::tan(chi) - 0.2155 * turbidity + 2.4192;
}

/// Linear Rec. 709 of a chromaticity and luminance, D65 (the inverse of the standard's matrix).
Spectrum rec709(double x, double y, double luminance) {
  const double cie_x = x / y * luminance;
  const double cie_z = (1 - x - y) / y * luminance;
  const auto positive = [](double value) { return static_cast<float>(std::max(0.0, value)); };
  return {positive(3.240970 * cie_x - 1.537383 * luminance - 0.498611 * cie_z),
          positive(-0.969244 * cie_x + 1.875968 * luminance + 0.041555 * cie_z),
          positive(0.055630 * cie_x - 0.203977 * luminance + 1.056972 * cie_z)};
}

}  // namespace

double DaylightSky::Perez::evaluate(double height, double sun_cosine) const {
  const double gamma = std::acos(std::clamp(sun_cosine, -1.0, 1.0));
  // At the horizon the exponent tends to -∞ (b < 0 for turbidities from 2 on).
  const double gradient = 1 + a * std::exp(b / std::max(height, 1e-6));
  return scale * gradient * (1 + c * std::exp(d * gamma) + e * sun_cosine * sun_cosine);
}

DaylightSky::DaylightSky(const SunParameters& sun) {
  if (!(sun.elevation >= 0 && sun.elevation <= 90)) {
    fail(
        "the daylight sky needs a sun above the horizon, but its elevation is {} degrees; choose "
        "one in [0, 90] or another environment",
        sun.elevation);
  }
  if (!(sun.turbidity >= 2 && sun.turbidity <= 10)) {
    fail("the turbidity is {}; it must lie in [2, 10]", sun.turbidity);
  }
  const double t = sun.turbidity;
  const double sun_angle = (90 - sun.elevation) * kRadians;
  // [Preetham99, A.2]
  luminance_ = {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251,
                0.1206 * t - 2.5771, -0.0670 * t + 0.3703, 1};
  x_ = {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125,
        -0.0641 * t - 0.8989, -0.0033 * t + 0.0452, 1};
  y_ = {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102,
        -0.0441 * t - 1.6537, -0.0109 * t + 0.0529, 1};
  const auto fit_to_zenith = [&](Perez& perez, double value) {
    perez.scale = value / perez.evaluate(1, std::cos(sun_angle));
  };
  fit_to_zenith(luminance_, zenith_luminance(t, sun_angle) * kRadiancePerKilocandela);
  fit_to_zenith(x_, zenith_chromaticity(kZenithX, t, sun_angle));
  fit_to_zenith(y_, zenith_chromaticity(kZenithY, t, sun_angle));
}

Spectrum DaylightSky::radiance(double height, double sun_cosine) const {
  return rec709(x_.evaluate(height, sun_cosine), y_.evaluate(height, sun_cosine),
                std::max(0.0, luminance_.evaluate(height, sun_cosine)));
}

ImageEnvironment make_sky(const SunParameters& sun, UpAxis up) {
  const DaylightSky sky(sun);
  constexpr int kHeight = 256;
  constexpr int kWidth = 2 * kHeight;
  // The image is made with y up; its convention does not depend on the up axis.
  const Vec3f to_sun = sky_direction(sun.elevation, sun.azimuth, UpAxis::kY);
  const auto sky_at = [&](float u, double height) {
    const Vec3f towards = lat_long_direction(u, static_cast<float>(height), UpAxis::kY);
    return sky.radiance(height, towards.dot(to_sun));
  };
  Image image{.width = kWidth, .height = kHeight, .channels = {"R", "G", "B"}};
  image.values.resize(image.pixel_count() * 3);
  const auto set = [&](int column, int row, const Spectrum& s) {
    std::copy_n(&s[0], 3, image.pixel(column, row));
  };
  Spectrum ground_irradiance =
      sun.irradiance.value_or(direct_sun_irradiance(sun.elevation, sun.turbidity)) *
      static_cast<float>(std::sin(sun.elevation * kRadians));
  for (int row = 0; row < kHeight / 2; ++row) {
    const double angle = std::numbers::pi * (row + 0.5) / kHeight;
    const double solid_angle =
        2 * std::numbers::pi / kWidth * std::numbers::pi / kHeight * std::sin(angle);
    for (int column = 0; column < kWidth; ++column) {
      const Spectrum radiance = sky_at((column + 0.5F) / kWidth, std::cos(angle));
      set(column, row, radiance);
      ground_irradiance += radiance * static_cast<float>(solid_angle * std::cos(angle));
    }
  }
  const Spectrum ground_albedo(0.19F, 0.18F, 0.15F);
  const Spectrum ground = ground_irradiance * ground_albedo * std::numbers::inv_pi_v<float>;
  constexpr double kHaze = 3 * kRadians;  // angle over which the ground fades into the horizon
  for (int row = kHeight / 2; row < kHeight; ++row) {
    const double below = std::numbers::pi * ((row + 0.5) / kHeight - 0.5);
    const auto haze = static_cast<float>(std::exp(-below / kHaze));
    for (int column = 0; column < kWidth; ++column) {
      set(column, row, sky_at((column + 0.5F) / kWidth, 0) * haze + ground * (1 - haze));
    }
  }
  return {image, up, "sky"};
}

}  // namespace freepath
