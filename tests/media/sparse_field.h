#pragma once
/// @file Fields of few voxels far apart.

#include <algorithm>
#include <memory>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "freepath/media/field.h"

namespace freepath::testing {

/// A voxel and its value.
struct PlacedVoxel {
  Vec3i voxel;
  float value = 0;
};

/// A field of these voxels, made as readers of files make one: the bricks are counted before.
inline std::shared_ptr<Field> field_of_voxels(const std::vector<PlacedVoxel>& voxels,
                                              const Matrix4d& index_to_world = Matrix4d()) {
  Vec3i low = voxels.at(0).voxel;
  Vec3i high = low;
  std::set<std::tuple<int, int, int>> bricks;
  for (const auto& [voxel, value] : voxels) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], voxel[axis]);
      high[axis] = std::max(high[axis], voxel[axis]);
    }
    bricks.emplace(voxel.x >> 3, voxel.y >> 3, voxel.z >> 3);
  }
  BrickMapBuilder builder(low, high, bricks.size(), bricks.size());
  for (const auto& [voxel, value] : voxels) builder.set_voxel(voxel, value);
  auto field = std::make_shared<Field>();
  field->name = "sparse";
  field->voxels = std::move(builder).finish();
  field->index_to_world = index_to_world;
  return field;
}

/// Two clouds of 12³ voxels, the second moved by so much.
inline std::vector<PlacedVoxel> two_clouds(const Vec3i& apart) {
  std::vector<PlacedVoxel> voxels;
  for (int x = 0; x < 12; ++x) {
    for (int y = 0; y < 12; ++y) {
      for (int z = 0; z < 12; ++z) {
        const Vec3i voxel(x, y, z);
        const float value = 0.02F + 0.01F * static_cast<float>((3 * x + 5 * y + 7 * z) % 11);
        voxels.push_back({voxel, value});
        voxels.push_back({voxel + apart, 0.5F * value});
      }
    }
  }
  return voxels;
}

}  // namespace freepath::testing
