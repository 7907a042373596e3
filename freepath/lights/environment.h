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
#include "freepath/base/lat_long.h"
#include "freepath/base/page_allocator.h"
#include "freepath/base/rgb.h"
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
    const LatLong position = lat_long(direction, grid_.up);
    const float x = position.u * static_cast<float>(grid_.width);
    const float y = position.v * static_cast<float>(grid_.height);
    return value_at(place_of(grid_, x, y), pixel_at(grid_, x, y));
  }
  /// The same for a direction that stands there.
  /// @param pixel that holds it
  [[gnu::always_inline]] LightValue value_at(const LatLongPlace& place, uint32_t pixel) const {
    return {interpolate(place), texels_[pixel][kPdf]};
  }
  /// Asks for the memory that value_at() reads.
  void prefetch(const LatLongPlace& place) const {
    for (const uint32_t corner : place.corners) __builtin_prefetch(&texels_[corner]);
  }

  /// A direction drawn with its density.
  LightDirection sample(float u0, float u1) const {
    const auto [row, column] = draws_.choose(u0, u1);
    const float top = row_heights_[row.index];
    const float bottom = row_heights_[row.index + 1];
    const float x = static_cast<float>(column.index) + column.remainder;
    const float height = top + (bottom - top) * row.remainder;
    const float reach = std::sqrt(std::max(0.0F, (1.0F - height) * (1.0F + height)));
    const float y = fast_atan2(reach, height) * std::numbers::inv_pi_v<float> *
                    static_cast<float>(grid_.height);
    const std::size_t pixel = texel(static_cast<int>(column.index), static_cast<int>(row.index));
    return {lat_long_direction(x / static_cast<float>(grid_.width), height, grid_.up),
            {interpolate(place_of(grid_, x, y)), texels_[pixel][kPdf]}};
  }

  /// Integral of the radiance over all directions.
  Rgb fluence() const { return fluence_; }

  const LatLongGrid& grid() const { return grid_; }

  /// Tables by which `sample` draws directions.
  const PixelDraws& draws() const { return draws_; }
  /// Replaces them; `evaluate` then gives their densities.
  void set_draws(PixelDraws draws);

 private:
  std::size_t texel(int column, int row) const {
    return static_cast<std::size_t>(row) * grid_.width + column;
  }

  [[gnu::always_inline]] Rgb interpolate(const LatLongPlace& place) const {
    const float fx = place.right;
    const float fy = place.down;
    const Texel& left0 = texels_[place.corners[0]];
    const Texel& right0 = texels_[place.corners[1]];
    const Texel& left1 = texels_[place.corners[2]];
    const Texel& right1 = texels_[place.corners[3]];
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

  LatLongGrid grid_;
  /// R, G, B of a pixel and its density [1/sr], in one register.
  struct alignas(16) Texel : std::array<float, 4> {};
  static constexpr std::size_t kPdf = 3;
  std::vector<Texel, PageAllocator<Texel>> texels_;  // read at random
  std::vector<float> row_heights_;  // cosine of the zenith angle at the rows' upper edges
  PixelDraws draws_;
  Rgb fluence_{0.0F};
};

}  // namespace freepath
