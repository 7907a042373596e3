#pragma once
/// @file A sparse set of boxes, gathered into few disjoint ones that are full enough for a dense
/// index each.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freepath/base/vector.h"

namespace freepath {

/// Half-open box of positions of a grid of voxels [voxels].
struct GridBox {
  Vec3i begin{0};
  Vec3i end{0};

  Vec3i size() const { return end - begin; }
  void extend(const GridBox& other) {
    for (int axis = 0; axis < 3; ++axis) {
      begin[axis] = std::min(begin[axis], other.begin[axis]);
      end[axis] = std::max(end[axis], other.end[axis]);
    }
  }
  bool operator==(const GridBox&) const = default;
};

/// Disjoint boxes, the leaves, which together hold a set of items, and the tree of halves that a
/// ray meets them by, front to back. Gaps between items are cut first; where there is none that
/// saves much, a box is halved, and the items there are cut in two.
///
/// The dense indices over all leaves take memory in proportion to the items, not to the box around
/// them: a leaf has at most kFullLeaf blocks for each of its items.
class BoxTree {
 public:
  /// Edge of a block [voxels], that of a brick.
  static constexpr int kBlock = 8;
  /// Blocks of a leaf for each of its items, or for each block that an item fills.
  static constexpr double kFullLeaf = 32;

  struct Leaf {
    GridBox box;            ///< The items in it, to their bounds or to where the box is cut.
    std::size_t items = 0;  ///< How many they are, cut ones counted in each leaf.
  };

  BoxTree() = default;
  explicit BoxTree(std::vector<GridBox> items);

  std::span<const Leaf> leaves() const { return leaves_; }

  /// Blocks of the dense index that a box takes, which reaches beyond it by two voxels.
  static double blocks_of(const GridBox& box);
  /// Blocks that items fill, at least one each.
  static double filled_blocks(std::span<const GridBox> items);

  /// Calls f(leaf, t) for the leaves that a ray meets, in the order in which it does; it is at or
  /// in the leaf at t. A leaf that it misses by a trifle may be among them.
  /// @param origin,direction in positions, per unit of t; finite
  template <class Function>
  void for_each_on_ray(const Vec3d& origin, const Vec3d& direction, double t_max,
                       Function f) const {
    if (nodes_.empty()) return;
    constexpr double kSlowest = 1e-30;
    Vec3d inverse;
    for (int axis = 0; axis < 3; ++axis) {
      inverse[axis] = 1 / (std::abs(direction[axis]) < kSlowest ? kSlowest : direction[axis]);
    }
    descend(0, origin, inverse, t_max, f);
  }

 private:
  struct Node {
    GridBox box;
    int axis = 0;                ///< What the halves lie apart along.
    int32_t halves[2] = {0, 0};  ///< Nodes, the lower half first.
    int32_t leaf = -1;           ///< Number of the leaf, if it is one; then it has no halves.
  };

  int32_t add(std::vector<GridBox> items);

  template <class Function>
  void descend(int32_t number, const Vec3d& origin, const Vec3d& inverse, double t_max,
               Function& f) const {
    const Node& node = nodes_[static_cast<std::size_t>(number)];
    double begin = 0;
    double end = t_max;
    for (int axis = 0; axis < 3; ++axis) {
      const double trifle = 0.01 + 1e-6 * node.box.size()[axis];
      const double low = (node.box.begin[axis] - trifle - origin[axis]) * inverse[axis];
      const double high = (node.box.end[axis] + trifle - origin[axis]) * inverse[axis];
      begin = std::max(begin, std::min(low, high));
      end = std::min(end, std::max(low, high));
    }
    if (!(begin <= end)) return;
    if (node.leaf >= 0) return f(static_cast<std::size_t>(node.leaf), begin);
    const int nearer = inverse[node.axis] >= 0 ? 0 : 1;
    descend(node.halves[nearer], origin, inverse, t_max, f);
    descend(node.halves[1 - nearer], origin, inverse, t_max, f);
  }

  std::vector<Node> nodes_;  ///< The whole first.
  std::vector<Leaf> leaves_;
};

}  // namespace freepath
