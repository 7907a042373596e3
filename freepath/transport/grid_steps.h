#pragma once
/// @file One ray's way through a grid of unit cells, in scalar code: the digital differential
/// analyser [Amanatides87] that media/segments-inl.h has in lanes.

#include "freepath/base/vector.h"

namespace freepath {

/// Steps through the cells that hold parts of the ray in [begin, end). Cells only ever advance in
/// the ray's direction, whatever rounding does, so every walk ends.
class GridSteps {
 public:
  GridSteps() = default;
  /// @param origin,direction in units of cells; cell (i,j,k) covers [i,i+1) x [j,j+1) x [k,k+1)
  GridSteps(const Vec3d& origin, const Vec3d& direction, double begin, double end);

  bool done() const { return done_; }
  const Vec3i& cell() const { return cell_; }
  /// Where the ray enters the present cell.
  double begin() const { return t_; }

  /// Leaves the cube of all cells nearer than `radius` >= 1 to the present one.
  /// @return where that happens, at most the end
  double leave(int radius);

 private:
  Vec3d origin_, direction_;
  Vec3d inverse_;  ///< 1/direction, infinite where that is 0
  double t_ = 0, end_ = 0;
  Vec3i cell_;
  bool done_ = true;
};

}  // namespace freepath
