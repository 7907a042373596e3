// Few voxels far apart: what they cost follows the voxels and not the box around them, as counts of
// work and bytes, and what is read of them is right.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "freepath/media/medium.h"
#include "freepath/media/voxel_range.h"
#include "tests/media/sparse_field.h"

namespace freepath::testing {
namespace {

/// Single voxels at random places of a cube, now and then two beside each other.
std::vector<PlacedVoxel> random_voxels(int count, int extent, uint32_t seed) {
  RandomStream random(seed, 1, 2, 3);
  const auto coordinate = [&] {
    return static_cast<int>((random.uniform() - 0.5F) * static_cast<float>(extent));
  };
  std::vector<PlacedVoxel> voxels;
  for (int i = 0; i < count; ++i) {
    const Vec3i voxel(coordinate(), coordinate(), coordinate());
    voxels.push_back({voxel, 0.1F + random.uniform()});
    if (i % 5 == 0) voxels.push_back({voxel + Vec3i(0, 1, 0), 0.1F + random.uniform()});
  }
  return voxels;
}

Medium medium_of_fields(const std::vector<std::shared_ptr<Field>>& fields) {
  std::vector<Component> components(fields.size());
  for (std::size_t k = 0; k < fields.size(); ++k) components[k].density = fields[k];
  return Medium(std::move(components));
}

/// What a medium costs, counted.
struct Costs {
  std::size_t parts = 0;
  std::size_t cells = 0;
  std::size_t radius_steps = 0;
  std::size_t index_entries = 0;
  std::size_t bytes = 0;
};

Costs costs_of(const Medium& medium) {
  Costs costs;
  costs.parts = medium.parts().size();
  costs.cells = medium.super_voxel_count();
  costs.bytes = medium.memory_bytes();
  for (const Component& component : medium.components()) {
    costs.bytes += component.density->voxels.memory_bytes();
    costs.index_entries += component.density->voxels.index().size();
  }
  for (const WalkPart& part : medium.parts()) {
    costs.radius_steps += part.cells.radius_steps;
    for (const BrickWindow& window : part.windows) {
      costs.index_entries += window.cut_out ? window.entry_count() : 0;
    }
  }
  return costs;
}

TEST(SparseExtents, CostsOfTwoCloudsDoNotDependOnTheWayBetweenThem) {
  for (const Vec3i& direction : {Vec3i(1, 0, 0), Vec3i(0, 1, 0), Vec3i(1, 1, -1), Vec3i(4, 1, 2)}) {
    const Costs near =
        costs_of(medium_of_fields({field_of_voxels(two_clouds(direction * (1 << 18)))}));
    EXPECT_EQ(near.parts, 2);
    EXPECT_LT(near.cells, 20'000);
    EXPECT_LT(near.index_entries, 200);
    EXPECT_LT(near.bytes, std::size_t{1} << 20);
    for (const int times : {1 << 19, 1 << 20}) {
      const Costs far =
          costs_of(medium_of_fields({field_of_voxels(two_clouds(direction * times))}));
      EXPECT_EQ(far.parts, near.parts) << direction << " by " << times;
      EXPECT_EQ(far.cells, near.cells) << direction << " by " << times;
      EXPECT_EQ(far.radius_steps, near.radius_steps) << direction << " by " << times;
      EXPECT_EQ(far.index_entries, near.index_entries) << direction << " by " << times;
      EXPECT_EQ(far.bytes, near.bytes) << direction << " by " << times;
    }
  }
}

TEST(SparseExtents, CostsGrowLikeTheVoxelsAtEveryExtent) {
  for (const int extent : {1 << 14, 1 << 18, 1 << 22}) {
    const Costs few = costs_of(medium_of_fields({field_of_voxels(random_voxels(250, extent, 1))}));
    const Costs many =
        costs_of(medium_of_fields({field_of_voxels(random_voxels(1000, extent, 2))}));
    EXPECT_LT(few.bytes, 250U * 16'384U) << extent;  // a brick of voxels is 2048
    EXPECT_LT(few.cells, 250U * 500U) << extent;
    EXPECT_LT(many.bytes, 5 * few.bytes) << extent;
    EXPECT_LT(many.cells, 5 * few.cells) << extent;
    EXPECT_LT(many.radius_steps, 5 * few.radius_steps) << extent;
  }
}

TEST(SparseExtents, ADiagonalOfBricksCostsWhatItsBricksCost) {
  const auto diagonal = [](int bricks) {
    std::vector<PlacedVoxel> voxels;
    voxels.reserve(bricks);
    for (int i = 0; i < bricks; ++i) voxels.push_back({Vec3i(8 * i), 1});
    return costs_of(medium_of_fields({field_of_voxels(voxels)}));
  };
  const Costs some = diagonal(500);
  const Costs more = diagonal(2000);
  EXPECT_LT(some.bytes, 500U * 32'768U);
  EXPECT_LT(more.bytes, 5 * some.bytes);
  EXPECT_LT(more.cells, 5 * some.cells);
}

// One dense line of cells: the search for empty cubes looks at each a few times.
TEST(SparseExtents, TheSearchForEmptyCubesIsLinearInALineOfCells) {
  const auto steps = [](int length) {
    BrickMapBuilder builder(Vec3i(0), Vec3i(length, 0, 0), 2);
    builder.set_voxel(Vec3i(0), 1);
    builder.set_voxel(Vec3i(length, 0, 0), 1);
    const BrickMap map = std::move(builder).finish();
    const BrickMap* const maps[] = {&map};
    return build_super_voxels(maps, std::vector<float>{1}, 8);
  };
  const SuperVoxels some = steps(1 << 15);
  const SuperVoxels more = steps(1 << 17);
  EXPECT_GT(some.radius_steps, some.cell_count());
  EXPECT_LT(some.radius_steps, 20 * some.cell_count());
  EXPECT_LT(double(more.radius_steps), 4.1 * double(some.radius_steps));
}

TEST(SparseExtents, VoxelsAreFoundAndAllElseIsEmpty) {
  const std::vector<PlacedVoxel> voxels = random_voxels(500, 1 << 20, 3);
  const auto field = field_of_voxels(voxels);
  ASSERT_TRUE(field->voxels.is_sparse());
  std::map<std::tuple<int, int, int>, float> values;
  for (const auto& [voxel, value] : voxels) values[{voxel.x, voxel.y, voxel.z}] = value;
  for (const auto& [voxel, unused] : voxels) {
    for (int corner = 0; corner < 27; ++corner) {
      const Vec3i at = voxel + Vec3i(corner / 9, corner / 3 % 3, corner % 3) - Vec3i(1);
      const auto found = values.find({at.x, at.y, at.z});
      ASSERT_EQ(field->voxels.value(at), found == values.end() ? 0.0F : found->second);
    }
  }
  EXPECT_EQ(field->voxels.value(Vec3i(1 << 28)), 0.0F);
}

TEST(SparseExtents, RangesOfBoxesAreThoseOfTheirVoxels) {
  const auto field = field_of_voxels(two_clouds(Vec3i(1 << 16, -(1 << 16), 40)));
  const BrickMap& map = field->voxels;
  ASSERT_TRUE(map.is_sparse());
  const VoxelRanges ranges(map);
  RandomStream random(5, 0, 0, 0);
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3i cloud = trial % 2 == 0 ? Vec3i(0) : Vec3i(1 << 16, -(1 << 16), 40);
    Vec3i begin;
    Vec3i end;
    for (int axis = 0; axis < 3; ++axis) {
      begin[axis] = cloud[axis] - 6 + static_cast<int>(random.uniform() * 20);
      end[axis] = begin[axis] + 1 + static_cast<int>(random.uniform() * 9);
    }
    ValueRange expected;
    for (int x = begin.x; x < end.x; ++x) {
      for (int y = begin.y; y < end.y; ++y) {
        for (int z = begin.z; z < end.z; ++z) expected.add(map.value(Vec3i(x, y, z)));
      }
    }
    const ValueRange found = ranges.of_box(begin - map.origin(), end - map.origin());
    EXPECT_EQ(found.minimum, expected.minimum);
    EXPECT_EQ(found.maximum, expected.maximum);
  }
  const ValueRange all = ranges.of_box(Vec3i(0), map.brick_counts() * BrickMap::kBrickSize);
  EXPECT_EQ(all.minimum, 0);
  EXPECT_EQ(all.maximum, 0.02F + 0.01F * 10);
}

TEST(SparseExtents, WindowsAreCutOutOfListsAndOfDenseIndicesAlike) {
  const auto sparse = field_of_voxels(two_clouds(Vec3i(1 << 17)));
  BrickMapBuilder builder(Vec3i(-3), Vec3i(60), 0);
  for (const auto& [voxel, value] : two_clouds(Vec3i(40, 17, 25))) builder.set_voxel(voxel, value);
  const BrickMap dense = std::move(builder).finish();
  const BrickMap* const maps[] = {&sparse->voxels, &dense};
  for (const BrickMap* const map : maps) {
    const Vec3i begin(-3, -2, -1);
    const Vec3i end(4, 7, 9);
    const BrickWindow window = map->window(begin, end);
    const uint32_t* entry = window.index;
    for (int x = begin.x; x < end.x; ++x) {
      for (int y = begin.y; y < end.y; ++y) {
        for (int z = begin.z; z < end.z; ++z) EXPECT_EQ(*entry++, map->brick_at(Vec3i(x, y, z)));
      }
    }
  }
}

TEST(SparseExtents, ASolidVolumeIsOnePart) {
  BrickMapBuilder builder(Vec3i(0), Vec3i(8 * 42 - 1), 1, 42 * 42 * 42);
  builder.add_constant_bricks(Vec3i(0), Vec3i(42), 1.0F);
  auto field = std::make_shared<Field>();
  field->voxels = std::move(builder).finish();
  EXPECT_FALSE(field->voxels.is_sparse());
  EXPECT_EQ(medium_of_fields({field}).parts().size(), 1);
}

// ---- Parts ------------------------------------------------------------------------------------

bool holds(const GridBox& box, const Vec3d& position) {
  for (int axis = 0; axis < 3; ++axis) {
    if (position[axis] < box.begin[axis] || position[axis] > box.end[axis]) return false;
  }
  return true;
}

TEST(SparseExtents, PartsAreDisjointAndHoldTheReachOfEveryVoxel) {
  std::vector<PlacedVoxel> voxels = random_voxels(300, 1 << 12, 4);
  for (int i = 0; i < 300; ++i) voxels.push_back({Vec3i(8 * i, 8 * i + 5000, 4 * i), 1});
  const Medium medium = medium_of_fields({field_of_voxels(voxels)});
  const std::vector<WalkPart>& parts = medium.parts();
  ASSERT_GT(parts.size(), 20);
  for (std::size_t a = 0; a < parts.size(); ++a) {
    for (std::size_t b = a + 1; b < parts.size(); ++b) {
      bool apart = false;
      for (int axis = 0; axis < 3; ++axis) {
        apart = apart || parts[a].box.end[axis] <= parts[b].box.begin[axis] ||
                parts[b].box.end[axis] <= parts[a].box.begin[axis];
      }
      ASSERT_TRUE(apart) << a << " and " << b;
    }
  }
  RandomStream random(6, 0, 0, 0);
  for (const auto& [voxel, value] : voxels) {
    for (int trial = 0; trial < 20; ++trial) {
      const Vec3d index =
          Vec3d(voxel) + Vec3d(random.uniform(), random.uniform(), random.uniform()) * 2 - Vec3d(1);
      const Vec3d position = index * medium.world_to_grid();  // index space is the world here
      ASSERT_TRUE(std::any_of(parts.begin(), parts.end(),
                              [&](const WalkPart& part) { return holds(part.box, position); }));
    }
  }
}

Vec3d carried(const Vec3d& point, const AffineMap& map) {
  Vec3d result;
  for (int to = 0; to < 3; ++to) {
    result[to] = map.offset[to];
    for (int from = 0; from < 3; ++from) result[to] += point[from] * map.linear[from][to];
  }
  return result;
}

Matrix4d turned(const Vec3d& move) {
  return Matrix4d().setScale(Vec3d(0.5, 0.6, 0.7)) * Matrix4d().rotate(Vec3d(0.3, -0.4, 0.5)) *
         Matrix4d().setTranslation(move);
}

/// Media of several parts: one field, two of one transform, two that are turned apart.
std::vector<Medium> media_in_parts() {
  std::vector<PlacedVoxel> line = two_clouds(Vec3i(1 << 14, 300, -9000));
  for (int i = 0; i < 150; ++i) line.push_back({Vec3i(8 * i, 3000 + 8 * i, 8 * i), 0.3F});
  const std::vector<PlacedVoxel> other = two_clouds(Vec3i(-5000, 8, 5));
  std::vector<Medium> media;
  media.push_back(medium_of_fields({field_of_voxels(line)}));
  media.push_back(medium_of_fields({field_of_voxels(line), field_of_voxels(other)}));
  media.push_back(medium_of_fields(
      {field_of_voxels(line, turned(Vec3d(0))),
       field_of_voxels(other, turned(Vec3d(2, 3, 1)) * Matrix4d().rotate(Vec3d(0.1)))}));
  media.push_back(medium_of_fields(
      {field_of_voxels(two_clouds(Vec3i(20, 0, 0)), turned(Vec3d(0))),
       field_of_voxels(two_clouds(Vec3i(30, 9, 0)),
                       turned(Vec3d(3e4, -2e4, 1e4)) * Matrix4d().rotate(Vec3d(0.01)))}));
  return media;
}

// What the lanes read: through the maps of a part the voxels of each component stand where they do
// in the world, and the part's super-voxels bound them.
TEST(SparseExtents, PartsReadTheComponentsWhereTheyAreAndBoundThem) {
  RandomStream random(8, 0, 0, 0);
  for (const Medium& medium : media_in_parts()) {
    ASSERT_GT(medium.parts().size(), 1);
    const Matrix4d to_world = medium.world_to_grid().inverse();
    std::size_t hits = 0;
    for (const WalkPart& part : medium.parts()) {
      const Vec3d middle = medium.middle_of(part);
      const AffineMap to_walk = medium.world_to_walk(part, middle);
      for (int trial = 0; trial < 400; ++trial) {
        Vec3d position;
        for (int axis = 0; axis < 3; ++axis) {
          const double size = part.box.end[axis] - part.box.begin[axis];
          position[axis] = part.box.begin[axis] + random.uniform() * size;
        }
        const Vec3d world = position * to_world;
        const Vec3d walk = carried(world - middle, to_walk);
        const SuperVoxels& cells = part.cells;
        Vec3i cell;
        for (int axis = 0; axis < 3; ++axis) {
          cell[axis] = std::clamp(static_cast<int>(walk[axis]), 0, cells.counts[axis] - 1);
        }
        const std::size_t record =
            ((std::size_t(cell.x) * cells.counts.y + cell.y) * cells.counts.z + cell.z) *
            cells.components;
        for (std::size_t k = 0; k < medium.components().size(); ++k) {
          const Field& field = *medium.components()[k].density;
          const BrickWindow& window = part.windows[k];
          const Vec3d index = world * field.index_to_world.inverse();
          const Vec3d in_window =
              carried(walk, medium.walk_to_component(part, k)) - Vec3d(0.5) + Vec3d(window.origin);
          ASSERT_LT((index - in_window).length(), 2e-3);
          const double density = field.voxels.interpolate(index);
          hits += density > 0 ? 1 : 0;
          ASSERT_LE(density, cells.maxima[record + k] * (1 + 1e-6));
          ASSERT_GE(density, cells.minima[record + k] * (1 - 1e-6));
          if (density == 0) continue;
          for (int axis = 0; axis < 3; ++axis) {
            const int voxel = static_cast<int>(std::floor(in_window[axis])) - window.origin[axis];
            ASSERT_GE(voxel, 0);
            ASSERT_LT(voxel + 1, window.brick_counts[axis] * BrickMap::kBrickSize);
          }
        }
      }
    }
    EXPECT_GT(hits, 300);
  }
}

// Overlapping volumes of different transforms, near and far: the costs are the same.
TEST(SparseExtents, CostsOfTwoTransformsDoNotDependOnTheWayBetweenThem) {
  const auto costs = [](double apart) {
    const auto cloud = two_clouds(Vec3i(4, 0, 0));
    return costs_of(medium_of_fields(
        {field_of_voxels(cloud, turned(Vec3d(0))),
         field_of_voxels(cloud, Matrix4d().rotate(Vec3d(0.2)) * turned(Vec3d(apart, 0.3, 0)))}));
  };
  const Costs near = costs(1e4);
  const Costs far = costs(4e4);
  EXPECT_EQ(near.parts, 2);
  EXPECT_EQ(far.parts, near.parts);
  EXPECT_LT(near.bytes, std::size_t{1} << 20);
  EXPECT_LT(double(far.bytes), 1.2 * double(near.bytes));  // corners of boxes fall otherwise
  EXPECT_LT(double(far.radius_steps), 1.2 * double(near.radius_steps));
}

TEST(SparseExtents, ExtentsBeyondThePrecisionOfFloatsAreOneClearError) {
  const auto field = field_of_voxels(two_clouds(Vec3i(1 << 24, 0, 0)));
  try {
    medium_of_fields({field});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("grid 'sparse' is more than 8388608 voxels long"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace freepath::testing
