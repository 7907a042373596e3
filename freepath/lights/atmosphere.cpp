#include "freepath/lights/atmosphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freepath {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kPlanetRadius = 6371;  // [km]
constexpr double kTop = 80;             // altitude where space begins [km]
constexpr double kRayleighScaleHeight = 8;
constexpr double kAerosolScaleHeight = 1.2;

Vec3d exp_of(const Vec3d& v) { return {std::exp(v.x), std::exp(v.y), std::exp(v.z)}; }

double rayleigh_phase(double cosine) { return 3 / (16 * kPi) * (1 + cosine * cosine); }

/// Henyey and Greenstein's.
double aerosol_phase(double cosine) {
  constexpr double kG = Atmosphere::kAerosolG;
  const double base = 1 + kG * kG - 2 * kG * cosine;
  return (1 - kG * kG) / (4 * kPi * base * std::sqrt(base));
}

/// A straight line through the shells around the planet, from its surface or above.
struct Chord {
  double radius;  // where it begins
  double height;  // cosine of its angle from the zenith there
  double length;
  bool meets_ground;

  Chord(double altitude, double height) : radius(kPlanetRadius + altitude), height(height) {
    const double nearest2 = radius * radius * (1 - height * height);
    meets_ground = height < 0 && nearest2 < kPlanetRadius * kPlanetRadius;
    const double shell = meets_ground ? kPlanetRadius : kPlanetRadius + kTop;
    const double half = std::sqrt(std::max(0.0, shell * shell - nearest2));
    length = std::max(0.0, -radius * height + (meets_ground ? -half : half));
  }

  double altitude_at(double t) const {
    return std::sqrt(radius * radius + t * t + 2 * radius * height * t) - kPlanetRadius;
  }
};

/// Calls back with the middle and the length of each of some steps, which grow with distance.
template <typename Function>
void for_steps(const Chord& chord, int count, Function function) {
  for (int i = 0; i < count; ++i) {
    const double begin = static_cast<double>(i) / count;
    const double end = static_cast<double>(i + 1) / count;
    const double middle = (begin + end) / 2;
    function(chord.length * middle * middle, chord.length * (end * end - begin * begin));
  }
}

struct Densities {
  double rayleigh, aerosol;
};
Densities densities_at(double altitude) {
  return {std::exp(-altitude / kRayleighScaleHeight), std::exp(-altitude / kAerosolScaleHeight)};
}

/// Where values are kept: closer together near the ground.
double altitude_of(double node, int count) {
  const double u = node / (count - 1);
  return kTop * u * u * u;
}
double node_of(double altitude, int count) {
  return std::cbrt(std::clamp(altitude / kTop, 0.0, 1.0)) * (count - 1);
}

}  // namespace

AirColumn air_column(double turbidity) {
  constexpr std::array<double, 3> kWavelengths{0.611, 0.549, 0.464};  // [µm]
  AirColumn column;
  for (int channel = 0; channel < 3; ++channel) {
    column.rayleigh[channel] = 0.008735 * std::pow(kWavelengths[channel], -4.08);
    column.aerosol[channel] =
        (0.04608 * turbidity - 0.04586) * std::pow(kWavelengths[channel], -1.3);
  }
  return column;
}

Atmosphere::Atmosphere(double sun_height, double turbidity, const Vec3d& ground_albedo)
    : to_sun_(std::sqrt(std::max(0.0, 1 - sun_height * sun_height)), sun_height, 0),
      rayleigh_(air_column(turbidity).rayleigh / kRayleighScaleHeight),
      aerosol_(air_column(turbidity).aerosol / kAerosolScaleHeight),
      ground_albedo_(ground_albedo) {
  for (int i = 0; i < kAltitudes; ++i) {
    for (int j = 0; j < kSunHeights; ++j) {
      higher_orders_[i][j] =
          compute_higher_orders(altitude_of(i, kAltitudes), -1 + 2.0 * j / (kSunHeights - 1));
    }
  }
}

Vec3d Atmosphere::transmittance_to_space(double altitude, double height) const {
  const Chord chord(std::max(0.0, altitude), height);
  if (chord.meets_ground) return Vec3d(0);
  Vec3d depth(0);
  for_steps(chord, 24, [&](double t, double step) {
    const Densities density = densities_at(chord.altitude_at(t));
    depth += (rayleigh_ * density.rayleigh + aerosol_ * density.aerosol) * step;
  });
  return exp_of(-depth);
}

Vec3d Atmosphere::compute_higher_orders(double altitude, double sun_height) const {
  const Vec3d to_sun(std::sqrt(std::max(0.0, 1 - sun_height * sun_height)), sun_height, 0);
  constexpr int kRings = 8;
  constexpr int kSectors = 4;  // of half a ring: the other half is the same
  Vec3d second_order(0);       // means over all directions
  Vec3d returned(0);           // of isotropic light of radiance 1, scattered once more
  for (int ring = 0; ring < kRings; ++ring) {
    const double height = -1 + (2 * ring + 1.0) / kRings;
    const double reach = std::sqrt(1 - height * height);
    const Chord chord(altitude, height);
    for (int sector = 0; sector < kSectors; ++sector) {
      const double azimuth = kPi * (sector + 0.5) / kSectors;
      const Vec3d direction(reach * std::cos(azimuth), height, reach * std::sin(azimuth));
      Vec3d depth(0);
      const auto sun_height_at = [&](double t) {
        return (Vec3d(0, chord.radius, 0) + direction * t).normalized().dot(to_sun);
      };
      for_steps(chord, 16, [&](double t, double step) {
        const double there = chord.altitude_at(t);
        const Densities density = densities_at(there);
        const Vec3d rayleigh = rayleigh_ * density.rayleigh * step;
        const Vec3d aerosol = aerosol_ * density.aerosol * step;
        const Vec3d scattered =
            exp_of(-depth - (rayleigh + aerosol) * 0.5) * (rayleigh + aerosol * kAerosolAlbedo);
        second_order +=
            scattered * transmittance_to_space(there, sun_height_at(t)) * (1 / (4 * kPi));
        returned += scattered;
        depth += rayleigh + aerosol;
      });
      if (!chord.meets_ground) continue;
      const Vec3d reflected = exp_of(-depth) * ground_albedo_;
      const double cosine = sun_height_at(chord.length);
      returned += reflected;
      second_order += reflected * transmittance_to_space(0, cosine) * (std::max(0.0, cosine) / kPi);
    }
  }
  constexpr double kMean = 1.0 / (kRings * kSectors);
  return second_order * kMean / (Vec3d(1) - returned * kMean);
}

Vec3d Atmosphere::higher_orders(double altitude, double sun_height) const {
  const double x = std::clamp((sun_height + 1) / 2, 0.0, 1.0) * (kSunHeights - 1);
  const double y = node_of(altitude, kAltitudes);
  const int j = std::min(static_cast<int>(x), kSunHeights - 2);
  const int i = std::min(static_cast<int>(y), kAltitudes - 2);
  const auto row = [&](int k) {
    return higher_orders_[k][j] * (1 - (x - j)) + higher_orders_[k][j + 1] * (x - j);
  };
  return row(i) * (1 - (y - i)) + row(i + 1) * (y - i);
}

Atmosphere::Light Atmosphere::along(const View& view, const Vec3d& ground_irradiance) const {
  const Chord chord(view.altitude, view.height);
  const double reach = std::sqrt(std::max(0.0, 1 - view.height * view.height));
  const Vec3d direction(reach * std::cos(view.azimuth), view.height,
                        reach * std::sin(view.azimuth));
  Light light{Vec3d(0), Vec3d(0), Vec3d(0)};
  Vec3d depth(0);
  for_steps(chord, 48, [&](double t, double step) {
    const double altitude = chord.altitude_at(t);
    const Densities density = densities_at(altitude);
    const Vec3d rayleigh = rayleigh_ * density.rayleigh * step;
    const Vec3d aerosol = aerosol_ * density.aerosol * step;
    const double sun_height = (Vec3d(0, chord.radius, 0) + direction * t).normalized().dot(to_sun_);
    const Vec3d transmittance = exp_of(-depth - (rayleigh + aerosol) * 0.5);
    const Vec3d sunlight = transmittance * transmittance_to_space(altitude, sun_height);
    light.rayleigh += sunlight * rayleigh;
    light.aerosol += sunlight * aerosol * kAerosolAlbedo;
    light.rest +=
        transmittance * (rayleigh + aerosol * kAerosolAlbedo) * higher_orders(altitude, sun_height);
    depth += rayleigh + aerosol;
  });
  if (chord.meets_ground) {
    light.rest += exp_of(-depth) * ground_albedo_ * ground_irradiance * (1 / kPi);
  }
  return light;
}

Vec3d Atmosphere::radiance(const Light& light, double sun_cosine) {
  return light.rayleigh * rayleigh_phase(sun_cosine) + light.aerosol * aerosol_phase(sun_cosine) +
         light.rest;
}

Vec3d Atmosphere::sky_irradiance() const {
  constexpr int kRings = 16;
  constexpr int kSectors = 16;  // of half a ring
  Vec3d sum(0);
  for (int ring = 0; ring < kRings; ++ring) {
    const double height = std::sqrt((ring + 0.5) / kRings);
    const double reach = std::sqrt(1 - height * height);
    for (int sector = 0; sector < kSectors; ++sector) {
      const double azimuth = kPi * (sector + 0.5) / kSectors;
      const double sun_cosine = reach * std::cos(azimuth) * to_sun_.x + height * to_sun_.y;
      sum += radiance(along({0, height, azimuth}, Vec3d(0)), sun_cosine);
    }
  }
  return sum * (kPi / (kRings * kSectors));
}

}  // namespace freepath
