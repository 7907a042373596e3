#include "freepath/media/walk_part.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "freepath/base/box.h"

namespace freepath {
namespace {

/// How far beyond a part's box its components are read, and rounding may move a position [voxels].
constexpr int kMargin = 2;

int brick_below(int voxel) { return voxel >> 3; }
int brick_above(int voxel) { return (voxel + BrickMap::kBrickSize - 1) >> 3; }

/// Windows of one layout, which makes the grid of the part.
void align_windows(const WalkSpace& space, std::span<const Field* const> fields, WalkPart& part) {
  Vec3i begin;
  Vec3i end;
  for (int axis = 0; axis < 3; ++axis) {
    begin[axis] = brick_below(space.origin[axis] + part.box.begin[axis] - kMargin);
    end[axis] = brick_above(space.origin[axis] + part.box.end[axis] + kMargin);
  }
  part.first = begin * BrickMap::kBrickSize - space.origin;
  for (const Field* field : fields) part.windows.push_back(field->voxels.window(begin, end));
}

class PartMaker {
 public:
  PartMaker(const WalkSpace& space, std::span<const Field* const> fields,
            std::span<const float> extinction, int cell_size)
      : space_(space), fields_(fields), extinction_(extinction), cell_size_(cell_size) {
    ranges_.reserve(fields.size());
    for (const Field* field : fields) ranges_.emplace_back(field->voxels);
  }

  /// The walk space as a whole.
  WalkPart whole() const {
    WalkPart part;
    part.box = {Vec3i(0), space_.voxel_counts};
    CellLimits limits;
    for (const Field* field : fields_) {
      part.windows.push_back(field->voxels.window());
      limits.most = std::max(limits.most, part.windows.back().entry_count());
    }
    build(space_.voxel_counts, limits, part);
    return part;
  }

  WalkPart of_leaf(const BoxTree::Leaf& leaf) const {
    check_part(space_, leaf.box, fields_);
    WalkPart part;
    part.box = leaf.box;
    Vec3i counts;
    if (space_.aligned) {
      align_windows(space_, fields_, part);
      counts = part.windows[0].brick_counts * BrickMap::kBrickSize;
    } else {
      part.first = leaf.box.begin - Vec3i(1);
      counts = leaf.box.size() + Vec3i(2);
      for (std::size_t k = 0; k < fields_.size(); ++k) {
        part.windows.push_back(window_of(fields_[k]->voxels, leaf.box, space_.to_component[k]));
      }
    }
    const std::size_t few = kCellsOfPart + kCellsOfItem * leaf.items;
    build(counts, {few, few}, part);
    return part;
  }

 private:
  /// Super-voxels of a part that are not too many, and for each brick in it.
  static constexpr std::size_t kCellsOfPart = 4096;
  static constexpr std::size_t kCellsOfItem = 128;

  void build(const Vec3i& counts, const CellLimits& limits, WalkPart& part) const {
    std::vector<PlacedVoxels> placed;
    for (std::size_t k = 0; k < fields_.size(); ++k) {
      const BrickWindow& window = part.windows[k];
      placed.push_back({&ranges_[k], window,
                        to_window(part, space_.to_component[k], fields_[k]->voxels, window)});
    }
    part.cells = build_super_voxels(placed, counts, extinction_, cell_size_, limits);
  }

  const WalkSpace& space_;
  std::span<const Field* const> fields_;
  std::span<const float> extinction_;
  int cell_size_;
  std::vector<VoxelRanges> ranges_;
};

}  // namespace

std::size_t WalkPart::memory_bytes() const {
  std::size_t bytes = sizeof(WalkPart) + cells.memory_bytes();
  for (const BrickWindow& window : windows) {
    bytes += sizeof(window);
    if (window.cut_out) bytes += window.cut_out->capacity() * sizeof(uint32_t);
  }
  return bytes;
}

Matrix4d to_window(const WalkPart& part, const Matrix4d& grid_to_field, const BrickMap& map,
                   const BrickWindow& window) {
  Matrix4d result = grid_to_field;
  const Vec3d first = Vec3d(part.first) * grid_to_field + Vec3d(map.origin() - window.origin);
  for (int axis = 0; axis < 3; ++axis) result[3][axis] = first[axis];
  return result;
}

BrickWindow window_of(const BrickMap& map, const GridBox& box, const Matrix4d& grid_to_field) {
  if (!map.is_sparse()) return map.window();
  const Box3d image = Imath::transform(Box3d(Vec3d(box.begin), Vec3d(box.end)), grid_to_field);
  // Within the map, at whose border all is empty, or a brick of that.
  const Vec3i origin = map.origin() / BrickMap::kBrickSize;
  Vec3i begin;
  Vec3i end;
  for (int axis = 0; axis < 3; ++axis) {
    const int voxels = map.brick_counts()[axis] * BrickMap::kBrickSize;
    const auto inside = [&](double position) { return std::clamp(position, 0.0, double(voxels)); };
    begin[axis] = brick_below(static_cast<int>(inside(std::floor(image.min[axis]) - kMargin)));
    end[axis] = brick_above(static_cast<int>(inside(std::ceil(image.max[axis]) + kMargin)));
    begin[axis] = std::min(begin[axis], map.brick_counts()[axis] - 1);
    end[axis] = std::max(end[axis], begin[axis] + 1);
  }
  return map.window(origin + begin, origin + end);
}

WalkParts make_walk_parts(const WalkSpace& space, std::span<const Field* const> fields,
                          std::span<const float> extinction, int cell_size) {
  WalkParts result;
  const PartMaker maker(space, fields, extinction, cell_size);
  if (!space.in_parts) {
    result.parts.push_back(maker.whole());
    return result;
  }
  std::vector<GridBox> occupied = space.occupied(fields);
  if (occupied.empty()) occupied.push_back({Vec3i(1), Vec3i(2)});  // as good a place as any
  result.tree = BoxTree(std::move(occupied));
  const auto leaves = result.tree.leaves();
  result.parts.resize(leaves.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves.size()), [&](const auto& some) {
    for (std::size_t i = some.begin(); i < some.end(); ++i) {
      result.parts[i] = maker.of_leaf(leaves[i]);
    }
  });
  return result;
}

}  // namespace freepath
