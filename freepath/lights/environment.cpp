#include "freepath/lights/environment.h"

#include <array>
#include <limits>
#include <utility>

#include "freepath/base/error.h"

namespace freepath {

namespace {

bool is_legal(const Rgb& s) { return is_finite(s) && s.x >= 0 && s.y >= 0 && s.z >= 0; }

}  // namespace

ImageEnvironment::ImageEnvironment(const Image& image, UpAxis up, const std::string& name)
    : grid_{image.width, image.height, up} {
  if (grid_.width < 1 || grid_.height < 1) fail("{}: the environment image is empty", name);
  if (image.pixel_count() > UINT32_MAX) {
    fail("{}: the environment image has {}x{} pixels; at most 2^32 - 1 can be told apart", name,
         grid_.width, grid_.height);
  }
  const std::array<int, 3> colour = colour_channels(image, name);
  texels_.reserve(image.pixel_count());
  for (int row = 0; row < grid_.height; ++row) {
    for (int column = 0; column < grid_.width; ++column) {
      const float* values = image.pixel(column, row);
      const Rgb s(values[colour[0]], values[colour[1]], values[colour[2]]);
      if (!is_legal(s)) {
        fail("{}: pixel ({}, {}) is {},{},{}; light must be finite and not negative", name, column,
             row, s.x, s.y, s.z);
      }
      texels_.push_back({{s.x, s.y, s.z, 0}});
    }
  }
  std::vector<double> heights(grid_.height + 1);
  for (int row = 0; row <= grid_.height; ++row) {
    heights[row] = std::cos(std::numbers::pi * row / grid_.height);
    row_heights_.push_back(static_cast<float>(heights[row]));
  }
  std::vector<double> importance(image.pixel_count());  // of a direction in each pixel
  Imath::Color3<double> fluence(0.0);
  std::vector<double> solid_angles;
  for (int row = 0; row < grid_.height; ++row) {
    const double solid_angle =
        2 * std::numbers::pi * (heights[row] - heights[row + 1]) / grid_.width;
    solid_angles.push_back(solid_angle);
    for (int column = 0; column < grid_.width; ++column) {
      const Rgb mean = mean_over_texel(column, row);
      for (int i = 0; i < kChannels; ++i) fluence[i] += mean[i] * solid_angle;
      importance[texel(column, row)] = luminance(mean);
    }
  }
  for (int i = 0; i < kChannels; ++i) {
    constexpr double kLargest = std::numeric_limits<float>::max();
    fluence_[i] = static_cast<float>(std::min(fluence[i], kLargest));
  }
  set_draws({std::move(importance), std::move(solid_angles)});
}

void ImageEnvironment::set_draws(PixelDraws draws) {
  draws_ = std::move(draws);
  for (std::size_t i = 0; i < texels_.size(); ++i) {
    texels_[i][kPdf] = draws_.pdf(i);
  }
}

Rgb ImageEnvironment::mean_over_texel(int column, int row) const {
  // The integral of the two hat functions that meet in a pixel: 3/4 of its own, 1/8 of each
  // neighbour's.
  constexpr std::array<float, 3> kWeights{0.125F, 0.75F, 0.125F};
  Rgb mean(0.0F);
  for (int dy = -1; dy <= 1; ++dy) {
    const int y = std::clamp(row + dy, 0, grid_.height - 1);
    for (int dx = -1; dx <= 1; ++dx) {
      const int x = (column + dx + grid_.width) % grid_.width;
      const Texel& one = texels_[texel(x, y)];
      mean += Rgb(one[0], one[1], one[2]) * (kWeights[dx + 1] * kWeights[dy + 1]);
    }
  }
  return mean;
}

}  // namespace freepath
