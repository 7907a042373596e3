#pragma once
/// @file Light from everywhere around: an octahedral image.

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/io/image.h"
#include "freepath/render/environment.h"
#include "freepath/render/lights/octahedral.h"
#include "freepath/render/sampling.h"

namespace freepath {

/// A square image of the whole sphere, read bilinearly (pbrt-v4 reads the nearest pixel) and
/// sampled by importance. As in ImageEnvironment a pixel is drawn with the probability of the
/// luminance of the interpolant averaged over it, and a uniform point in it; all pixels have the
/// same solid angle.
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
    return {Spectrum(interpolate(x - 0.5F, y - 0.5F)), pdf_[texel(column, row)]};
  }

  /// A direction whose density is what `evaluate` returns.
  Vec3f sample(float u0, float u1) const {
    const AliasChoice row = choose(rows_, u1);
    const std::span<const AliasEntry> columns(
        columns_.data() + texel(0, static_cast<int>(row.index)), static_cast<std::size_t>(size_));
    const AliasChoice column = choose(columns, u0);
    const auto size = static_cast<float>(size_);
    return direction_from_octahedral({(static_cast<float>(column.index) + column.remainder) / size,
                                      (static_cast<float>(row.index) + row.remainder) / size});
  }

  /// Luminance of the integral of the radiance over all directions.
  double fluence() const { return fluence_; }
  int size() const { return size_; }

 private:
  std::size_t texel(int column, int row) const {
    return static_cast<std::size_t>(row) * size_ + column;
  }
  const Vec3f& wrapped(int column, int row) const {
    const OctahedralTexel t = wrap_octahedral(column, row, size_);
    return radiance_[texel(t.column, t.row)];
  }

  /// Bilinear interpolant at a point whose unit is the pixel, (0, 0) the centre of the first.
  Vec3f interpolate(float x, float y) const {
    // Not below -1, so that truncating x + 1 rounds x down.
    const int column = static_cast<int>(x + 1.0F) - 1;
    const int row = static_cast<int>(y + 1.0F) - 1;
    const float fx = x - static_cast<float>(column);
    const float fy = y - static_cast<float>(row);
    if (column >= 0 && row >= 0 && column + 1 < size_ && row + 1 < size_) {
      const Vec3f* upper = &radiance_[texel(column, row)];
      const Vec3f* lower = upper + size_;
      return (upper[0] * (1.0F - fx) + upper[1] * fx) * (1.0F - fy) +
             (lower[0] * (1.0F - fx) + lower[1] * fx) * fy;
    }
    return (wrapped(column, row) * (1.0F - fx) + wrapped(column + 1, row) * fx) * (1.0F - fy) +
           (wrapped(column, row + 1) * (1.0F - fx) + wrapped(column + 1, row + 1) * fx) * fy;
  }

  Vec3f mean_over_texel(int column, int row) const;

  int size_;
  std::vector<Vec3f> radiance_;
  std::vector<float> pdf_;  // [1/sr], for each pixel
  std::vector<AliasEntry> rows_;
  std::vector<AliasEntry> columns_;  // a table for each row
  double fluence_ = 0;
};

}  // namespace freepath
