// The atmosphere of the default sky, against the exact transport of slabs and published formulas.

#include "freepath/lights/atmosphere.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "freepath/media/phase/parse_phase_function.h"
#include "freepath/paths/slab.h"

namespace freepath {
namespace {

/// A channel's atmosphere as flat layers between altitudes, from the top down.
std::vector<SlabLayer> layers_of(double turbidity, int channel) {
  const AirColumn column = air_column(turbidity);
  const std::vector<double> altitudes{80, 4, 1.2, 0.4, 0};  // [km]
  std::vector<SlabLayer> layers;
  for (std::size_t i = 0; i + 1 < altitudes.size(); ++i) {
    const auto part = [&](double scale_height) {
      return std::exp(-altitudes[i + 1] / scale_height) - std::exp(-altitudes[i] / scale_height);
    };
    const double rayleigh = column.rayleigh[channel] * part(8);
    const double aerosol = column.aerosol[channel] * part(1.2);
    const double scattering = rayleigh + aerosol * Atmosphere::kAerosolAlbedo;
    const double share = rayleigh / scattering;
    const PhaseFunction phase = parse_phase_function(fmt::format(
        "{}*rayleigh+{}*henyey-greenstein:g={}", share, 1 - share, Atmosphere::kAerosolG));
    layers.push_back({.tau = rayleigh + aerosol,
                      .albedo = scattering / (rayleigh + aerosol),
                      .phase = std::make_shared<const PhaseFunction>(phase)});
  }
  return layers;
}

// Over a black ground, under suns that are high enough for a flat atmosphere. Single scattering
// alone would be 15 to 30 % too dark. Aerosols scatter ahead what is taken to scatter everywhere:
// the more there are, the more the model keeps from the ground.
TEST(Atmosphere, HasTheSkyLightOfExactTransportThroughFlatLayers) {
  for (const double turbidity : {2.0, 3.0, 6.0}) {
    for (const double mu0 : {0.5, 0.8}) {
      const Vec3d sky = Atmosphere(mu0, turbidity, Vec3d(0)).sky_irradiance();
      for (int channel = 0; channel < 3; ++channel) {
        SlabSettings settings;
        settings.mu0 = mu0;
        settings.paths = 100'000;
        const SlabResult exact = trace_slab(layers_of(turbidity, channel), settings);
        const double diffuse = exact.transmittance.mean - exact.unscattered.mean;
        EXPECT_NEAR(sky[channel] / mu0 / diffuse, 1, turbidity > 3 ? 0.2 : 0.08)
            << "turbidity " << turbidity << ", mu0 " << mu0 << ", channel " << channel;
      }
    }
  }
}

// The ground sends light up, and the air some of it back.
TEST(Atmosphere, GroundsBrightenTheSky) {
  const Vec3d dark = Atmosphere(0.7, 3, Vec3d(0)).sky_irradiance();
  const Vec3d usual = Atmosphere(0.7, 3, Vec3d(0.15)).sky_irradiance();
  const Vec3d bright = Atmosphere(0.7, 3, Vec3d(0.8)).sky_irradiance();
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_GT(usual[channel], 1.01 * dark[channel]);
    EXPECT_LT(usual[channel], 1.15 * dark[channel]);
    EXPECT_GT(bright[channel], 1.1 * usual[channel]);
  }
}

// Of its own radiance: the light that is scattered once, of a thin atmosphere of one kind, is the
// phase function times what the air takes off the sunlight, by the formula of flat layers.
TEST(Atmosphere, ScattersOnceAsFlatLayersDo) {
  const double mu0 = 0.6;
  const AirColumn column = air_column(2);
  const Atmosphere atmosphere(mu0, 2, Vec3d(0));
  for (const double mu : {0.4, 0.7, 1.0}) {
    const Atmosphere::Light light = atmosphere.along({0, mu, 1.0}, Vec3d(0));
    for (int channel = 0; channel < 3; ++channel) {
      const double tau = column.rayleigh[channel] + column.aerosol[channel];
      // ∫ e^{-(tau - t)/mu} e^{-t/mu0} dt/mu
      const double rate = 1 / mu0 - 1 / mu;
      const double transport =
          std::abs(rate) < 1e-9 ? tau / mu * std::exp(-tau / mu)
                                : std::exp(-tau / mu) * (1 - std::exp(-tau * rate)) / (mu * rate);
      const double scattered =
          light.rayleigh[channel] + light.aerosol[channel] / Atmosphere::kAerosolAlbedo;
      EXPECT_NEAR(scattered / transport, 1, 0.01) << mu << " " << channel;
    }
  }
}

TEST(Atmosphere, IsRedderTowardsTheHorizonAndDarkInThePlanetsShadow) {
  const Atmosphere noon(0.7, 3, Vec3d(0.1));
  const auto radiance = [](const Atmosphere& atmosphere, double height) {
    return Atmosphere::radiance(atmosphere.along({0.4, height, 2}, Vec3d(0.5)), 0);
  };
  const Vec3d zenith = radiance(noon, 1);
  const Vec3d horizon = radiance(noon, 0.02);
  EXPECT_GT(zenith.z, 2 * zenith.x);
  EXPECT_GT(horizon.x / horizon.z, 1.5 * zenith.x / zenith.z);
  EXPECT_GT(horizon.y, 2 * zenith.y);
  EXPECT_LT(radiance(Atmosphere(-0.3, 3, Vec3d(0.1)), 1).y, 1e-3 * zenith.y);
}

}  // namespace
}  // namespace freepath
