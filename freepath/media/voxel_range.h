#pragma once
/// @file Least and largest voxel of a box of a brick map.

#include <limits>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/media/brick_map.h"

namespace freepath {

/// Least and largest of the values added.
struct ValueRange {
  float minimum = std::numeric_limits<float>::infinity();
  float maximum = -std::numeric_limits<float>::infinity();

  void add(float value) { add({value, value}); }
  void add(const ValueRange& other) {
    minimum = other.minimum < minimum ? other.minimum : minimum;
    maximum = other.maximum > maximum ? other.maximum : maximum;
  }
  bool contains(const ValueRange& other) const {
    return minimum <= other.minimum && other.maximum <= maximum;
  }
};

/// Answers for one map, which must outlive it. Keeps the range of every brick, so that only bricks
/// that a box cuts, and that could widen its range, are read.
class VoxelRanges {
 public:
  explicit VoxelRanges(const BrickMap& map);

  const BrickMap& map() const { return map_; }

  /// Range of the voxels of the half-open box [begin, end), counted from the first of the index;
  /// those beyond the index are 0. Of a list of bricks the time is that of those in the box's slab.
  ValueRange of_box(const Vec3i& begin, const Vec3i& end) const;
  /// The range in a box that is counted from the first voxel of a window of the map; those beyond
  /// the window are 0.
  ValueRange of_box(const BrickWindow& window, const Vec3i& begin, const Vec3i& end) const;

 private:
  ValueRange of_listed(const Vec3i& begin, const Vec3i& end) const;
  void add_brick(std::size_t brick, const Vec3i& begin, const Vec3i& end, ValueRange& range) const;

  const BrickMap& map_;
  std::vector<ValueRange> bricks_;
};

}  // namespace freepath
