#pragma once
/// @file What the readers of all volume formats share: checking values and putting the leaves and
/// tiles of a sparse tree into a brick map.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "freepath/io/volume.h"

namespace freepath::io {

inline constexpr int kLeafVoxels = BrickMap::kBrickVoxels;

/// A constant cube of an active value.
struct VolumeTile {
  Vec3i origin;  ///< First voxel, a multiple of 8 [index].
  int size = 0;  ///< Voxels a side, a multiple of 8.
  double value = 0;
};

/// What stands in a tree above its voxels.
struct VolumeLayout {
  std::vector<Vec3i> leaves;  ///< First voxel of every 8³ leaf [index].
  std::vector<VolumeTile> tiles;
  double background = 0;
};

/// What was found among active values. Merging doesn't depend on the order.
struct ValueScan {
  struct Bad {
    uint64_t place = 0;  ///< Place in the grid; the first bad value is the one reported.
    Vec3i voxel;
    double value = 0;
  };

  uint64_t active_voxels = 0;
  uint64_t negative_voxels = 0;  ///< Counted under NegativePolicy::kClamp only.
  float minimum = std::numeric_limits<float>::infinity();
  float maximum = -std::numeric_limits<float>::infinity();
  Vec3i active_min{std::numeric_limits<int>::max()};
  Vec3i active_max{std::numeric_limits<int>::min()};
  std::optional<Bad> bad;

  void merge(const ValueScan& other);
};

/// The float of a value: values that density can't be are recorded in the scan, others counted.
struct ValueCheck {
  NegativePolicy negative = NegativePolicy::kError;

  /// Checks a tile's value, `place` being its rank in the grid.
  float tile(const VolumeTile& tile, uint64_t place, ValueScan& scan) const;

  /// Checks the active values of a leaf and writes 512 floats, 0 where inactive.
  /// @param values 512 values, offset 64x + 8y + z
  /// @param mask 512 bits, active ones set
  template <class T>
  void leaf(const T* values, const uint64_t* mask, const Vec3i& origin, uint64_t place,
            float* bricks, ValueScan& scan) const;
};

/// Collects the leaves and tiles of one grid. Leaves may come from several threads in any order.
class FieldAssembly {
 public:
  /// @param where file and grid, the beginning of every message
  /// @param keep_values false to look at the values only, for GridInfo
  FieldAssembly(std::string where, const LoadOptions& options, VolumeLayout layout,
                bool keep_values);

  const VolumeLayout& layout() const { return layout_; }

  /// Takes leaf number `leaf` of the layout.
  template <class T>
  void take_leaf(std::size_t leaf, const T* values, const uint64_t* mask, ValueScan& scan) const {
    float discarded[kLeafVoxels];
    float* const brick = bricks_.empty() ? discarded : bricks_.data() + leaf * kLeafVoxels;
    check_.leaf(values, mask, layout_.leaves[leaf], leaf, brick, scan);
  }

  /// The field, once all leaves were taken; `scan` is the merge of their scans.
  /// @throws Error for a bad value or a grid without active voxels
  LoadedField finish(std::string name, const Matrix4d& index_to_world, const ValueScan& scan) &&;

  /// The same numbers for a list of grids.
  void describe(const ValueScan& scan, GridInfo& info) const;

 private:
  ValueScan with_tiles(ValueScan scan) const;

  std::string where_;
  ValueCheck check_;
  VolumeLayout layout_;
  std::optional<BrickMapBuilder> builder_;
  std::span<float> bricks_;
  ValueScan tile_scan_;
};

/// Gives grids of the same name the suffixes "[1]", "[2]", ... behind the first.
void make_names_unique(std::vector<GridInfo>& grids);

/// Marks a grid as not loadable for an error that reading it gave, unless a reason is known.
void set_failure(const std::string& file, std::string_view message, GridInfo& grid);

/// The start of messages about a grid.
std::string grid_place(const std::string& file, const std::string& grid);

/// Why a grid of this class can't be a density; empty if it can.
std::string reason_against_class(const std::string& grid_class);
/// Why a grid with this transform can't be loaded; empty if it is finite and invertible.
std::string reason_against_transform(const Matrix4d& index_to_world);
/// Why a grid with voxels of this type, which the reader doesn't know, can't be loaded.
std::string reason_against_type(const std::string& type);

}  // namespace freepath::io
