#include "freepath/lights/photometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "freepath/base/error.h"
#include "freepath/spectra/cie_observer.h"

namespace freepath {
namespace {

void check_positive(double value, const char* what, const std::string& name) {
  if (!(value >= 0) || !std::isfinite(value)) {
    fail("{}: {} is {}; it must be finite and not negative", name, what, value);
  }
}

}  // namespace

double photometric_scale(const SpectralDistribution& spectrum) {
  if (std::holds_alternative<RgbSpectrum>(spectrum.kind())) return 1;
  const double luminance = luminance_of(spectrum);
  return luminance > 0 ? 1 / luminance : 1;
}

Vec3d luminance_weights(const RgbColorSpace& space) {
  return {space.to_xyz({1, 0, 0}).y, space.to_xyz({0, 1, 0}).y, space.to_xyz({0, 0, 1}).y};
}

double brightness(const SpectralDistribution& spectrum) {
  // What is outside of the visible, or almost, is light all the same.
  constexpr double kLeast = 1e-3;
  return std::max(luminance_of(spectrum), kLeast * spectrum.largest());
}

double light_factor(double scale, const std::optional<double>& target, double flux_of_image,
                    const std::string& name) {
  check_positive(scale, "its scale", name);
  if (!target) return scale;
  check_positive(*target, "its power or illuminance", name);
  if (*target == 0) return 0;
  if (!(flux_of_image > 0)) fail("{}: a power or illuminance is given, but it is black", name);
  return scale * (*target / flux_of_image);
}

double light_factor(const SpectralDistribution& spectrum, double scale,
                    const std::optional<double>& target, double flux_of_one,
                    const std::string& name) {
  for (std::size_t i = 0; i < kObserverNodes; ++i) {
    const double value = spectrum(observer_node(i));
    if (!(value >= 0) || !std::isfinite(value)) {
      fail("{}: its spectrum is {} at {} nm; light must be finite and not negative", name, value,
           observer_node(i));
    }
  }
  return light_factor(scale, target, flux_of_one, name) * photometric_scale(spectrum);
}

std::vector<Vec3f> light_colours(const Image& image, const std::string& name) {
  const std::array<int, 3> colour = colour_channels(image, name);
  std::vector<Vec3f> colours;
  colours.reserve(image.pixel_count());
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const float* values = image.pixel(column, row);
      Vec3f c(0);
      for (int i = 0; i < 3; ++i) {
        const float value = values[colour[i]];
        if (!std::isfinite(value)) {
          fail("{}: pixel ({}, {}) has a value of {}; light must be finite", name, column, row,
               value);
        }
        c[i] = std::max(0.0F, value);
      }
      colours.push_back(c);
    }
  }
  return colours;
}

void check_octahedral(const Image& image, const std::string& name) {
  if (image.width < 1 || image.height < 1) fail("{}: the image is empty", name);
  if (image.width != image.height) {
    fail(
        "{}: the image has {} x {} pixels; an octahedral map of all directions is square (a "
        "lat-long image must be converted first)",
        name, image.width, image.height);
  }
}

}  // namespace freepath
