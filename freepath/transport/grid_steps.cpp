#include "freepath/transport/grid_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace freepath {
namespace {

constexpr double kSlowest = 1e-300;

}  // namespace

GridSteps::GridSteps(const Vec3d& origin, const Vec3d& direction, double begin, double end)
    : origin_(origin), direction_(direction), t_(begin), end_(end), done_(!(begin < end)) {
  for (int axis = 0; axis < 3; ++axis) {
    cell_[axis] = static_cast<int>(std::floor(origin[axis] + direction[axis] * begin));
    // So slow along an axis that its inverse would overflow: it never gets to the next cell.
    if (std::abs(direction[axis]) < kSlowest) direction_[axis] = 0;
    inverse_[axis] = 1 / direction_[axis];
  }
}

double GridSteps::leave(int radius) {
  double exits[3];
  int planes[3];
  for (int axis = 0; axis < 3; ++axis) {
    planes[axis] = cell_[axis] + (direction_[axis] >= 0 ? radius : 1 - radius);
    exits[axis] = direction_[axis] == 0 ? std::numeric_limits<double>::infinity()
                                        : (planes[axis] - origin_[axis]) * inverse_[axis];
  }
  const int by = exits[0] <= exits[1] ? (exits[0] <= exits[2] ? 0 : 2)  //
                                      : (exits[1] <= exits[2] ? 1 : 2);
  done_ = !(exits[by] < end_);
  t_ = std::max(std::min(exits[by], end_), t_);
  if (done_) return t_;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis != by && radius == 1) continue;  // the cube is the cell
    const bool forward = direction_[axis] >= 0;
    // The crossed plane decides its own axis; along the others the point stays in the cube.
    const int last = forward ? planes[axis] - 1 : planes[axis];
    if (axis == by) {
      cell_[axis] = forward ? planes[axis] : planes[axis] - 1;
    } else {
      const auto found = static_cast<int>(std::floor(origin_[axis] + direction_[axis] * t_));
      cell_[axis] = std::clamp(found, std::min(cell_[axis], last), std::max(cell_[axis], last));
    }
  }
  return t_;
}

}  // namespace freepath
