#include "freepath/study/heat_map.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace freepath {
namespace {

using Color = std::array<uint8_t, 3>;  // sRGB

constexpr std::array<Color, 9> kDarkToBright = {{{68, 1, 84},
                                                 {71, 44, 122},
                                                 {59, 81, 139},
                                                 {44, 113, 142},
                                                 {33, 144, 141},
                                                 {39, 173, 129},
                                                 {92, 200, 99},
                                                 {170, 220, 50},
                                                 {253, 231, 37}}};
constexpr std::array<Color, 5> kDiverging = {
    {{33, 102, 172}, {146, 197, 222}, {247, 247, 247}, {244, 165, 130}, {178, 24, 43}}};
constexpr Color kUnknown = {128, 128, 128};

/// The colour at a place from 0 to 1, linear sRGB.
std::array<float, 3> color_at(std::span<const Color> colors, double position) {
  const double scaled = position * static_cast<double>(colors.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(scaled), colors.size() - 2);
  const auto share = static_cast<float>(scaled - static_cast<double>(below));
  std::array<float, 3> color;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const float from = colors[below][channel] / 255.0F;
    const float to = colors[below + 1][channel] / 255.0F;
    color[channel] = linear_from_srgb(from + share * (to - from));
  }
  return color;
}

std::span<const Color> colors_of(const ColorScale& scale) {
  if (scale.diverging) return kDiverging;
  return kDarkToBright;
}

}  // namespace

double ColorScale::position(double value) const {
  double position = (value - low) / (high - low);
  if (logarithmic) position = value > 0 ? std::log(value / low) / std::log(high / low) : 0;
  return std::clamp(position, 0.0, 1.0);
}

double ColorScale::value(double position) const {
  return logarithmic ? low * std::pow(high / low, position) : low + position * (high - low);
}

Image heat_map(std::span<const float> values, int width, int height, const ColorScale& scale) {
  Image image{.width = width, .height = height, .channels = {"R", "G", "B"}};
  const std::span<const Color> colors = colors_of(scale);
  for (const float value : values) {
    std::array<float, 3> color;
    if (std::isfinite(value)) {
      color = color_at(colors, scale.position(value));
    } else {
      const std::array<Color, 2> unknown = {kUnknown, kUnknown};
      color = color_at(unknown, 0);
    }
    image.values.insert(image.values.end(), color.begin(), color.end());
  }
  return image;
}

Image color_bar(const ColorScale& scale) {
  constexpr int kWidth = 256;
  std::vector<float> values;
  values.reserve(kWidth);
  for (int i = 0; i < kWidth; ++i) {
    values.push_back(static_cast<float>(scale.value((i + 0.5) / kWidth)));
  }
  return heat_map(values, kWidth, 1, scale);
}

ColorScale logarithmic_scale(const std::vector<std::span<const float>>& maps) {
  std::vector<float> values;
  for (const std::span<const float> map : maps) {
    std::copy_if(map.begin(), map.end(), std::back_inserter(values),
                 [](float value) { return value > 0 && std::isfinite(value); });
  }
  ColorScale scale{.low = 0.1, .high = 1, .logarithmic = true};
  if (values.empty()) return scale;
  const auto quantile = [&](double share) {
    const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return double{values[static_cast<std::size_t>(rank)]};
  };
  scale.high = quantile(0.998);
  scale.low = std::max(quantile(0.02), 1e-6 * scale.high);
  if (scale.low >= scale.high) scale.low = 0.1 * scale.high;
  return scale;
}

}  // namespace freepath
