#pragma once
/// @file What the scalar walks share: a NanoVDB grid and its density at a point, the super-voxels
/// along a ray, PCG. Included only by files that are compiled for the machine at hand.

#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <nanovdb/util/SampleFromVoxels.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "freepath/base/random.h"
#include "freepath/media/medium.h"

namespace freepath::bench {

/// PCG-XSH-RR 64/32, the generator of most renderers.
class Pcg {
 public:
  explicit Pcg(uint64_t sequence) : increment_(sequence << 1 | 1) {
    bits();
    state_ += 0x853C49E6748FEA9BULL;
    bits();
  }
  uint32_t bits() {
    const uint64_t old = state_;
    state_ = old * 0x5851F42D4C957F2DULL + increment_;
    const auto shifted = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
    const auto turn = static_cast<uint32_t>(old >> 59);
    return shifted >> turn | shifted << (-turn & 31);
  }
  float uniform() { return uniform_from_bits(bits()); }
  float exponential() {
    return -std::log((static_cast<float>(static_cast<int32_t>(bits() >> 1)) + 0.5F) * 0x1p-31F);
  }

 private:
  uint64_t state_ = 0;
  uint64_t increment_;
};

using NanovdbHandle = nanovdb::GridHandle<nanovdb::HostBuffer>;

/// The bricks as leaves of a NanoVDB float grid.
inline NanovdbHandle to_nanovdb(const BrickMap& map) {
  const auto grid = openvdb::FloatGrid::create(0.0F);
  const Vec3i& counts = map.brick_counts();
  for (int x = 0; x < counts.x; ++x) {
    for (int y = 0; y < counts.y; ++y) {
      for (int z = 0; z < counts.z; ++z) {
        const uint32_t brick = map.index()[(std::size_t(x) * counts.y + y) * counts.z + z];
        if (brick == 0) continue;
        const Vec3i first = map.origin() + Vec3i(x, y, z) * BrickMap::kBrickSize;
        auto* leaf = new openvdb::FloatTree::LeafNodeType(openvdb::Coord(first.x, first.y, first.z),
                                                          0.0F, true);
        const auto voxels = map.voxels().subspan(std::size_t(brick) * BrickMap::kBrickVoxels,
                                                 BrickMap::kBrickVoxels);
        std::copy(voxels.begin(), voxels.end(), leaf->buffer().data());
        grid->tree().addLeaf(leaf);  // which takes it over
      }
    }
  }
  return nanovdb::openToNanoVDB(*grid, nanovdb::StatsMode::Disable, nanovdb::ChecksumMode::Disable);
}

/// Density at a point [index], by a trilinear interpolation or one voxel drawn with its weight.
template <Interpolation kInterpolation>
class Density {
 public:
  explicit Density(const nanovdb::FloatGrid& grid) : accessor_(grid.tree()), sampler_(accessor_) {}

  float operator()(const Vec3f& point, Pcg& random) const {
    if constexpr (kInterpolation == Interpolation::kTrilinear) {
      return sampler_(nanovdb::Vec3f(point.x, point.y, point.z));
    } else {
      nanovdb::Coord voxel;
      for (int axis = 0; axis < 3; ++axis) {
        const float base = std::floor(point[axis]);
        voxel[axis] = static_cast<int>(base) + (random.uniform() < point[axis] - base ? 1 : 0);
      }
      return accessor_.getValue(voxel);
    }
  }

 private:
  using Accessor = nanovdb::DefaultReadAccessor<float>;
  Accessor accessor_;
  nanovdb::SampleFromVoxels<Accessor, 1, false> sampler_;
};

/// The super-voxels that a medium's rays cross. The edge of a voxel is 1 [world].
struct CellGrid {
  explicit CellGrid(const Medium& medium) : cells(&medium.super_voxels()) {
    const BrickMap& map = medium.components()[0].density->voxels;
    first_corner = Vec3f(map.origin()) - Vec3f(0.5F);
    bounds = Box3f(Vec3f(map.active_min()) - Vec3f(1), Vec3f(map.active_max()) + Vec3f(1));
  }

  const SuperVoxels* cells;
  Vec3f first_corner;  ///< Of the cells [world].
  Box3f bounds;        ///< Where the walk takes place [world].
};

/// @return whether the ray meets the box between `begin` and `end`, which are narrowed to it
inline bool clip(const Box3f& box, const Vec3f& origin, const Vec3f& direction, float& begin,
                 float& end) {
  for (int axis = 0; axis < 3; ++axis) {
    const float inverse = 1 / direction[axis];
    const float low = (box.min[axis] - origin[axis]) * inverse;
    const float high = (box.max[axis] - origin[axis]) * inverse;
    begin = std::max(begin, std::min(low, high));
    end = std::min(end, std::max(low, high));
  }
  return begin < end;
}

/// Visits the super-voxels along a ray, cell by cell [Amanatides87].
class CellSteps {
 public:
  /// The cell at `begin`.
  CellSteps(const CellGrid& grid, const Vec3f& origin, const Vec3f& direction, float begin)
      : counts_(grid.cells->counts) {
    const auto edge = static_cast<float>(grid.cells->cell_size);
    for (int axis = 0; axis < 3; ++axis) {
      const float position =
          (origin[axis] + begin * direction[axis] - grid.first_corner[axis]) / edge;
      cell_[axis] = std::clamp(static_cast<int>(position), 0, counts_[axis] - 1);
      const bool forward = direction[axis] >= 0;
      step_[axis] = forward ? 1 : -1;
      end_[axis] = forward ? counts_[axis] : -1;
      const float plane =
          grid.first_corner[axis] + edge * static_cast<float>(cell_[axis] + (forward ? 1 : 0));
      next_[axis] = (plane - origin[axis]) / direction[axis];
      across_[axis] = edge / std::abs(direction[axis]);
    }
    find_axis();
  }

  /// Where the bounds of the cell stand, before the number of components.
  int cell() const { return (cell_[0] * counts_.y + cell_[1]) * counts_.z + cell_[2]; }
  /// Where the ray leaves the cell [world].
  float exit() const { return next_[axis_]; }
  /// Into the next cell. @return whether there is one
  bool leave() {
    cell_[axis_] += step_[axis_];
    if (cell_[axis_] == end_[axis_]) return false;
    next_[axis_] += across_[axis_];
    find_axis();
    return true;
  }

 private:
  void find_axis() {
    axis_ = next_[0] < next_[1] ? (next_[0] < next_[2] ? 0 : 2) : (next_[1] < next_[2] ? 1 : 2);
  }

  Vec3i counts_;
  int axis_;  ///< Whose plane the ray crosses first.
  int cell_[3];
  int step_[3];
  int end_[3];       ///< First cell outside.
  float next_[3];    ///< Where the ray crosses the next plane [world].
  float across_[3];  ///< Length between two planes [world].
};

}  // namespace freepath::bench
