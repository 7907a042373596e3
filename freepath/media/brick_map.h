#pragma once
/// @file The store of voxels: 8³ bricks behind a dense index.

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/media/page_allocator.h"

namespace freepath {

/// A sparse grid of floats: a dense index of 8³ bricks over the active bounds, and all bricks in
/// one array. Brick 0 is the empty one (all zero). A brick of one constant value is stored once.
///
/// The centre of voxel (i,j,k) is the point (i,j,k) of index space. The index covers the bounds of
/// the active voxels grown by two on every side (or more), so that a tap of the trilinear filter
/// anywhere within one voxel of the bounds reads it without a check. Index and voxels stand in huge
/// pages where the system has them; parts that were never written take no memory.
class BrickMap {
 public:
  static constexpr int kBrickSize = 8;
  static constexpr int kBrickVoxels = kBrickSize * kBrickSize * kBrickSize;

  /// Inclusive bounds of the active voxels [index]; empty (max < min) where there are none.
  const Vec3i& active_min() const { return active_min_; }
  const Vec3i& active_max() const { return active_max_; }
  bool empty() const { return active_max_.x < active_min_.x; }

  /// First voxel of the index's first brick, a multiple of 8 [index].
  const Vec3i& origin() const { return origin_; }
  /// Bricks of the index along each axis.
  const Vec3i& brick_counts() const { return brick_counts_; }

  /// Brick of each index entry, x slowest: entry = (bx · ny + by) · nz + bz.
  std::span<const uint32_t> index() const { return index_; }
  /// Voxels of all bricks; voxel (x,y,z) of brick b is at b·512 + 64x + 8y + z.
  std::span<const float> voxels() const { return voxels_; }
  std::size_t brick_count() const { return voxels_.size() / kBrickVoxels; }

  /// Puts the same voxels behind an index of more bricks, as other maps may have.
  /// @param origin first voxel of the first brick, a multiple of 8 [index]
  /// @param brick_counts the present bricks must be among these
  void widen_index(const Vec3i& origin, const Vec3i& brick_counts);

  /// Value of a voxel, 0 outside [index].
  float value(const Vec3i& voxel) const;

  /// Trilinear interpolant at an index-space point, the exact one that bounds are made for.
  double interpolate(const Vec3d& point) const;

  /// Bytes of index and voxels.
  std::size_t memory_bytes() const;

 private:
  friend class BrickMapBuilder;
  Vec3i active_min_{0}, active_max_{-1}, origin_{0}, brick_counts_{0};
  std::vector<uint32_t, PageAllocator<uint32_t>> index_;
  std::vector<float, PageAllocator<float>> voxels_;
};

/// Fills a BrickMap brick by brick.
///
/// @note Brick coordinates are voxel coordinates divided by 8 (floor), as OpenVDB's leaf origins.
class BrickMapBuilder {
 public:
  /// @param active_min,active_max inclusive bounds of the active voxels, or of the bricks that hold
  ///   them [index]
  /// @param brick_capacity how many distinct bricks to reserve; more may be added
  /// @throws Error if the bounds need an index larger than kMaxIndexEntries, or more voxels than a
  ///   32-bit offset can address
  BrickMapBuilder(const Vec3i& active_min, const Vec3i& active_max, std::size_t brick_capacity);

  /// The 512 voxels of a new brick, zero at first, to be written (offset 64x + 8y + z). The span is
  /// valid until the next call.
  std::span<float, BrickMap::kBrickVoxels> add_brick(const Vec3i& brick);
  /// New bricks at different places, for threads to fill: the 512 voxels of bricks[i] start at
  /// i·512 of the result, zero at first. The span is valid until the next call.
  std::span<float> add_bricks(std::span<const Vec3i> bricks);
  /// Sets a whole brick to one value, stored once for each value.
  void add_constant_brick(const Vec3i& brick, float value);
  /// Sets the bricks of the half-open box [begin, end) to one value.
  void add_constant_bricks(const Vec3i& begin, const Vec3i& end, float value);
  /// Writes one voxel of a brick that may exist already.
  void set_voxel(const Vec3i& voxel, float value);

  /// Narrows the bounds of the active voxels, where the constructor was given those of the bricks.
  void set_active_bounds(const Vec3i& active_min, const Vec3i& active_max);

  BrickMap finish() &&;

 private:
  uint32_t& entry(const Vec3i& brick);
  uint32_t new_brick();
  void check_brick_count(std::size_t count) const;

  BrickMap map_;
  std::unordered_map<uint32_t, uint32_t> constants_;  // bits of the value → brick
  std::vector<bool> shared_;                          // bricks that several entries may name
};

}  // namespace freepath
