#include "freepath/io/image.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "freepath/base/error.h"

namespace freepath {

std::optional<int> find_channel(const Image& image, std::string_view name) {
  const auto found = std::find(image.channels.begin(), image.channels.end(), name);
  if (found == image.channels.end()) return {};
  return static_cast<int>(found - image.channels.begin());
}

std::array<int, 3> colour_channels(const Image& image, const std::string& name) {
  const auto r = find_channel(image, "R");
  const auto g = find_channel(image, "G");
  const auto b = find_channel(image, "B");
  if (r && g && b) return {*r, *g, *b};
  if (const auto y = find_channel(image, "Y")) return {*y, *y, *y};
  if (image.channels.size() == 1) return {0, 0, 0};
  fail("{}: no channels R, G, B (or Y) among {}", name, fmt::join(image.channels, ", "));
}

std::optional<Matrix3d> matrix_to_srgb(const Image& image) {
  if (!image.chromaticities) return {};
  return rgb_to_rgb_matrix(*image.chromaticities, RgbChromaticities());
}

Image in_srgb(Image image) {
  const auto matrix = matrix_to_srgb(image);
  image.chromaticities.reset();
  const auto r = find_channel(image, "R");
  const auto g = find_channel(image, "G");
  const auto b = find_channel(image, "B");
  if (!matrix || !r || !g || !b) return image;
  for (std::size_t i = 0; i < image.values.size(); i += image.channels.size()) {
    float* const pixel = image.values.data() + i;
    const Vec3d rgb = Vec3d(pixel[*r], pixel[*g], pixel[*b]) * *matrix;
    pixel[*r] = static_cast<float>(rgb.x);
    pixel[*g] = static_cast<float>(rgb.y);
    pixel[*b] = static_cast<float>(rgb.z);
  }
  return image;
}

float srgb_from_linear(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

float linear_from_srgb(float encoded) {
  return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

}  // namespace freepath
