#pragma once
/// @file What the readers of all volume formats share: checking values and putting the leaves and
/// tiles of a sparse tree into a brick map.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "freepath/io/volume.h"
#include "freepath/io/volume_file.h"

namespace freepath::io {

inline constexpr int kLeafVoxels = BrickMap::kBrickVoxels;

/// A constant cube.
struct VolumeTile {
  Vec3i origin;  ///< First voxel, a multiple of 8 [index].
  int size = 0;  ///< Voxels a side, a multiple of 8.
  double value = 0;
  bool active = true;
};

/// What stands in a tree above its voxels.
struct VolumeLayout {
  std::vector<Vec3i> leaves;  ///< First voxel of every 8³ leaf [index].
  std::vector<VolumeTile> tiles;
  double background = 0;
};

/// What values are read as: whole numbers and truth values become doubles.
template <class T>
using RealOf = std::conditional_t<std::is_floating_point_v<T>, T, double>;

/// The densities in a value of a voxel: a number is one, a vector three.
template <class T>
struct ValueChannels {
  static constexpr int kCount = 1;
  using Real = RealOf<T>;
  static Real get(const T& value, int /*channel*/) { return static_cast<Real>(value); }
};
template <class T>
requires requires(const T& vector) { vector[2]; }
struct ValueChannels<T> {
  static constexpr int kCount = 3;
  using Real = RealOf<typename T::ValueType>;
  static Real get(const T& value, int channel) { return static_cast<Real>(value[channel]); }
};

/// Whether a value is the background, which may be NaN.
inline bool is_background(double value, double background) {
  return value == background || (std::isnan(value) && std::isnan(background));
}

inline constexpr int kMaxGridChannels = 3;

/// A layout for each channel of a grid, alike but for the values in them.
class GridLayout {
 public:
  explicit GridLayout(int channels) : channels_(static_cast<std::size_t>(channels)) {}

  void add_leaf(const Vec3i& origin) {
    for (VolumeLayout& layout : channels_) layout.leaves.push_back(origin);
  }
  /// Adds a tile, unless it is inactive and 0 or the background in all channels. The background
  /// must have been set.
  template <class T>
  void add_tile(const Vec3i& origin, int size, const T& value, bool active) {
    bool counts = active;
    for (std::size_t channel = 0; channel < channels_.size(); ++channel) {
      const double density = real(value, channel);
      counts |= density != 0 && !is_background(density, channels_[channel].background);
    }
    if (!counts) return;
    check_memory();
    for (std::size_t channel = 0; channel < channels_.size(); ++channel) {
      channels_[channel].tiles.push_back({origin, size, real(value, channel), active});
    }
  }
  template <class T>
  void set_background(const T& value) {
    for (std::size_t channel = 0; channel < channels_.size(); ++channel) {
      channels_[channel].background = real(value, channel);
    }
  }
  std::vector<VolumeLayout> take() && { return std::move(channels_); }

 private:
  /// Nodes that pack well hold many tiles in few bytes.
  void check_memory() const;
  template <class T>
  static double real(const T& value, std::size_t channel) {
    return static_cast<double>(ValueChannels<T>::get(value, static_cast<int>(channel)));
  }

  std::vector<VolumeLayout> channels_;
};

/// What was found among values that are active or not 0. Merging doesn't depend on the order.
struct ValueScan {
  struct Bad {
    /// Position in the order of the grid; the first bad value is the one reported.
    uint64_t rank = 0;
    Vec3i voxel;
    double value = 0;
  };

  uint64_t active_voxels = 0;
  uint64_t inactive_voxels = 0;  ///< Inactive ones that are not 0.
  uint64_t negative_voxels = 0;  ///< Counted under NegativePolicy::kClamp only.
  uint64_t invalid_voxels = 0;   ///< Counted under InvalidPolicy::kZero only.
  float minimum = std::numeric_limits<float>::infinity();
  float maximum = -std::numeric_limits<float>::infinity();
  Vec3i active_min{std::numeric_limits<int>::max()};
  Vec3i active_max{std::numeric_limits<int>::min()};
  std::optional<Bad> bad;      ///< The first that is to be refused.
  std::optional<Bad> invalid;  ///< The first of the invalid voxels.

  bool empty() const { return active_voxels + inactive_voxels == 0; }
  void merge(const ValueScan& other);
};

/// The float of a value: values that density can't be are recorded in the scan, others counted.
struct ValueCheck {
  NegativePolicy negative = NegativePolicy::kError;
  InvalidPolicy invalid = InvalidPolicy::kZero;
  double background = 0;

  /// Checks a tile's value. `rank`, its position in the order of the grid, tells which comes first.
  float tile(const VolumeTile& tile, uint64_t rank, ValueScan& scan) const;

  /// Checks the values of a leaf and writes 512 floats: inactive ones are kept, unless they are the
  /// background.
  /// @param values 512 values, offset 64x + 8y + z
  /// @param mask 512 bits, active ones set
  template <class T>
  void leaf(const T* values, const uint64_t* mask, const Vec3i& origin, uint64_t rank,
            float* bricks, ValueScan& scan) const;

 private:
  /// The float of a value that is no density.
  /// @param voxels how many have it
  template <class T>
  float mend(T value, const Vec3i& voxel, uint64_t rank, uint64_t voxels, ValueScan& scan) const;
};

/// What was found in each channel of a grid.
struct GridScan {
  std::array<ValueScan, kMaxGridChannels> channels;

  void merge(const GridScan& other) {
    for (std::size_t i = 0; i < channels.size(); ++i) channels[i].merge(other.channels[i]);
  }
};

/// Collects the leaves and tiles of one channel. Leaves may come from several threads in any order.
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
  /// @throws Error for a bad value
  LoadedField finish(std::string name, const Matrix4d& index_to_world, const ValueScan& scan) &&;

  /// Enters the numbers of a scan into a list of grids; the range there grows by this channel's.
  void describe(const ValueScan& scan, GridInfo& info) const;

 private:
  ValueScan with_tiles(ValueScan scan) const;
  uint64_t active_tiles() const;

  std::string where_;
  ValueCheck check_;
  VolumeLayout layout_;
  std::optional<BrickMapBuilder> builder_;
  std::span<float> bricks_;
  ValueScan tile_scan_;
};

/// The channels of one grid.
class GridAssembly {
 public:
  /// @param keep_values false to look at the values only, for GridInfo
  GridAssembly(const std::string& file, const std::string& grid, const LoadOptions& options,
               GridLayout layout, bool keep_values);

  std::size_t leaf_count() const { return channels_[0].layout().leaves.size(); }

  /// Takes leaf number `leaf` of the layout.
  /// @param values 512 values, offset 64x + 8y + z
  /// @param mask 512 bits, active ones set
  template <class T>
  void take_leaf(std::size_t leaf, const T* values, const uint64_t* mask, GridScan& scan) const {
    using Channels = ValueChannels<T>;
    if constexpr (std::is_floating_point_v<T>) {
      channels_[0].take_leaf(leaf, values, mask, scan.channels[0]);
    } else {
      std::array<typename Channels::Real, kLeafVoxels> reals;
      for (int channel = 0; channel < Channels::kCount; ++channel) {
        for (int i = 0; i < kLeafVoxels; ++i) reals[i] = Channels::get(values[i], channel);
        channels_[channel].take_leaf(leaf, reals.data(), mask, scan.channels[channel]);
      }
    }
  }

  /// A field for each channel, once all leaves were taken.
  /// @throws Error for a bad value
  std::vector<LoadedField> finish(const GridInfo& info, const GridScan& scan) &&;

  /// Enters the numbers of a scan into a list of grids.
  void describe(const GridScan& scan, GridInfo& info) const;

 private:
  std::vector<FieldAssembly> channels_;
};

/// @throws Error if two nodes begin at one place, which would hold two values there
void check_distinct(const VolumeFile& file, std::vector<Vec3i> origins);

/// Gives grids of the same name the suffixes "[1]", "[2]", ... behind the first.
void make_names_unique(std::vector<GridInfo>& grids);

/// Marks a grid as not loadable for an error that reading it gave, unless a reason is known.
void set_failure(const std::string& file, std::string_view message, GridInfo& grid);

/// Fails if the options' grid can't be loaded.
void check_selected(const std::string& file, const GridInfo& info, const LoadOptions& options);

/// The start of messages about a grid.
std::string grid_label(const std::string& file, const std::string& grid);

/// Why a grid of this class can't be a density; empty if it can.
std::string reason_against_class(const std::string& grid_class);
/// Why a grid with this transform can't be loaded; empty if it is finite and invertible.
std::string reason_against_transform(const Matrix4d& index_to_world);
/// Why a grid with voxels of this type, which the reader doesn't know, can't be loaded.
std::string reason_against_type(const std::string& type);

}  // namespace freepath::io
