#pragma once
/// @file Densities that a program computes, for media that stand in no file.

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "freepath/base/vector.h"
#include "freepath/media/field.h"

namespace freepath {

/// A density over a box, evaluated in batches. Walks call it from many threads at once.
struct DensityFunction {
  /// Least and largest density over a part of the box.
  struct Bounds {
    float minimum = 0;
    float maximum = 0;
  };

  /// Densities at positions [world], in the same slots; not negative, not NaN, not infinite.
  std::function<void(std::span<const Vec3f> positions, std::span<float> densities)> evaluate;
  /// Bounds of the density over a part of the box [world]. Trackers that need a bound are biased
  /// where the maximum is too low, which WalkStatistics::bound_violations counts.
  std::function<Bounds(const Box3f& part)> bounds;
  Box3f box;        ///< Where the density may differ from 0 [world].
  Vec3i cells{16};  ///< Super-voxels along each axis, 1 to 1024: how finely bounds are asked for.
};

/// A field of a computed density, to be used as a Component's. Components of one medium are all
/// computed or all of voxels, and share box and cells.
/// @throws Error for an empty box, a missing function, or cells out of range. Walks throw Error
///   when the function returns a density that is negative, NaN or infinite, naming the position.
std::shared_ptr<const Field> make_function_field(std::string name, DensityFunction function);

}  // namespace freepath
