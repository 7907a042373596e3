#include "freepath/media/voxel_range.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace freepath {
namespace {

/// Range of a whole brick, by eight running ranges side by side, which compilers put into lanes.
ValueRange range_of_brick(const float* voxels) {
  constexpr int kRow = BrickMap::kBrickSize;
  float least[kRow];
  float largest[kRow];
  for (int z = 0; z < kRow; ++z) least[z] = largest[z] = voxels[z];
  for (int row = kRow; row < BrickMap::kBrickVoxels; row += kRow) {
    for (int z = 0; z < kRow; ++z) {
      const float value = voxels[row + z];
      least[z] = value < least[z] ? value : least[z];
      largest[z] = value > largest[z] ? value : largest[z];
    }
  }
  ValueRange range;
  for (int z = 0; z < kRow; ++z) range.add({least[z], largest[z]});
  return range;
}

}  // namespace

VoxelRanges::VoxelRanges(const BrickMap& map) : map_(map), bricks_(map.brick_count()) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, bricks_.size()), [&](const auto& part) {
    for (std::size_t brick = part.begin(); brick < part.end(); ++brick) {
      bricks_[brick] = range_of_brick(map_.voxels().data() + brick * BrickMap::kBrickVoxels);
    }
  });
}

ValueRange VoxelRanges::of_box(const Vec3i& begin, const Vec3i& end) const {
  return map_.is_sparse() ? of_listed(begin, end) : of_box(map_.window(), begin, end);
}

ValueRange VoxelRanges::of_box(const BrickWindow& window, const Vec3i& begin,
                               const Vec3i& end) const {
  ValueRange range;
  const Vec3i& counts = window.brick_counts;
  Vec3i first;
  Vec3i last;
  for (int axis = 0; axis < 3; ++axis) {
    if (begin[axis] < 0 || end[axis] > counts[axis] * BrickMap::kBrickSize) range.add(0.0F);
    first[axis] = std::max(begin[axis] >> 3, 0);
    last[axis] = std::min((end[axis] - 1) >> 3, counts[axis] - 1);
  }
  for (int x = first.x; x <= last.x; ++x) {
    for (int y = first.y; y <= last.y; ++y) {
      for (int z = first.z; z <= last.z; ++z) {
        const std::size_t entry = (static_cast<std::size_t>(x) * counts.y + y) * counts.z + z;
        const Vec3i corner = Vec3i(x, y, z) * BrickMap::kBrickSize;
        add_brick(window.index[entry], begin - corner, end - corner, range);
      }
    }
  }
  return range;
}

ValueRange VoxelRanges::of_listed(const Vec3i& begin, const Vec3i& end) const {
  ValueRange range;
  const Vec3i origin = map_.origin() / BrickMap::kBrickSize;
  Vec3i first;
  Vec3i last;
  double wanted = 1;
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = origin[axis] + (begin[axis] >> 3);
    last[axis] = origin[axis] + ((end[axis] - 1) >> 3);
    wanted *= last[axis] - first[axis] + 1;
  }
  const std::span<const PlacedBrick> bricks = map_.listed_bricks();
  auto listed = std::partition_point(bricks.begin(), bricks.end(), [&](const PlacedBrick& brick) {
    return brick.coord.x < first.x;
  });
  double found = 0;
  for (; listed != bricks.end() && listed->coord.x <= last.x; ++listed) {
    const Vec3i& coord = listed->coord;
    if (coord.y < first.y || coord.y > last.y || coord.z < first.z || coord.z > last.z) continue;
    const Vec3i corner = (coord - origin) * BrickMap::kBrickSize;
    add_brick(listed->brick, begin - corner, end - corner, range);
    found += 1;
  }
  if (found < wanted) range.add(0.0F);
  return range;
}

/// @param begin,end counted from the brick's first voxel; may reach beyond it
void VoxelRanges::add_brick(std::size_t brick, const Vec3i& begin, const Vec3i& end,
                            ValueRange& range) const {
  constexpr int kSize = BrickMap::kBrickSize;
  const ValueRange& whole = bricks_[brick];
  if (range.contains(whole)) return;
  const Vec3i low(std::max(begin.x, 0), std::max(begin.y, 0), std::max(begin.z, 0));
  const Vec3i high(std::min(end.x, kSize), std::min(end.y, kSize), std::min(end.z, kSize));
  if (high - low == Vec3i(kSize) || whole.minimum == whole.maximum) return range.add(whole);
  const float* const voxels = map_.voxels().data() + brick * BrickMap::kBrickVoxels;
  float least = range.minimum;
  float largest = range.maximum;
  for (int x = low.x; x < high.x; ++x) {
    for (int y = low.y; y < high.y; ++y) {
      const float* const row = voxels + (x << 6 | y << 3);
      for (int z = low.z; z < high.z; ++z) {
        least = std::min(least, row[z]);
        largest = std::max(largest, row[z]);
      }
    }
  }
  range = {least, largest};
}

}  // namespace freepath
