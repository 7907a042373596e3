#include "freepath/media/brick_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "freepath/base/error.h"

namespace freepath {
namespace {

TEST(BrickMap, ValuesAreWhereTheyWerePutAndZeroElsewhere) {
  BrickMapBuilder builder(Vec3i(-9, 0, 5), Vec3i(20, 3, 40), 4);
  builder.set_voxel(Vec3i(-9, 0, 5), 1.5F);
  builder.set_voxel(Vec3i(20, 3, 40), 2.5F);
  const BrickMap map = std::move(builder).finish();
  EXPECT_EQ(map.value(Vec3i(-9, 0, 5)), 1.5F);
  EXPECT_EQ(map.value(Vec3i(20, 3, 40)), 2.5F);
  EXPECT_EQ(map.value(Vec3i(-8, 0, 5)), 0.0F);
  EXPECT_EQ(map.value(Vec3i(-9, 8, 5)), 0.0F);
}

TEST(BrickMap, OutsideOfTheIndexIsZero) {
  BrickMapBuilder builder(Vec3i(0), Vec3i(7), 1);
  builder.add_constant_brick(Vec3i(0), 3.0F);
  const BrickMap map = std::move(builder).finish();
  for (const int far : {-1000000, -100, 100, 1000000}) {
    EXPECT_EQ(map.value(Vec3i(far, 0, 0)), 0.0F);
    EXPECT_EQ(map.value(Vec3i(0, far, 0)), 0.0F);
    EXPECT_EQ(map.value(Vec3i(0, 0, far)), 0.0F);
    EXPECT_EQ(map.interpolate(Vec3d(far, 0.5, 0.5)), 0.0);
  }
}

TEST(BrickMap, IndexReachesTwoVoxelsBeyondTheActiveOnes) {
  for (int low = -9; low <= 9; ++low) {
    const BrickMap map = BrickMapBuilder(Vec3i(low), Vec3i(low + 3), 1).finish();
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(map.origin()[axis], low - 2);
      EXPECT_GT(map.origin()[axis] + map.brick_counts()[axis] * BrickMap::kBrickSize, low + 3 + 2);
      EXPECT_EQ(map.origin()[axis] % BrickMap::kBrickSize, 0);
    }
  }
}

TEST(BrickMap, BricksOfOneValueAreStoredOnce) {
  BrickMapBuilder builder(Vec3i(0), Vec3i(127), 2);
  builder.add_constant_bricks(Vec3i(0), Vec3i(16), 0.25F);
  builder.add_constant_brick(Vec3i(3, 4, 5), 0.5F);
  builder.add_constant_brick(Vec3i(5, 4, 3), 0.5F);
  const BrickMap map = std::move(builder).finish();
  EXPECT_EQ(map.brick_count(), 3U);  // empty, 0.25 and 0.5
  EXPECT_EQ(map.value(Vec3i(0)), 0.25F);
  EXPECT_EQ(map.value(Vec3i(127)), 0.25F);
  EXPECT_EQ(map.value(Vec3i(24, 39, 47)), 0.5F);
  EXPECT_EQ(map.value(Vec3i(40, 32, 24)), 0.5F);
  EXPECT_EQ(map.value(Vec3i(128, 0, 0)), 0.0F);
}

TEST(BrickMap, WritingIntoASharedBrickLeavesTheOthersAlone) {
  BrickMapBuilder builder(Vec3i(0), Vec3i(15, 7, 7), 2);
  builder.add_constant_bricks(Vec3i(0), Vec3i(2, 1, 1), 1.0F);
  builder.set_voxel(Vec3i(0), 9.0F);
  const BrickMap map = std::move(builder).finish();
  EXPECT_EQ(map.value(Vec3i(0)), 9.0F);
  EXPECT_EQ(map.value(Vec3i(0, 0, 1)), 1.0F);
  EXPECT_EQ(map.value(Vec3i(8, 0, 0)), 1.0F);
}

TEST(BrickMap, BricksAddedTogetherStartAtZeroInTheirOrder) {
  BrickMapBuilder builder(Vec3i(0), Vec3i(31, 7, 7), 2);
  const Vec3i bricks[] = {Vec3i(3, 0, 0), Vec3i(1, 0, 0)};
  const std::span<float> voxels = builder.add_bricks(bricks);
  ASSERT_EQ(voxels.size(), 2U * BrickMap::kBrickVoxels);
  EXPECT_TRUE(std::ranges::all_of(voxels, [](float v) { return v == 0; }));
  voxels[0] = 1.0F;
  voxels[BrickMap::kBrickVoxels + 64 * 1 + 8 * 2 + 3] = 2.0F;
  builder.set_active_bounds(Vec3i(9, 2, 3), Vec3i(24, 2, 3));
  const BrickMap map = std::move(builder).finish();
  EXPECT_EQ(map.value(Vec3i(24, 0, 0)), 1.0F);
  EXPECT_EQ(map.value(Vec3i(9, 2, 3)), 2.0F);
  EXPECT_EQ(map.active_min(), Vec3i(9, 2, 3));
}

// A trilinear interpolant reproduces a function that is linear in each coordinate.
TEST(BrickMap, InterpolationIsExactForATrilinearFunction) {
  const auto function = [](const Vec3d& p) {
    return 1 + 2 * p.x - p.y + 0.5 * p.z + 0.25 * p.x * p.y * p.z + p.x * p.z;
  };
  BrickMapBuilder builder(Vec3i(-10), Vec3i(10), 64);
  for (int x = -10; x <= 10; ++x) {
    for (int y = -10; y <= 10; ++y) {
      for (int z = -10; z <= 10; ++z) {
        builder.set_voxel(Vec3i(x, y, z), static_cast<float>(function(Vec3d(x, y, z))));
      }
    }
  }
  const BrickMap map = std::move(builder).finish();
  for (const Vec3d& p :
       {Vec3d(0.25, 0.5, 0.75), Vec3d(-7.5, 7.9, -0.1), Vec3d(7.999, -8.25, 3.5)}) {
    EXPECT_NEAR(map.interpolate(p), function(p), 1e-4);
  }
}

TEST(BrickMap, BoundsThatNeedTooLargeAnIndexAreRefused) {
  EXPECT_THROW(BrickMapBuilder(Vec3i(0), Vec3i(100000, 100000, 100000), 1), Error);
  EXPECT_THROW(BrickMapBuilder(Vec3i(std::numeric_limits<int>::min()), Vec3i(0), 1), Error);
  EXPECT_THROW(BrickMapBuilder(Vec3i(0), Vec3i(std::numeric_limits<int>::max()), 1), Error);
}

TEST(BrickMap, BricksOutsideTheBoundsAreRefused) {
  BrickMapBuilder builder(Vec3i(0), Vec3i(7), 1);
  EXPECT_THROW(builder.add_brick(Vec3i(50, 0, 0)), Error);
  EXPECT_THROW(builder.add_constant_bricks(Vec3i(0), Vec3i(1, 1, 50), 1.0F), Error);
}

TEST(BrickMap, EmptyMapReadsAsZero) {
  const BrickMap map = BrickMapBuilder(Vec3i(0), Vec3i(-1), 0).finish();
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(map.value(Vec3i(0)), 0.0F);
}

}  // namespace
}  // namespace freepath
