#pragma once
/// @file Drawing directions by the pixels of an image of the whole sphere.

#include <cstddef>
#include <span>
#include <vector>

#include "freepath/base/distributions.h"

namespace freepath {

/// Pixels drawn by tables: a row, then one of its columns. All pixels of a row have the same solid
/// angle, and within a pixel all directions are equally likely.
class PixelDraws {
 public:
  PixelDraws() = default;
  /// @param importance of a direction in each pixel, row by row, not negative; if all are 0,
  ///   directions are drawn uniformly
  /// @param solid_angles of a pixel of each row [sr]
  PixelDraws(std::vector<double> importance, std::vector<double> solid_angles);

  struct Choice {
    AliasChoice row, column;
  };
  Choice choose(float u0, float u1) const {
    const AliasChoice row = freepath::choose(rows_, u1);
    const std::span<const AliasEntry> columns(columns_.data() + row.index * width_, width_);
    return {row, freepath::choose(columns, u0)};
  }
  /// Density of a direction in a pixel [1/sr].
  float pdf(std::size_t pixel) const { return pdf_[pixel]; }

  /// Draws what is above the mean alone. The rest is found as well by paths that go there by
  /// themselves, with which multiple importance sampling shares: its compensation [Karlik19], with
  /// the mean as the constant.
  PixelDraws above_mean() const;
  /// Variance where nothing is drawn over that where above_mean() is: of a path that scatters
  /// twice, isotropically, before it leaves, and draws light both times, half of which is in
  /// shadow. Brightness is what this draws in proportion to; 0 where all directions are equally
  /// bright.
  double gain_above_mean() const;

 private:
  std::size_t width_ = 0;
  std::vector<float> pdf_;            // of pixels [1/sr]
  std::vector<double> solid_angles_;  // of a pixel of each row [sr]
  std::vector<AliasEntry> rows_;
  std::vector<AliasEntry> columns_;  // a table for each row
};

}  // namespace freepath
