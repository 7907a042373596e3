#pragma once
/// @file A diffuse plane under lights, and what it has to receive.

#include <algorithm>
#include <array>
#include <numbers>
#include <string>

#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {

inline constexpr double kPlaneReflectance = 0.5;

/// The plane z = 0, seen from above at one point (x, 0, 0), where nothing else is in the way. Paths
/// scatter once: the shapes of lights reflect, too.
inline std::string plane_at(double x, const std::string& lights) {
  return "Integrator \"volpath\" \"integer maxdepth\" 1\n" + film(4) +
         fmt::format(
             "LookAt {0} 0 0.5  {0} 0 0  0 1 0\n"
             "Camera \"orthographic\" \"float screenwindow\" [ -1e-4 1e-4 -1e-4 1e-4 ]\n"
             "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ .5 .5 .5 ]\n"
             "Shape \"bilinearmesh\" \"point3 P\" [ -9 -9 0  9 -9 0  -9 9 0  9 9 0 ]\n",
             x) +
         lights;
}

/// @param irradiance of R, G, B, where the plane is seen
inline void expect_irradiance(const std::string& name, double x, const std::string& lights,
                              const std::array<double, 3>& irradiance, uint32_t samples = 64) {
  std::array<double, 3> radiance{};
  for (int c = 0; c < 3; ++c) radiance[c] = irradiance[c] * kPlaneReflectance / std::numbers::pi;
  const std::string scene = plane_at(x, lights);
  for (const ColorMode mode : kColorModes) {
    // Wavelengths are a quadrature of as many points as there are samples.
    const bool spectral = mode == ColorMode::kSpectral;
    const Picture picture = render_text(
        scene, {.mode = mode, .samples = spectral ? std::max(samples, 4096U) : samples});
    expect_mean(name + " " + name_of(mode), picture, radiance,
                {.absolute = 4e-4 * radiance[1], .largest_relative_error = 0.0034});
  }
}

inline std::array<double, 3> grey(double value) { return {value, value, value}; }

}  // namespace freepath::testing
