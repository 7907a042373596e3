#include "freepath/media/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "freepath/base/random.h"

namespace freepath::testing {
namespace {

TEST(BoxTree, LeavesHoldTheItemsAndLittleElse) {
  RandomStream random(9, 0, 0, 0);
  std::vector<GridBox> items;
  for (int i = 0; i < 2000; ++i) {
    GridBox item;
    for (int axis = 0; axis < 3; ++axis) {
      item.begin[axis] = static_cast<int>(random.uniform() * (i < 1000 ? 4000 : 300)) * 8 - 1;
      item.end[axis] = item.begin[axis] + 10;
    }
    items.push_back(item);
  }
  const BoxTree tree(items);
  double blocks = 0;
  std::size_t held = 0;
  for (const BoxTree::Leaf& leaf : tree.leaves()) {
    blocks += BoxTree::blocks_of(leaf.box);
    held += leaf.items;
  }
  EXPECT_GE(held, items.size());
  EXPECT_LE(held, 2 * items.size());
  EXPECT_LE(blocks, BoxTree::kFullLeaf * static_cast<double>(held));
  for (const GridBox& item : items) {
    double volume = 0;
    for (const BoxTree::Leaf& leaf : tree.leaves()) {
      double common = 1;
      for (int axis = 0; axis < 3; ++axis) {
        common *= std::max(0, std::min(item.end[axis], leaf.box.end[axis]) -
                                  std::max(item.begin[axis], leaf.box.begin[axis]));
      }
      volume += common;
    }
    ASSERT_EQ(volume, 1000);  // once, wherever it is cut
  }
}

TEST(BoxTree, RaysMeetTheLeavesThatTheyPassThroughInOrder) {
  RandomStream random(10, 0, 0, 0);
  std::vector<GridBox> items;
  for (int i = 0; i < 400; ++i) {
    const Vec3i at(static_cast<int>(random.uniform() * 400),
                   static_cast<int>(random.uniform() * 400),
                   static_cast<int>(random.uniform() * 400));
    items.push_back({at * 8, at * 8 + Vec3i(10)});
  }
  const BoxTree tree(items);
  std::size_t met = 0;
  for (int ray = 0; ray < 300; ++ray) {
    const GridBox& aim = items[static_cast<std::size_t>(ray)];
    Vec3d origin(random.uniform(), random.uniform(), random.uniform());
    origin *= 3200;
    Vec3d direction = Vec3d(aim.begin) + Vec3d(5) - origin;
    if (ray % 3 == 0) direction[ray % 9 / 3] = 0;
    const double t_max = ray % 2 == 0 ? 1.5 : HUGE_VAL;
    std::vector<double> times(tree.leaves().size(), -1);
    double before = 0;
    tree.for_each_on_ray(origin, direction, t_max, [&](std::size_t leaf, double t) {
      EXPECT_GE(t, before - 1e-3);
      before = t;
      times[leaf] = t;
      ++met;
    });
    for (std::size_t leaf = 0; leaf < times.size(); ++leaf) {
      double begin = 0;
      double end = t_max;
      for (int axis = 0; axis < 3; ++axis) {
        const GridBox& box = tree.leaves()[leaf].box;
        const double low = (box.begin[axis] - origin[axis]) / direction[axis];
        const double high = (box.end[axis] - origin[axis]) / direction[axis];
        if (direction[axis] == 0 && !(low < 0 && high > 0) && !(low > 0 && high < 0)) end = -1;
        if (direction[axis] == 0) continue;
        begin = std::max(begin, std::min(low, high));
        end = std::min(end, std::max(low, high));
      }
      if (!(begin < end)) continue;
      ASSERT_GE(times[leaf], 0) << "ray " << ray << " misses leaf " << leaf;
      ASSERT_LE(times[leaf], begin);
    }
  }
  EXPECT_GT(met, 150);
}

}  // namespace
}  // namespace freepath::testing
