#pragma once
/// @file Light from everywhere around: an octahedral image.

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "freepath/base/distributions.h"
#include "freepath/base/octahedral.h"
#include "freepath/base/vector.h"
#include "freepath/io/image.h"
#include "freepath/lights/environment.h"

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
    return {Spectrum(radiance_[texel(column, row)]), pdf_[texel(column, row)]};
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
  int size_;
  std::vector<Vec3f> radiance_;
  std::vector<float> pdf_;  // [1/sr], for each pixel
  std::vector<AliasEntry> rows_;
  std::vector<AliasEntry> columns_;  // a table for each row
  double fluence_ = 0;
};

}  // namespace freepath
