#include "freepath/media/box_tree.h"

#include <limits>
#include <utility>

namespace freepath {
namespace {

GridBox bounds_of(std::span<const GridBox> items) {
  GridBox bounds = items[0];
  for (const GridBox& item : items) bounds.extend(item);
  return bounds;
}

/// A plane between two halves.
struct Cut {
  int axis = 0;
  int plane = 0;
  double blocks = std::numeric_limits<double>::infinity();  ///< Of both halves.
};

/// The gap between the items along an axis that leaves the fewest blocks; sorts them along it.
Cut best_gap(std::vector<GridBox>& items, int axis) {
  std::sort(items.begin(), items.end(),
            [axis](const GridBox& a, const GridBox& b) { return a.begin[axis] < b.begin[axis]; });
  std::vector<double> after(items.size());  // blocks of the items from each on
  GridBox bounds = items.back();
  for (std::size_t i = items.size(); i-- > 0;) {
    bounds.extend(items[i]);
    after[i] = BoxTree::blocks_of(bounds);
  }
  Cut best;
  bounds = items.front();
  for (std::size_t i = 1; i < items.size(); ++i) {
    bounds.extend(items[i - 1]);
    if (bounds.end[axis] > items[i].begin[axis]) continue;
    const double blocks = BoxTree::blocks_of(bounds) + after[i];
    if (blocks < best.blocks) best = {axis, items[i].begin[axis], blocks};
  }
  return best;
}

/// The best gap if it saves half of the blocks, else the middle of the longest side.
Cut choose_cut(std::vector<GridBox>& items, const GridBox& bounds) {
  Cut best;
  for (int axis = 0; axis < 3; ++axis) {
    const Cut gap = best_gap(items, axis);
    if (gap.blocks < best.blocks) best = gap;
  }
  if (best.blocks <= BoxTree::blocks_of(bounds) / 2) return best;
  const Vec3i size = bounds.size();
  const int longest = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  return {longest, bounds.begin[longest] + size[longest] / 2};
}

}  // namespace

double BoxTree::blocks_of(const GridBox& box) {
  double blocks = 1;
  for (int axis = 0; axis < 3; ++axis) {
    // Two voxels on either side, and as many blocks as that can touch.
    const int64_t voxels = int64_t{box.end[axis]} - box.begin[axis] + 4;
    const int64_t touched = (voxels + 2 * int64_t{kBlock} - 2) / kBlock;
    blocks *= static_cast<double>(touched);
  }
  return blocks;
}

double BoxTree::filled_blocks(std::span<const GridBox> items) {
  double filled = 0;
  for (const GridBox& item : items) {
    const Vec3d blocks = Vec3d(item.size() / kBlock);
    filled += std::max(1.0, blocks.x * blocks.y * blocks.z);
  }
  return filled;
}

BoxTree::BoxTree(std::vector<GridBox> items) {
  if (!items.empty()) add(std::move(items));
}

int32_t BoxTree::add(std::vector<GridBox> items) {
  const auto number = static_cast<int32_t>(nodes_.size());
  Node node;
  node.box = bounds_of(items);
  const auto keep = [&] { nodes_[static_cast<std::size_t>(number)] = node; };
  nodes_.emplace_back();
  if (blocks_of(node.box) <= kFullLeaf * filled_blocks(items)) {
    node.leaf = static_cast<int32_t>(leaves_.size());
    leaves_.push_back({node.box, items.size()});
    keep();
    return number;
  }
  const Cut cut = choose_cut(items, node.box);
  node.axis = cut.axis;
  std::vector<GridBox> lower;
  std::vector<GridBox> upper;
  for (GridBox& item : items) {
    if (item.begin[cut.axis] < cut.plane) {
      lower.push_back(item);
      lower.back().end[cut.axis] = std::min(item.end[cut.axis], cut.plane);
    }
    if (item.end[cut.axis] > cut.plane) {
      upper.push_back(item);
      upper.back().begin[cut.axis] = std::max(item.begin[cut.axis], cut.plane);
    }
  }
  std::vector<GridBox>().swap(items);
  node.halves[0] = add(std::move(lower));
  node.halves[1] = add(std::move(upper));
  keep();
  return number;
}

}  // namespace freepath
