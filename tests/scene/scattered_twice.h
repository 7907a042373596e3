#pragma once
/// @file Sunlight that a layer scatters once and twice, by quadrature, and the scene of it.

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "freepath/base/vector.h"
#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {

/// Parallel light of irradiance 1 in a wide homogeneous layer of thickness 1, seen along its normal
/// from the side where z is lowest. The phase function is that of Henyey and Greenstein.
struct LitLayer {
  double sigma_a = 0, sigma_s = 1, g = 0;
  /// Direction towards the light, unit; not within the layer's plane.
  Vec3d sun{0, 0, 1};

  double phase(double cosine) const {
    return (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
  }
  double sigma_t() const { return sigma_a + sigma_s; }
  /// Way from a depth out of the layer towards the light.
  double way_out(double depth) const { return (sun.z > 0 ? 1 - depth : depth) / std::abs(sun.z); }

  /// Radiance of what is scattered once.
  double once() const {
    const double per_depth = sigma_s * phase(sun.z);
    return integral([&](double z) { return per_depth * std::exp(-sigma_t() * (z + way_out(z))); },
                    0, 1);
  }

  /// Radiance of what is scattered twice.
  double twice() const {
    return integral(
        [&](double z) {
          const auto over_azimuths = [&](double cosine) {
            constexpr int kAzimuths = 48;
            const double sines = std::sqrt((1 - cosine * cosine) * (1 - sun.z * sun.z));
            double sum = 0;
            for (int i = 0; i < kAzimuths; ++i) {
              const double azimuth = 2 * std::numbers::pi * (i + 0.5) / kAzimuths;
              sum += phase(cosine * sun.z + sines * std::cos(azimuth));
            }
            return sum * 2 * std::numbers::pi / kAzimuths;
          };
          const auto from_cosine = [&](double cosine) {
            return phase(cosine) * over_azimuths(cosine) * along(z, cosine);
          };
          return sigma_s * sigma_s * std::exp(-sigma_t() * z) *
                 (integral(from_cosine, -1, 0) + integral(from_cosine, 0, 1));
        },
        0, 1);
  }

  /// The scene: what is scattered more than twice is left out.
  std::string scene(int size) const {
    const auto grey = [](double value) { return fmt::format("[ {0} {0} {0} ]", value); };
    return "Integrator \"volpath\" \"integer maxdepth\" 2\n" + film(size) +
           "LookAt 0 0 -9  0 0 0  0 1 0\n"
           "Camera \"orthographic\" \"float screenwindow\" [ -1e-3 1e-3 -1e-3 1e-3 "
           "]\nWorldBegin\n" +
           fmt::format(
               "LightSource \"distant\" \"rgb L\" [ 1 1 1 ] \"point3 to\" [ 0 0 0 ] "
               "\"point3 from\" [ {} {} {} ]\n",
               sun.x, sun.y, sun.z) +
           fmt::format(
               "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"float g\" {} "
               "\"rgb sigma_a\" {} \"rgb sigma_s\" {}\n",
               g, grey(sigma_a), grey(sigma_s)) +
           medium_box("fog", Vec3d(-60, -60, 0), Vec3d(60, 60, 1));
  }

 private:
  static double integral(const std::function<double(double)>& f, double begin, double end) {
    return boost::math::quadrature::gauss<double, 30>::integrate(f, begin, end);
  }
  /// Transmittance along a direction and out towards the light, over all points of the direction.
  double along(double z, double cosine) const {
    const double length = (cosine > 0 ? 1 - z : z) / std::abs(cosine);
    const double change = (sun.z > 0 ? -cosine : cosine) / std::abs(sun.z);  // of the way out
    const double rate = sigma_t() * (1 + change);
    const double sum = std::abs(rate) < 1e-9 ? length : (1 - std::exp(-rate * length)) / rate;
    return std::exp(-sigma_t() * way_out(z)) * sum;
  }
};

}  // namespace freepath::testing
