// The bounds of super-voxels against the interpolant itself and against brute force.

#include "freepath/media/super_voxels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "tests/media/nearest_voxel.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

struct NamedMap {
  std::string name;
  BrickMap map;
};

/// Constant bricks beside bricks of noise, with holes between and a tile on the very border.
BrickMap tiles() {
  BrickMapBuilder builder(Vec3i(-16), Vec3i(23), 0);
  builder.add_constant_bricks(Vec3i(-2), Vec3i(0, -1, 1), 0.75F);
  builder.add_constant_brick(Vec3i(2), 2.5F);
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) {
      for (int z = 8; z < 16; ++z) builder.set_voxel(Vec3i(x, y, z), hash_noise(Vec3i(x, y, z)));
    }
  }
  return std::move(builder).finish();
}

std::vector<NamedMap> all_maps() {
  const auto map_of = [](const Vec3i& low, const Vec3i& high, auto density) {
    return make_field(low, high, density)->voxels;
  };
  std::vector<NamedMap> maps;
  maps.push_back({"noise", map_of(Vec3i(-7, 3, -20), Vec3i(21, 30, 9), hash_noise)});
  maps.push_back({"noise on a pedestal", map_of(Vec3i(-30, -9, 1), Vec3i(9, 15, 16),
                                                [](auto& p) { return 5 + hash_noise(p); })});
  maps.push_back({"sparse", map_of(Vec3i(-9), Vec3i(26), [](const Vec3i& p) {
                    const float noise = hash_noise(p);
                    return noise < 0.003F ? 1000 * noise : 0;
                  })});
  maps.push_back({"sheets", map_of(Vec3i(-5), Vec3i(20), [](const Vec3i& p) {
                    return p.x == 7 || p.x + p.y - p.z == 11 ? 3.0F : 0.0F;
                  })});
  maps.push_back({"one voxel", map_of(Vec3i(7, 8, 15), Vec3i(7, 8, 15), [](auto&) { return 4; })});
  maps.push_back({"zeros", map_of(Vec3i(0), Vec3i(20), [](auto&) { return 0; })});
  maps.push_back({"tiles", tiles()});
  return maps;
}

SuperVoxels build(const BrickMap& map, int cell_size, float extinction = 1) {
  const BrickMap* const maps[] = {&map};
  return build_super_voxels(maps, std::vector<float>{extinction}, cell_size);
}

std::size_t index_of(const SuperVoxels& cells, const Vec3i& cell) {
  return (static_cast<std::size_t>(cell.x) * cells.counts.y + cell.y) * cells.counts.z + cell.z;
}

/// Calls f(cell) for every cell.
template <class Function>
void for_each_cell(const SuperVoxels& cells, Function f) {
  for (int x = 0; x < cells.counts.x; ++x) {
    for (int y = 0; y < cells.counts.y; ++y) {
      for (int z = 0; z < cells.counts.z; ++z) f(Vec3i(x, y, z));
    }
  }
}

/// How far a point's values lie outside the bounds of a cell.
double excess(const BrickMap& map, const SuperVoxels& cells, const Vec3i& cell, const Vec3d& p) {
  const std::size_t i = index_of(cells, cell);
  const double low = cells.minima[i];
  const double high = cells.maxima[i];
  double largest = 0;
  for (const double value : {double(map.value(nearest_voxel(p))), map.interpolate(p)}) {
    largest = std::max({largest, value - high, low - value});
  }
  return largest;
}

TEST(SuperVoxels, CoverTheWholeIndex) {
  for (const NamedMap& field : all_maps()) {
    for (const int size : kSuperVoxelSizes) {
      const SuperVoxels cells = build(field.map, size);
      EXPECT_EQ(cells.cell_size, size);
      for (int axis = 0; axis < 3; ++axis) {
        const int voxels = field.map.brick_counts()[axis] * BrickMap::kBrickSize;
        EXPECT_GE(cells.counts[axis] * size, voxels) << field.name;
        EXPECT_LT((cells.counts[axis] - 1) * size, voxels) << field.name;
      }
    }
  }
}

TEST(SuperVoxels, BoundTheInterpolantEverywhereInTheirCells) {
  constexpr int kPoints = 3000;
  for (const NamedMap& field : all_maps()) {
    for (const int size : kSuperVoxelSizes) {
      const SuperVoxels cells = build(field.map, size);
      RandomStream random(1, static_cast<uint32_t>(size), 0, 0);
      for (int i = 0; i < kPoints; ++i) {
        Vec3i cell;
        Vec3d position;  // in the cell, [0,1)
        for (int axis = 0; axis < 3; ++axis) {
          cell[axis] = static_cast<int>(random.uniform() * float(cells.counts[axis]));
          position[axis] = random.uniform();
        }
        // Voxel v covers the index points v - 0.5 to v + 0.5.
        const Vec3d corner = Vec3d(cell * size + field.map.origin()) - Vec3d(0.5);
        ASSERT_LE(excess(field.map, cells, cell, corner + position * size), 1e-9)
            << field.name << ", cells of " << size;
      }
    }
  }
}

// Rounding moves a position just over a face; the cell it came from must still bound it.
TEST(SuperVoxels, BoundTheInterpolantOnTheirFacesAndJustBeyond) {
  constexpr int kPoints = 1000;
  for (const NamedMap& field : all_maps()) {
    for (const int size : kSuperVoxelSizes) {
      const SuperVoxels cells = build(field.map, size);
      RandomStream random(2, static_cast<uint32_t>(size), 0, 0);
      for (int i = 0; i < kPoints; ++i) {
        Vec3i cell;
        Vec3d position;
        for (int axis = 0; axis < 3; ++axis) {
          cell[axis] = static_cast<int>(random.uniform() * float(cells.counts[axis]));
          position[axis] = random.uniform();
        }
        // A face, an edge or a corner.
        const int fixed = 1 + static_cast<int>(random.uniform() * 7);
        const int side = static_cast<int>(random.uniform() * 8);
        for (const double beyond : {-1e-5, 0.0, 1e-5}) {
          Vec3d p = Vec3d(cell * size + field.map.origin()) - Vec3d(0.5) + position * size;
          for (int axis = 0; axis < 3; ++axis) {
            if ((fixed >> axis & 1) == 0) continue;
            const bool high = (side >> axis & 1) != 0;
            p[axis] = (cell[axis] + (high ? 1 : 0)) * size + field.map.origin()[axis] - 0.5 +
                      (high ? beyond : -beyond);
          }
          ASSERT_LE(excess(field.map, cells, cell, p), 1e-9)
              << field.name << ", cells of " << size << ", " << beyond << " beyond";
        }
      }
    }
  }
}

TEST(SuperVoxels, AreTheRangeOfTheirVoxelsGrownByOne) {
  for (const NamedMap& field : all_maps()) {
    for (const int size : kSuperVoxelSizes) {
      const SuperVoxels cells = build(field.map, size);
      for_each_cell(cells, [&](const Vec3i& cell) {
        // Cells may reach beyond the index, where nothing is counted: what lies two voxels or more
        // outside is never read.
        const Vec3i low = cell * size + field.map.origin() - Vec3i(1);
        Vec3i high = low + Vec3i(size + 2);
        for (int axis = 0; axis < 3; ++axis) {
          high[axis] = std::min(high[axis],
                                field.map.origin()[axis] + field.map.brick_counts()[axis] * 8 + 1);
        }
        float minimum = field.map.value(low);
        float maximum = minimum;
        for (int x = low.x; x < high.x; ++x) {
          for (int y = low.y; y < high.y; ++y) {
            for (int z = low.z; z < high.z; ++z) {
              const float value = field.map.value(Vec3i(x, y, z));
              minimum = std::min(minimum, value);
              maximum = std::max(maximum, value);
            }
          }
        }
        ASSERT_EQ(cells.minima[index_of(cells, cell)], minimum) << field.name << ' ' << cell;
        ASSERT_EQ(cells.maxima[index_of(cells, cell)], maximum) << field.name << ' ' << cell;
      });
    }
  }
}

/// Chebyshev distance of every cell to the nearest that is not empty, by looking at all of them.
std::vector<int> brute_force_radius(const SuperVoxels& cells) {
  std::vector<Vec3i> full;
  for_each_cell(cells, [&](const Vec3i& cell) {
    for (int k = 0; k < cells.components; ++k) {
      if (cells.maxima[index_of(cells, cell) * cells.components + k] > 0) {
        full.push_back(cell);
        break;
      }
    }
  });
  std::vector<int> radius;
  for_each_cell(cells, [&](const Vec3i& cell) {
    int nearest = std::numeric_limits<int>::max();
    for (const Vec3i& other : full) {
      const Vec3i apart = cell - other;
      nearest =
          std::min(nearest, std::max({std::abs(apart.x), std::abs(apart.y), std::abs(apart.z)}));
    }
    radius.push_back(nearest);
  });
  return radius;
}

TEST(SuperVoxels, EmptyRadiusIsTheDistanceToTheNearestFullCell) {
  std::vector<NamedMap> maps = all_maps();
  // Few voxels in much space, so that radii get large.
  maps.push_back({"stars", make_field(Vec3i(0), Vec3i(70, 40, 55), [](const Vec3i& p) {
                             return hash_noise(p) < 3e-5F ? 1.0F : 0.0F;
                           })->voxels});
  for (const NamedMap& field : maps) {
    for (const int size : {4, 8, 16}) {
      const SuperVoxels cells = build(field.map, size);
      const std::vector<int> expected = brute_force_radius(cells);
      const int longest = std::max({cells.counts.x, cells.counts.y, cells.counts.z});
      ASSERT_EQ(cells.empty_radius.size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i) {
        if (expected[i] <= longest) {
          ASSERT_EQ(cells.empty_radius[i], expected[i]) << field.name;
        } else {
          ASSERT_GE(cells.empty_radius[i], longest) << field.name << " has no full cell";
        }
      }
    }
  }
}

TEST(SuperVoxels, KeepComponentsApartButAreEmptyOnlyWhereAllAre) {
  const Vec3i low(-3);
  const Vec3i high(40);
  const BrickMap left =
      make_field(low, high, [](const Vec3i& p) { return p.x < 5 ? 1 + hash_noise(p) : 0; })->voxels;
  const BrickMap right = make_field(low, high, [](const Vec3i& p) {
                           return p.x > 32 ? 7 + hash_noise(p) : 0;
                         })->voxels;
  const BrickMap* const maps[] = {&left, &right};
  for (const int size : kSuperVoxelSizes) {
    const SuperVoxels both = build_super_voxels(maps, std::vector<float>{1, 1}, size);
    const SuperVoxels only_left = build(left, size);
    const SuperVoxels only_right = build(right, size);
    ASSERT_EQ(both.components, 2);
    ASSERT_EQ(both.cell_count(), only_left.cell_count());
    for (std::size_t i = 0; i < both.cell_count(); ++i) {
      EXPECT_EQ(both.minima[2 * i], only_left.minima[i]);
      EXPECT_EQ(both.maxima[2 * i], only_left.maxima[i]);
      EXPECT_EQ(both.minima[2 * i + 1], only_right.minima[i]);
      EXPECT_EQ(both.maxima[2 * i + 1], only_right.maxima[i]);
    }
    const std::vector<int> radius = brute_force_radius(both);
    EXPECT_TRUE(std::equal(radius.begin(), radius.end(), both.empty_radius.begin()));
  }
}

TEST(SuperVoxels, AutomaticCellsShrinkAsTheMediumThickens) {
  const BrickMap map = make_field(Vec3i(0), Vec3i(100), hash_noise)->voxels;
  int before = 1000;
  std::vector<int> sizes;
  for (const float extinction : {1e-5F, 1e-3F, 0.01F, 0.1F, 1.0F, 10.0F}) {
    const int size = build(map, 0, extinction).cell_size;
    EXPECT_LE(size, before) << extinction;
    before = size;
    sizes.push_back(size);
  }
  EXPECT_GT(sizes.front(), sizes.back());
}

TEST(SuperVoxels, AutomaticCellsAreOneOfTheSizes) {
  for (const NamedMap& field : all_maps()) {
    for (const float extinction : {0.0F, 0.1F, 1e30F}) {
      const SuperVoxels automatic = build(field.map, 0, extinction);
      EXPECT_NE(
          std::find(std::begin(kSuperVoxelSizes), std::end(kSuperVoxelSizes), automatic.cell_size),
          std::end(kSuperVoxelSizes))
          << field.name;
      const SuperVoxels chosen = build(field.map, automatic.cell_size);
      EXPECT_EQ(automatic.maxima, chosen.maxima) << field.name;
      EXPECT_EQ(automatic.minima, chosen.minima) << field.name;
      EXPECT_EQ(automatic.empty_radius, chosen.empty_radius) << field.name;
    }
  }
}

TEST(SuperVoxels, RefuseOtherSizesAndNameThoseThereAre) {
  const BrickMap map = make_field(Vec3i(0), Vec3i(3), hash_noise)->voxels;
  for (const int size : {-8, -1, 1, 2, 3, 5, 12, 65, 128}) {
    try {
      build(map, size);
      FAIL() << size << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.what(), "a super-voxel of " + std::to_string(size) +
                                  " voxels is not possible: choose 4, 8, 16, 32 or 64, or 0 for "
                                  "automatic");
    }
  }
}

}  // namespace
}  // namespace freepath::testing
