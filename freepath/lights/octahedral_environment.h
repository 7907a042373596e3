#pragma once
/// @file Light from everywhere around: an octahedral image.

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/octahedral.h"
#include "freepath/base/vector.h"
#include "freepath/io/image.h"
#include "freepath/lights/environment.h"
#include "freepath/lights/pixel_draws.h"

namespace freepath {

/// A square image of the whole sphere, each pixel of one colour, as pbrt-v4 reads it. A pixel is
/// drawn with the probability of its luminance, and a uniform point in it; all pixels have the same
/// solid angle.
class OctahedralEnvironment {
 public:
  /// @param luminance_weights of the colours' R, G and B
  /// @throws Error that names the image, if it is not square or a value is not finite
  OctahedralEnvironment(const Image& image, const Vec3f& luminance_weights,
                        const std::string& name);

  LightValue evaluate(const Vec3f& direction) const {
    const SquarePoint p = octahedral_from_direction(direction);
    const float x = p.u * static_cast<float>(size_);
    const float y = p.v * static_cast<float>(size_);
    const int column = std::clamp(static_cast<int>(x), 0, size_ - 1);
    const int row = std::clamp(static_cast<int>(y), 0, size_ - 1);
    return {Rgb(radiance_[texel(column, row)]), draws_.pdf(texel(column, row))};
  }

  /// A direction drawn with its density.
  LightDirection sample(float u0, float u1) const {
    const auto [row, column] = draws_.choose(u0, u1);
    const float scale = 1.0F / static_cast<float>(size_);
    const std::size_t pixel = texel(static_cast<int>(column.index), static_cast<int>(row.index));
    return {
        direction_from_octahedral({(static_cast<float>(column.index) + column.remainder) * scale,
                                   (static_cast<float>(row.index) + row.remainder) * scale}),
        {Rgb(radiance_[pixel]), draws_.pdf(pixel)}};
  }

  /// Luminance of the integral of the radiance over all directions.
  double fluence() const { return fluence_; }
  int size() const { return size_; }

  /// Tables by which `sample` draws directions.
  const PixelDraws& draws() const { return draws_; }
  /// Replaces them; `evaluate` then gives their densities.
  void set_draws(PixelDraws draws) { draws_ = std::move(draws); }

 private:
  std::size_t texel(int column, int row) const {
    return static_cast<std::size_t>(row) * size_ + column;
  }
  int size_;
  std::vector<Vec3f> radiance_;
  PixelDraws draws_;
  double fluence_ = 0;
};

}  // namespace freepath
