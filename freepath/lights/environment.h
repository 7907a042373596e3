#pragma once
/// @file Light from everywhere around: an image in latitude-longitude form.
///
/// Directions are unit vectors from the scene towards the light [world]: the direction of travel of
/// a ray that escapes. All that is called per path is inline, pure and in single precision.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "freepath/base/distributions.h"
#include "freepath/base/page_allocator.h"
#include "freepath/base/rgb.h"
#include "freepath/base/turn.h"
#include "freepath/base/up_axis.h"
#include "freepath/base/vector.h"
#include "freepath/io/image.h"
#include "freepath/lights/pixel_draws.h"

namespace freepath {

/// What an escaping ray sees, and how likely light sampling would have chosen its direction.
struct LightValue {
  Rgb radiance{0.0F};
  float pdf = 0;  ///< [1/sr]
};

/// A direction that was drawn, and what `evaluate` gives for it but where rounding moves it over
/// the edge of a pixel.
struct LightDirection {
  Vec3f direction;
  LightValue light;
};

/// A point of a latitude-longitude image; both coordinates run from 0 to 1, (0, 0) is the upper
/// left corner. The convention is OpenEXR's: with y up, the centre of the image is the direction
/// +z, +x lies a quarter to the left of it, -x a quarter to the right, and the top row is the
/// zenith. With z up the centre is -y (up_axis.h).
struct LatLong {
  float u, v;
};

inline LatLong lat_long(const Vec3f& direction, UpAxis up) {
  const Vec3f d = to_y_up(direction, up);
  constexpr float kInversePi = std::numbers::inv_pi_v<float>;
  return {0.5F - fast_atan2(d.x, d.z) * (0.5F * kInversePi),
          fast_atan2(std::sqrt(d.x * d.x + d.z * d.z), d.y) * kInversePi};
}

/// The inverse of lat_long.
/// @param u horizontal coordinate in [0, 1]
/// @param height cosine of the angle from the zenith
inline Vec3f lat_long_direction(float u, float height, UpAxis up) {
  const SinCos longitude = sincos_of_turn(u);  // from -z
  const float reach = std::sqrt(std::max(0.0F, (1.0F - height) * (1.0F + height)));
  return from_y_up({reach * longitude.sine, height, -reach * longitude.cosine}, up);
}

/// An image of the whole sphere, read bilinearly and sampled by importance.
///
/// A direction is drawn by choosing a pixel and then a point of equal solid-angle density within
/// it. A pixel's probability is the luminance of the bilinear interpolant, averaged over the pixel,
/// times its solid angle; so the density is constant in a pixel, finite at the poles, and 0 only
/// where the interpolant is black. An image that is black everywhere is sampled uniformly.
class ImageEnvironment {
 public:
  /// @param image linear values with the channels R, G, B or Y; it spans the whole sphere
  /// @param name what to call the image in messages
  /// @throws Error that names the pixel, if a value is negative, infinite or NaN
  ImageEnvironment(const Image& image, UpAxis up, const std::string& name);

  /// Inline, since a call would cost a tenth of it.
  [[gnu::always_inline]] LightValue evaluate(const Vec3f& direction) const {
    const LatLong position = lat_long(direction, up_);
    const float x = position.u * static_cast<float>(width_);
    const float y = position.v * static_cast<float>(height_);
    const int column = std::clamp(static_cast<int>(x), 0, width_ - 1);
    const int row = std::clamp(static_cast<int>(y), 0, height_ - 1);
    return {interpolate(x - 0.5F, y - 0.5F), texels_[texel(column, row)][kPdf]};
  }

  /// A direction drawn with its density.
  LightDirection sample(float u0, float u1) const {
    const auto [row, column] = draws_.choose(u0, u1);
    const float top = row_heights_[row.index];
    const float bottom = row_heights_[row.index + 1];
    const float x = static_cast<float>(column.index) + column.remainder;
    const float height = top + (bottom - top) * row.remainder;
    const float reach = std::sqrt(std::max(0.0F, (1.0F - height) * (1.0F + height)));
    const float y =
        fast_atan2(reach, height) * std::numbers::inv_pi_v<float> * static_cast<float>(height_);
    const std::size_t pixel = texel(static_cast<int>(column.index), static_cast<int>(row.index));
    return {lat_long_direction(x / static_cast<float>(width_), height, up_),
            {interpolate(x - 0.5F, y - 0.5F), texels_[pixel][kPdf]}};
  }

  /// Integral of the radiance over all directions.
  Rgb fluence() const { return fluence_; }

  int width() const { return width_; }
  int height() const { return height_; }

  /// Tables by which `sample` draws directions.
  const PixelDraws& draws() const { return draws_; }
  /// Replaces them; `evaluate` then gives their densities.
  void set_draws(PixelDraws draws);

 private:
  std::size_t texel(int column, int row) const {
    return static_cast<std::size_t>(row) * width_ + column;
  }

  /// Bilinear interpolant at a point whose unit is the pixel, (0, 0) the centre of the first; it
  /// wraps around horizontally and is continued by the last row at the poles.
  [[gnu::always_inline]] Rgb interpolate(float x, float y) const {
    // Not below -1, so that truncating x + 1 rounds x down.
    int column0 = static_cast<int>(x + 1.0F) - 1;
    const int above = static_cast<int>(y + 1.0F) - 1;
    const float fx = x - static_cast<float>(column0);
    const float fy = y - static_cast<float>(above);
    int column1 = column0 + 1;
    if (column0 < 0) column0 += width_;
    if (column1 >= width_) column1 -= width_;
    const int row0 = std::clamp(above, 0, height_ - 1);
    const int row1 = std::clamp(above + 1, 0, height_ - 1);
    const Texel& left0 = texels_[texel(column0, row0)];
    const Texel& right0 = texels_[texel(column1, row0)];
    const Texel& left1 = texels_[texel(column0, row1)];
    const Texel& right1 = texels_[texel(column1, row1)];
    Texel mean;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const float upper = left0[i] * (1.0F - fx) + right0[i] * fx;
      const float lower = left1[i] * (1.0F - fx) + right1[i] * fx;
      mean[i] = upper * (1.0F - fy) + lower * fy;
    }
    return {mean[0], mean[1], mean[2]};
  }

  /// Mean of the interpolant over a pixel.
  Rgb mean_over_texel(int column, int row) const;

  int width_, height_;
  UpAxis up_;
  /// R, G, B of a pixel and its density [1/sr], in one register.
  struct alignas(16) Texel : std::array<float, 4> {};
  static constexpr std::size_t kPdf = 3;
  std::vector<Texel, PageAllocator<Texel>> texels_;  // read at random
  std::vector<float> row_heights_;  // cosine of the zenith angle at the rows' upper edges
  PixelDraws draws_;
  Rgb fluence_{0.0F};
};

}  // namespace freepath
