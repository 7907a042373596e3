// Components that stand anyhow in the world: the space common to them, the maps from it, and the
// bounds of its super-voxels.

#include "freepath/media/walk_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "freepath/media/medium.h"
#include "tests/media/nearest_voxel.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

using FieldPointer = std::shared_ptr<const Field>;

Matrix4d placed(const Vec3d& scale, const Vec3d& turn, const Vec3d& move) {
  return Matrix4d().setScale(scale) * Matrix4d().rotate(turn) * Matrix4d().setTranslation(move);
}

float sparse_noise(const Vec3i& p) {
  const float noise = hash_noise(p);
  return noise < 0.7F ? 0.0F : noise;
}

struct NamedFields {
  std::string name;
  std::vector<FieldPointer> fields;
};

std::vector<NamedFields> all_pairs() {
  const auto noise = make_field(Vec3i(-7, 3, -20), Vec3i(21, 30, 9), hash_noise,
                                placed(Vec3d(0.1, 0.07, -0.12), Vec3d(0.3, 0.5, 0.2), Vec3d(0)));
  const auto beside = [&](const Vec3d& scale, const Vec3d& turn, const Vec3d& move) {
    return make_field(Vec3i(-9), Vec3i(12, 20, 8), sparse_noise, placed(scale, turn, move));
  };
  const Vec3d near(1, 1.5, 0.4);
  Matrix4d sheared = placed(Vec3d(0.2), Vec3d(0), near);
  sheared[0][1] = 0.15;
  std::vector<NamedFields> pairs;
  pairs.push_back({"turned", {noise, beside(Vec3d(0.1), Vec3d(-0.4, 1.1, 0.6), near)}});
  pairs.push_back({"coarse", {noise, beside(Vec3d(0.5, 0.3, 0.9), Vec3d(0.1, 0.2, 0.3), near)}});
  pairs.push_back({"fine", {noise, beside(Vec3d(0.02), Vec3d(0.1, -0.2, 2), near)}});
  pairs.push_back({"mirrored", {noise, beside(Vec3d(-0.1, 0.1, 0.1), Vec3d(0, 0, 0.8), near)}});
  pairs.push_back({"flat voxels", {noise, beside(Vec3d(0.6, 0.01, 0.3), Vec3d(1, 0, 1), near)}});
  pairs.push_back({"sheared", {noise, make_field(Vec3i(0), Vec3i(11), hash_noise, sheared)}});
  pairs.push_back({"apart", {noise, beside(Vec3d(0.1), Vec3d(1), Vec3d(9, -4, 3))}});
  pairs.push_back({"three",
                   {noise, beside(Vec3d(0.2), Vec3d(0.7), near),
                    beside(Vec3d(0.15), Vec3d(0, 2, 0), Vec3d(-1, 2, 0))}});
  const auto shifted = std::make_shared<Field>(*noise);
  shifted->index_to_world = Matrix4d().setTranslation(Vec3d(3, -2, 5)) * noise->index_to_world;
  pairs.push_back({"shifted by whole voxels", {noise, shifted}});
  return pairs;
}

Medium medium_of(const std::vector<FieldPointer>& fields, int super_voxel = 0) {
  std::vector<Component> components;
  for (const FieldPointer& field : fields) {
    Component component;
    component.density = field;
    components.push_back(component);
  }
  return Medium(std::move(components), super_voxel);
}

Vec3d mapped(const Vec3d& point, const AffineMap& map) {
  Vec3d result;
  for (int to = 0; to < 3; ++to) {
    result[to] = map.offset[to];
    for (int from = 0; from < 3; ++from) result[to] += point[from] * map.linear[from][to];
  }
  return result;
}

/// Index point for a place counted from the first voxel of a field's index.
Vec3d index_of(const Field& field, const Vec3d& position) {
  return position + Vec3d(field.voxels.origin()) - Vec3d(0.5);
}

TEST(WalkSpace, ItsMapsAgreeWithTheWayThroughTheWorld) {
  for (const NamedFields& pair : all_pairs()) {
    const Medium medium = medium_of(pair.fields, 8);
    ASSERT_FALSE(medium.aligned()) << pair.name;
    const AffineMap to_walk = medium.world_to_walk();
    RandomStream random(1, 0, 0, 0);
    for (int i = 0; i < 300; ++i) {
      Vec3d world;
      for (int axis = 0; axis < 3; ++axis) {
        const Box3d box = medium.world_bounds();
        world[axis] = box.min[axis] + box.size()[axis] * random.uniform();
      }
      for (std::size_t k = 0; k < pair.fields.size(); ++k) {
        const Field& field = *pair.fields[k];
        const Vec3d index =
            index_of(field, mapped(mapped(world, to_walk), medium.walk_to_component(k)));
        const Vec3d expected = world * field.index_to_world.inverse();
        // Floats over some thousand voxels.
        ASSERT_LT((index - expected).length(), 1e-3) << pair.name << ", component " << k;
      }
    }
  }
}

TEST(WalkSpace, HoldsAllComponentsWhereverTheyReach) {
  for (const NamedFields& pair : all_pairs()) {
    for (const int size : {4, 16}) {
      const Medium medium = medium_of(pair.fields, size);
      const AffineMap to_walk = medium.world_to_walk();
      const Box3f bounds = medium.walk_bounds(Interpolation::kTrilinear);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(bounds.min[axis], 0);
        EXPECT_LE(bounds.max[axis], medium.super_voxels().counts[axis]);
      }
      for (const FieldPointer& field : pair.fields) {
        for (int corner = 0; corner < 8; ++corner) {
          Vec3d index;
          for (int axis = 0; axis < 3; ++axis) {
            index[axis] = (corner >> axis & 1) != 0 ? field->voxels.active_max()[axis] + 1
                                                    : field->voxels.active_min()[axis] - 1;
          }
          const Vec3d walk = mapped(index * field->index_to_world, to_walk);
          for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(walk[axis], bounds.min[axis] - 1e-3) << pair.name;
            EXPECT_LE(walk[axis], bounds.max[axis] + 1e-3) << pair.name;
          }
        }
      }
    }
  }
}

/// How far what the interpolants see at a point [walk space] lies outside the bounds of a cell.
double excess(const Medium& medium, const Vec3i& cell, const Vec3d& point) {
  const SuperVoxels& cells = medium.super_voxels();
  const std::size_t record =
      ((std::size_t(cell.x) * cells.counts.y + cell.y) * cells.counts.z + cell.z) *
      cells.components;
  double largest = 0;
  for (int k = 0; k < cells.components; ++k) {
    const Field& field = *medium.components()[k].density;
    const Vec3d index = index_of(field, mapped(point, medium.walk_to_component(k)));
    for (const double value :
         {double(field.voxels.value(nearest_voxel(index))), field.voxels.interpolate(index)}) {
      largest =
          std::max({largest, value - cells.maxima[record + k], cells.minima[record + k] - value});
    }
  }
  return largest;
}

TEST(WalkSpace, SuperVoxelsBoundEveryInterpolantOfEveryComponent) {
  constexpr int kPoints = 4000;
  for (const NamedFields& pair : all_pairs()) {
    for (const int size : {4, 8, 32}) {
      const Medium medium = medium_of(pair.fields, size);
      const SuperVoxels& cells = medium.super_voxels();
      RandomStream random(2, static_cast<uint32_t>(size), 0, 0);
      for (int i = 0; i < kPoints; ++i) {
        Vec3i cell;
        Vec3d position;
        const auto beyond = static_cast<double>(i % 3) * 1e-4 / size;  // what rounding may do
        for (int axis = 0; axis < 3; ++axis) {
          cell[axis] = static_cast<int>(random.uniform() * float(cells.counts[axis]));
          position[axis] = random.uniform();
          // Every other point on a face, an edge or a corner, or just beyond.
          if (i % 2 != 0 && random.uniform() < 0.5F) {
            position[axis] = position[axis] < 0.5 ? -beyond : 1 + beyond;
          }
        }
        ASSERT_LE(excess(medium, cell, Vec3d(cell) + position), 1e-9)
            << pair.name << ", cells of " << size;
      }
    }
  }
}

// The bounds are worth something: where only one component is, the other's maximum is 0.
TEST(WalkSpace, SuperVoxelsFarFromAComponentDoNotHoldIt) {
  for (const NamedFields& pair : all_pairs()) {
    const Medium medium = medium_of(pair.fields, 4);
    const SuperVoxels& cells = medium.super_voxels();
    for (std::size_t k = 0; k < pair.fields.size(); ++k) {
      const Field& field = *pair.fields[k];
      const BrickMap& map = field.voxels;
      for (int x = 0; x < cells.counts.x; ++x) {
        for (int y = 0; y < cells.counts.y; y += 3) {
          for (int z = 0; z < cells.counts.z; z += 3) {
            const std::size_t record =
                ((std::size_t(x) * cells.counts.y + y) * cells.counts.z + z) * cells.components;
            // A ball around the cell, in voxels of the field.
            const AffineMap to_voxels = medium.walk_to_component(k);
            const Vec3d middle =
                index_of(field, mapped(Vec3d(x + 0.5, y + 0.5, z + 0.5), to_voxels));
            double apart = 0;
            double reach = 0;
            for (int axis = 0; axis < 3; ++axis) {
              double extent = 0;
              for (int from = 0; from < 3; ++from) {
                extent += std::abs(to_voxels.linear[from][axis]) / 2;
              }
              reach = extent + 3;
              apart = std::max({apart, map.active_min()[axis] - middle[axis] - reach,
                                middle[axis] - map.active_max()[axis] - reach});
            }
            if (apart > 0) {
              ASSERT_EQ(cells.maxima[record + k], 0) << pair.name;
            }
            if (cells.minima[record + k] > 0) {
              ASSERT_EQ(apart, 0) << pair.name;
            }
          }
        }
      }
    }
  }
}

// The same pair at another place of the world has the same maps and bounds.
TEST(WalkSpace, HasNoDistanceFromTheOriginOfTheWorld) {
  for (const NamedFields& pair : all_pairs()) {
    const Medium here = medium_of(pair.fields, 8);
    const Vec3d far(1e8, -3e8, 2e8);
    std::vector<FieldPointer> moved;
    for (const FieldPointer& field : pair.fields) {
      auto copy = std::make_shared<Field>(*field);
      copy->index_to_world *= Matrix4d().setTranslation(far);
      moved.push_back(copy);
    }
    const Medium there = medium_of(moved, 8);
    EXPECT_EQ(there.super_voxels().counts, here.super_voxels().counts) << pair.name;
    for (std::size_t k = 0; k < moved.size(); ++k) {
      const AffineMap a = here.walk_to_component(k);
      const AffineMap b = there.walk_to_component(k);
      EXPECT_EQ(a.linear, b.linear) << pair.name;
      // What doubles can tell of a place so far away, in voxels.
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(a.offset[axis], b.offset[axis], 3e8 * 0x1p-53 * 8 / 0.01) << pair.name;
      }
    }
  }
}

// A place beyond the voxels is held at the border of the index.
TEST(WalkSpace, TheBorderOfEveryIndexIsEmpty) {
  for (const NamedFields& pair : all_pairs()) {
    for (const FieldPointer& field : pair.fields) {
      const BrickMap& map = field->voxels;
      const Vec3i size = map.brick_counts() * BrickMap::kBrickSize;
      for (int axis = 0; axis < 3; ++axis) {
        for (int side = 0; side < 4; ++side) {
          const int layer = side < 2 ? side : size[axis] - 4 + side;
          for (int u = 0; u < size[(axis + 1) % 3]; ++u) {
            for (int v = 0; v < size[(axis + 2) % 3]; ++v) {
              Vec3i voxel;
              voxel[axis] = layer;
              voxel[(axis + 1) % 3] = u;
              voxel[(axis + 2) % 3] = v;
              ASSERT_EQ(map.value(map.origin() + voxel), 0);
            }
          }
        }
      }
    }
  }
}

std::string complaint(const std::vector<FieldPointer>& fields, int super_voxel = 0) {
  try {
    medium_of(fields, super_voxel);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(WalkSpace, RefusesFieldsThatSinglePrecisionCannotHoldTogether) {
  const auto near = make_field(Vec3i(0), Vec3i(5), hash_noise);
  const auto far =
      make_field(Vec3i(0), Vec3i(5), hash_noise, Matrix4d().setTranslation(Vec3d(3e7, 0.5, 0)));
  const std::string message = complaint({near, far});
  EXPECT_NE(message.find("too far apart"), std::string::npos) << message;
  EXPECT_NE(message.find("3e+07 voxels"), std::string::npos) << message;
  const auto fine = make_field(Vec3i(0), Vec3i(5), hash_noise, Matrix4d().setScale(Vec3d(1e-6)));
  EXPECT_NE(complaint({near, fine}).find("size of their voxels"), std::string::npos);
}

TEST(WalkSpace, RefusesATransformWithoutInverse) {
  const auto plain = make_field(Vec3i(0), Vec3i(5), hash_noise);
  const auto flat = make_field(Vec3i(0), Vec3i(5), hash_noise, Matrix4d().setScale(Vec3d(1, 1, 0)));
  EXPECT_EQ(complaint({plain, flat}), "grid 'test': its transform has no inverse");
}

TEST(WalkSpace, ALayoutIsSharedWithoutAChangeOfTheVoxels) {
  auto near = make_field(Vec3i(-7, 3, -20), Vec3i(21, 30, 9), hash_noise);
  auto beside = make_field(Vec3i(10, -30, 4), Vec3i(40, 5, 12), sparse_noise);
  const Field before[] = {*near, *beside};
  Field* const fields[] = {near.get(), beside.get()};
  EXPECT_FALSE(medium_of({near, beside}).aligned());
  share_layout(fields);
  EXPECT_TRUE(medium_of({near, beside}).aligned());
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(fields[k]->voxels.active_min(), before[k].voxels.active_min());
    EXPECT_EQ(fields[k]->voxels.active_max(), before[k].voxels.active_max());
    for (int x = -40; x < 60; ++x) {
      for (int y = -40; y < 60; ++y) {
        for (int z = -40; z < 60; ++z) {
          const Vec3i voxel(x, y, z);
          ASSERT_EQ(fields[k]->voxels.value(voxel), before[k].voxels.value(voxel)) << voxel;
        }
      }
    }
  }
}

TEST(WalkSpace, ALayoutIsNotSharedAcrossTransformsOrEmptySpace) {
  const auto near = make_field(Vec3i(0), Vec3i(5), hash_noise);
  const auto turned = make_field(Vec3i(0), Vec3i(5), hash_noise, Matrix4d().rotate(Vec3d(1)));
  const auto far = make_field(Vec3i(300), Vec3i(305), hash_noise);
  for (const auto& other : {turned, far}) {
    Field* const fields[] = {near.get(), other.get()};
    share_layout(fields);
    EXPECT_FALSE(medium_of({near, other}).aligned());
  }
}

// Voxels of very different sizes make large cells of the small ones, and not more than can be held.
TEST(WalkSpace, CellsGrowWhereVoxelsDifferInSize) {
  const auto fine = make_field(Vec3i(0), Vec3i(5), hash_noise);
  const auto coarse =
      make_field(Vec3i(0), Vec3i(5), hash_noise, Matrix4d().setScale(Vec3d(2000, 2000, 2000)));
  const Medium medium = medium_of({fine, coarse});
  EXPECT_EQ(medium.parts().size(), 1);
  EXPECT_GT(medium.super_voxels().cell_size, 64);
  EXPECT_LE(medium.super_voxels().cell_count(), std::size_t{4} << 20);
  EXPECT_NE(complaint({fine, coarse}, 8).find("8 voxels are more than can be walked through"),
            std::string::npos);
}

}  // namespace
}  // namespace freepath::testing
