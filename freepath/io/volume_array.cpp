#include "freepath/io/volume_array.h"

#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/memory_budget.h"
#include "freepath/io/volume_assembly.h"

namespace freepath {
namespace {

constexpr int kSize = BrickMap::kBrickSize;

/// The array in bricks of 8³ voxels; those at its far sides may stick out.
template <class Real>
class BrickedArray {
 public:
  explicit BrickedArray(const VoxelArray<Real>& array) : array_(array) {
    for (int axis = 0; axis < 3; ++axis) {
      counts_[axis] = static_cast<int>((array.counts[axis] + kSize - 1) / kSize);
    }
  }

  std::size_t brick_count() const {
    return std::size_t(counts_.x) * std::size_t(counts_.y) * std::size_t(counts_.z);
  }
  /// First voxel of a brick.
  Vec3i origin(std::size_t brick) const {
    const auto z = static_cast<int>(brick % counts_.z);
    const auto row = brick / counts_.z;
    return Vec3i(static_cast<int>(row / counts_.y), static_cast<int>(row % counts_.y), z) * kSize;
  }
  /// Whether all of a brick lies in the array, and has one value. NaN is one value nowhere.
  bool is_constant(const Vec3i& origin) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (std::size_t(origin[axis]) + kSize > array_.counts[axis]) return false;
    }
    const Real first = value(origin);
    for (int x = 0; x < kSize; ++x) {
      for (int y = 0; y < kSize; ++y) {
        for (int z = 0; z < kSize; ++z) {
          if (value(origin + Vec3i(x, y, z)) != first) return false;
        }
      }
    }
    return true;
  }
  Real value(const Vec3i& voxel) const {
    return array_.values[voxel.x * array_.strides[0] + voxel.y * array_.strides[1] +
                         voxel.z * array_.strides[2]];
  }
  /// Copies the part of a brick that lies in the array.
  /// @param mask gets a bit for each voxel of that part
  void copy(const Vec3i& origin, Real* values, uint64_t* mask) const {
    std::fill_n(values, BrickMap::kBrickVoxels, Real(0));
    std::fill_n(mask, kSize, uint64_t{0});
    Vec3i size;
    for (int axis = 0; axis < 3; ++axis) {
      size[axis] = static_cast<int>(
          std::min<std::size_t>(kSize, array_.counts[axis] - std::size_t(origin[axis])));
    }
    for (int x = 0; x < size.x; ++x) {
      for (int y = 0; y < size.y; ++y) {
        for (int z = 0; z < size.z; ++z) {
          values[x * kSize * kSize + y * kSize + z] = value(origin + Vec3i(x, y, z));
          mask[x] |= uint64_t{1} << (y * kSize + z);
        }
      }
    }
  }

 private:
  VoxelArray<Real> array_;
  Vec3i counts_;
};

template <class Real>
void check_array(const VoxelArray<Real>& array, const std::string& name,
                 const Matrix4d& index_to_world) {
  double voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (array.counts[axis] == 0) {
      fail("{}: the array is empty: it has no voxel along {}", name, "xyz"[axis]);
    }
    voxels *= static_cast<double>(array.counts[axis]);
  }
  check_memory_present(
      name, fmt::format("{} x {} x {} voxels", array.counts[0], array.counts[1], array.counts[2]),
      voxels * sizeof(float));
  const std::string reason = io::reason_against_transform(index_to_world);
  if (!reason.empty()) fail("{}: {}", name, reason);
}

/// Bricks of one value as tiles, all others as leaves.
template <class Real>
io::VolumeLayout layout_of(const BrickedArray<Real>& bricks) {
  std::vector<uint8_t> is_tile(bricks.brick_count());
  tbb::parallel_for(std::size_t{0}, is_tile.size(), [&](std::size_t brick) {
    is_tile[brick] = bricks.is_constant(bricks.origin(brick)) ? 1 : 0;
  });
  io::VolumeLayout layout;
  for (std::size_t brick = 0; brick < is_tile.size(); ++brick) {
    const Vec3i origin = bricks.origin(brick);
    if (is_tile[brick] != 0) {
      layout.tiles.push_back({origin, kSize, static_cast<double>(bricks.value(origin)), true});
    } else {
      layout.leaves.push_back(origin);
    }
  }
  return layout;
}

template <class Real>
LoadedField make_field(const VoxelArray<Real>& array, const std::string& name,
                       const Matrix4d& index_to_world, const LoadOptions& options) {
  check_array(array, name, index_to_world);
  const BrickedArray<Real> bricks(array);
  io::FieldAssembly assembly(name, options, layout_of(bricks), true);
  tbb::combinable<io::ValueScan> scans;
  tbb::parallel_for(std::size_t{0}, assembly.layout().leaves.size(), [&](std::size_t leaf) {
    Real values[BrickMap::kBrickVoxels];
    uint64_t mask[kSize];
    bricks.copy(assembly.layout().leaves[leaf], values, mask);
    assembly.take_leaf(leaf, values, mask, scans.local());
  });
  io::ValueScan scan;
  scans.combine_each([&](const io::ValueScan& part) { scan.merge(part); });
  return std::move(assembly).finish(name, index_to_world, scan);
}

}  // namespace

void copy_voxels(const BrickMap& map, float* values) {
  const Vec3i first = map.active_min();
  const Vec3i size = map.active_max() - first + Vec3i(1);
  tbb::parallel_for(0, size.x, [&](int x) {
    float* row = values + std::size_t(x) * std::size_t(size.y) * std::size_t(size.z);
    for (int y = 0; y < size.y; ++y, row += size.z) {
      for (int z = 0; z < size.z; ++z) row[z] = map.value(first + Vec3i(x, y, z));
    }
  });
}

LoadedField field_from_array(const VoxelArray<float>& array, const std::string& name,
                             const Matrix4d& index_to_world, const LoadOptions& options) {
  return make_field(array, name, index_to_world, options);
}

LoadedField field_from_array(const VoxelArray<double>& array, const std::string& name,
                             const Matrix4d& index_to_world, const LoadOptions& options) {
  return make_field(array, name, index_to_world, options);
}

}  // namespace freepath
