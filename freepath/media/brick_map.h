#pragma once
/// @file The store of voxels: 8³ bricks behind an index.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "freepath/base/page_allocator.h"
#include "freepath/base/vector.h"

namespace freepath {

/// A brick at its place in the grid.
struct PlacedBrick {
  Vec3i coord;         ///< Coordinates of voxels divided by 8 (floor) [index].
  uint32_t brick = 0;  ///< Its number.
};

/// A dense index of bricks over a box of a map, its own or a part cut out of it.
struct BrickWindow {
  Vec3i origin{0};                  ///< First voxel, a multiple of 8 [index].
  Vec3i brick_counts{0};            ///< Number of bricks along each axis.
  const uint32_t* index = nullptr;  ///< Brick of each entry, x slowest, as BrickMap::index().
  std::shared_ptr<const std::vector<uint32_t>> cut_out{};  ///< Holds it, where it is no map's own.

  std::size_t entry_count() const {
    return std::size_t(brick_counts.x) * std::size_t(brick_counts.y) * std::size_t(brick_counts.z);
  }
};

/// A sparse grid of floats: an index of 8³ bricks over the active bounds, and all bricks in one
/// array. Brick 0 is the empty one (all zero). A brick of one constant value is stored once.
///
/// The index is dense where that is no waste. Of few bricks far apart it is a list of them instead,
/// so that memory and time follow the bricks and not the box around them.
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

  /// Whether the index is a list of bricks.
  bool is_sparse() const { return is_sparse_; }
  /// Brick of each entry of a dense index, x slowest: entry = (bx · ny + by) · nz + bz. Empty where
  /// the index is a list.
  std::span<const uint32_t> index() const { return index_; }
  /// Bricks of an index that is a list, in the order of their places, x slowest. Empty where it is
  /// dense.
  std::span<const PlacedBrick> listed_bricks() const { return listed_; }
  /// Calls f(PlacedBrick) for every brick but the empty one, in the order of places, x slowest.
  template <class Function>
  void for_each_brick(Function f) const;
  /// The number of a brick; 0, the empty one, outside.
  /// @param coord coordinates of voxels divided by 8 (floor) [index]
  uint32_t brick_at(const Vec3i& coord) const;
  /// A dense index over the bricks of the half-open box [begin, end) of places; its time and memory
  /// are those of the box.
  /// @throws Error for a box of more bricks than an index may have
  BrickWindow window(const Vec3i& begin, const Vec3i& end) const;
  /// The dense index of the whole map.
  /// @throws Error where the map has a list
  BrickWindow window() const;
  /// Voxels of all bricks; voxel (x,y,z) of brick b is at b·512 + 64x + 8y + z.
  std::span<const float> voxels() const { return voxels_; }
  std::size_t brick_count() const { return voxels_.size() / kBrickVoxels; }

  /// Puts the same voxels behind a dense index of more bricks, as other maps may have.
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
  bool is_sparse_ = false;
  std::vector<uint32_t, PageAllocator<uint32_t>> index_;
  std::vector<PlacedBrick> listed_;
  std::vector<float, PageAllocator<float>> voxels_;
};

template <class Function>
void BrickMap::for_each_brick(Function f) const {
  for (const PlacedBrick& listed : listed_) f(listed);
  const Vec3i first = origin_ / kBrickSize;
  const uint32_t* entry = index_.data();
  if (is_sparse_) return;
  for (int x = 0; x < brick_counts_.x; ++x) {
    for (int y = 0; y < brick_counts_.y; ++y) {
      for (int z = 0; z < brick_counts_.z; ++z, ++entry) {
        if (*entry != 0) f(PlacedBrick{first + Vec3i(x, y, z), *entry});
      }
    }
  }
}

/// Whether a dense index of so many entries for so many bricks is small, or full enough to be no
/// waste.
constexpr bool is_worth_an_index(double entries, double bricks) {
  constexpr double kFewEntries = 1 << 16;      // 320³ voxels
  constexpr double kLargestIndex = 1 << 26;    // 256 MiB, some 3200³ voxels
  constexpr double kEntriesForEachBrick = 64;  // an eighth of the memory of its voxels
  return entries <= kLargestIndex &&
         (entries <= kFewEntries || entries <= kEntriesForEachBrick * bricks);
}

/// Fills a BrickMap brick by brick.
///
/// @note Brick coordinates are voxel coordinates divided by 8 (floor), as OpenVDB's leaf origins.
class BrickMapBuilder {
 public:
  /// How many bricks there will be is not known: the index is dense.
  static constexpr std::size_t kUnknown = 0;

  /// @param active_min,active_max inclusive bounds of the active voxels, or of the bricks that hold
  ///   them [index]
  /// @param brick_capacity how many distinct bricks to reserve; more may be added
  /// @param coord_count how many bricks will be set, those of one constant value each counted: few
  ///   of them in large bounds get a list for an index
  /// @throws Error if the bounds and the bricks in them need too large an index
  BrickMapBuilder(const Vec3i& active_min, const Vec3i& active_max, std::size_t brick_capacity,
                  std::size_t coord_count = kUnknown);

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
  struct CoordHash {
    std::size_t operator()(const Vec3i& coord) const;
  };

  uint32_t& entry(const Vec3i& brick);
  uint32_t new_brick();
  void check_brick_count(std::size_t count) const;

  BrickMap map_;
  std::unordered_map<Vec3i, uint32_t, CoordHash> listed_;  // coord → brick, of an index that is one
  std::unordered_map<uint32_t, uint32_t> constants_;       // bits of the value → brick
  std::vector<bool> shared_;                               // bricks that several entries may name
};

}  // namespace freepath
