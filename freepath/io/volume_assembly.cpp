#include "freepath/io/volume_assembly.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_set>
#include <utility>

#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/base/memory_budget.h"

namespace freepath::io {
namespace {

uint64_t cube(int size) { return uint64_t(size) * uint64_t(size) * uint64_t(size); }

Vec3i brick_of(const Vec3i& voxel) { return {voxel.x >> 3, voxel.y >> 3, voxel.z >> 3}; }

void extend(ValueScan& scan, const Vec3i& low, const Vec3i& high) {
  for (int axis = 0; axis < 3; ++axis) {
    scan.active_min[axis] = std::min(scan.active_min[axis], low[axis]);
    scan.active_max[axis] = std::max(scan.active_max[axis], high[axis]);
  }
}

/// Grows the bounds by the active voxels of a leaf; each word of the mask is a slice in x, each
/// byte of a word a row in y.
void extend_by_mask(ValueScan& scan, const Vec3i& origin, const uint64_t* mask) {
  uint64_t slices = 0;
  int first_x = 8, last_x = -1;
  for (int x = 0; x < 8; ++x) {
    if (mask[x] == 0) continue;
    slices |= mask[x];
    first_x = std::min(first_x, x);
    last_x = x;
  }
  if (slices == 0) return;
  uint64_t rows = slices;
  for (int shift = 8; shift < 64; shift *= 2) rows |= rows >> shift;
  const auto z_bits = static_cast<uint8_t>(rows);
  extend(scan, origin + Vec3i(first_x, std::countr_zero(slices) / 8, std::countr_zero(z_bits)),
         origin + Vec3i(last_x, 7 - std::countl_zero(slices) / 8, 7 - std::countl_zero(z_bits)));
}

/// Whether a value can be a density as it stands. False for NaN.
template <class T>
bool is_density(T value) {
  return value >= T(0) && value <= T(std::numeric_limits<float>::max());
}

/// Whether clamping can repair it.
template <class T>
bool is_clampable(T value) {
  return value < T(0) && value >= T(std::numeric_limits<float>::lowest());
}

void record_first(std::optional<ValueScan::Bad>& first, const ValueScan::Bad& found) {
  if (!first || found.rank < first->rank) first = found;
}

/// "voxel (1, 2, 3) is NaN"
std::string bad_voxel(const ValueScan::Bad& bad) {
  const std::string voxel =
      fmt::format("voxel ({}, {}, {})", bad.voxel.x, bad.voxel.y, bad.voxel.z);
  if (std::isnan(bad.value)) return voxel + " is NaN";
  if (std::isinf(bad.value)) return voxel + " is infinite";
  if (std::abs(bad.value) > std::numeric_limits<float>::max()) {
    return fmt::format("{} is {}, out of the range of float", voxel, bad.value);
  }
  return fmt::format("{} is negative ({})", voxel, bad.value);
}

[[noreturn]] void fail_bad(const std::string& where, const ValueScan::Bad& bad) {
  if (is_clampable(bad.value)) {
    fail(
        "{}: {}; densities are 0 or more: repair the grid, or have negative ones taken as 0 "
        "(--negative clamp)",
        where, bad_voxel(bad));
  }
  fail(
      "{}: {}; densities must be finite: repair the grid, or have such values taken as 0 "
      "(--invalid zero)",
      where, bad_voxel(bad));
}

BrickMapBuilder make_builder(const std::string& where, const VolumeLayout& layout) {
  ValueScan bounds;
  for (const Vec3i& leaf : layout.leaves) extend(bounds, leaf, leaf + Vec3i(7));
  std::unordered_set<float> tile_values;
  std::size_t coord_count = layout.leaves.size();
  for (const VolumeTile& tile : layout.tiles) {
    extend(bounds, tile.origin, tile.origin + Vec3i(tile.size - 1));
    tile_values.insert(static_cast<float>(tile.value));
    coord_count += cube(tile.size / BrickMap::kBrickSize);
  }
  const std::size_t bricks = layout.leaves.size() + tile_values.size();
  check_memory_present(where, fmt::format("{} bricks of 8x8x8 voxels", bricks),
                       static_cast<double>(bricks) * kLeafVoxels * sizeof(float));
  // One voxel of an empty grid.
  if (bricks == 0) extend(bounds, Vec3i(0), Vec3i(0));
  return {bounds.active_min, bounds.active_max, bricks, coord_count};
}

}  // namespace

void GridLayout::check_memory() const {
  const std::size_t tiles = channels_[0].tiles.size();
  constexpr std::size_t kOften = std::size_t{1} << 20;
  if (tiles == 0 || tiles % kOften != 0) return;
  check_memory_present("its tree", fmt::format("{} tiles", tiles),
                       2.0 * static_cast<double>(tiles * channels_.size() * sizeof(VolumeTile)));
}

void ValueScan::merge(const ValueScan& other) {
  active_voxels += other.active_voxels;
  inactive_voxels += other.inactive_voxels;
  negative_voxels += other.negative_voxels;
  invalid_voxels += other.invalid_voxels;
  minimum = std::min(minimum, other.minimum);
  maximum = std::max(maximum, other.maximum);
  extend(*this, other.active_min, other.active_max);
  if (other.bad) record_first(bad, *other.bad);
  if (other.invalid) record_first(invalid, *other.invalid);
}

template <class T>
float ValueCheck::mend(T value, const Vec3i& voxel, uint64_t rank, uint64_t voxels,
                       ValueScan& scan) const {
  const ValueScan::Bad found{rank, voxel, static_cast<double>(value)};
  if (is_clampable(value)) {
    if (negative == NegativePolicy::kClamp) {
      scan.negative_voxels += voxels;
    } else {
      record_first(scan.bad, found);
    }
  } else if (invalid == InvalidPolicy::kZero) {
    scan.invalid_voxels += voxels;
    record_first(scan.invalid, found);
  } else {
    record_first(scan.bad, found);
  }
  return 0;
}

float ValueCheck::tile(const VolumeTile& tile, uint64_t rank, ValueScan& scan) const {
  float value = 0;
  if (is_density(tile.value)) {
    value = static_cast<float>(tile.value);
  } else if (tile.active || !is_background(tile.value, background)) {
    value = mend(tile.value, tile.origin, rank, cube(tile.size), scan);
  }
  if (!tile.active && (value == 0 || is_background(tile.value, background))) return 0;
  (tile.active ? scan.active_voxels : scan.inactive_voxels) += cube(tile.size);
  extend(scan, tile.origin, tile.origin + Vec3i(tile.size - 1));
  scan.minimum = std::min(scan.minimum, value);
  scan.maximum = std::max(scan.maximum, value);
  return value;
}

template <class T>
void ValueCheck::leaf(const T* values, const uint64_t* mask, const Vec3i& origin, uint64_t rank,
                      float* brick, ValueScan& scan) const {
  float minimum = scan.minimum, maximum = scan.maximum;
  uint64_t kept[8];
  for (int slice = 0; slice < 8; ++slice) {
    const uint64_t active = mask[slice];
    uint64_t bits = active;
    for (int i = 0; i < 64; ++i) {
      const int offset = slice * 64 + i;
      const T value = values[offset];
      const bool is_active = ((active >> i) & 1) != 0;
      brick[offset] = 0;
      if (!is_active && (value == T(0) || is_background(static_cast<double>(value), background))) {
        continue;
      }
      const float density = is_density(value)
                                ? static_cast<float>(value)
                                : mend(value, origin + Vec3i(slice, i >> 3, i & 7), rank, 1, scan);
      if (!is_active && density == 0) continue;
      bits |= uint64_t{1} << i;
      brick[offset] = density;
      minimum = std::min(minimum, density);
      maximum = std::max(maximum, density);
    }
    kept[slice] = bits;
    scan.active_voxels += static_cast<uint64_t>(std::popcount(active));
    scan.inactive_voxels += static_cast<uint64_t>(std::popcount(bits & ~active));
  }
  scan.minimum = minimum;
  scan.maximum = maximum;
  extend_by_mask(scan, origin, kept);
}

template void ValueCheck::leaf<float>(const float*, const uint64_t*, const Vec3i&, uint64_t, float*,
                                      ValueScan&) const;
template void ValueCheck::leaf<double>(const double*, const uint64_t*, const Vec3i&, uint64_t,
                                       float*, ValueScan&) const;

FieldAssembly::FieldAssembly(std::string where, const LoadOptions& options, VolumeLayout layout,
                             bool keep_values)
    : where_(std::move(where)),
      check_{options.negative, options.invalid, layout.background},
      layout_(std::move(layout)) {
  if (keep_values) {
    try {
      builder_.emplace(make_builder(where_, layout_));
    } catch (const Error& error) {
      fail("{}: {}", where_, error.what());
    }
  }
  for (std::size_t i = 0; i < layout_.tiles.size(); ++i) {
    const VolumeTile& tile = layout_.tiles[i];
    const float value = check_.tile(tile, layout_.leaves.size() + i, tile_scan_);
    const Vec3i first = brick_of(tile.origin);
    if (builder_ && value != 0)
      builder_->add_constant_bricks(first, first + Vec3i(tile.size / 8), value);
  }
  // Last, since the span holds until the next addition.
  if (builder_)
    bricks_ = builder_->add_bricks([this] {
      std::vector<Vec3i> bricks(layout_.leaves.size());
      std::transform(layout_.leaves.begin(), layout_.leaves.end(), bricks.begin(), brick_of);
      return bricks;
    }());
}

uint64_t FieldAssembly::active_tiles() const {
  return static_cast<uint64_t>(std::ranges::count_if(layout_.tiles, &VolumeTile::active));
}

ValueScan FieldAssembly::with_tiles(ValueScan scan) const {
  scan.merge(tile_scan_);
  if (scan.bad) fail_bad(where_, *scan.bad);
  return scan;
}

LoadedField FieldAssembly::finish(std::string name, const Matrix4d& index_to_world,
                                  const ValueScan& leaves) && {
  const ValueScan scan = with_tiles(leaves);
  LoadedField loaded;
  loaded.active_voxels = scan.active_voxels;
  loaded.inactive_voxels = scan.inactive_voxels;
  loaded.active_tiles = active_tiles();
  loaded.clamped_voxels = scan.negative_voxels;
  loaded.invalid_voxels = scan.invalid_voxels;
  if (scan.empty()) {
    loaded.warnings.push_back(fmt::format("{}: it has no active voxels: it is empty", where_));
    const Vec3i voxel = layout_.leaves.empty() ? Vec3i(0) : layout_.leaves.front();
    builder_->set_active_bounds(voxel, voxel);
  } else {
    loaded.minimum = scan.minimum;
    loaded.maximum = scan.maximum;
    builder_->set_active_bounds(scan.active_min, scan.active_max);
  }
  if (layout_.background != 0) {
    loaded.warnings.push_back(
        fmt::format("{}: its background is {}, but counts as 0", where_, layout_.background));
  }
  if (scan.invalid_voxels > 0) {
    loaded.warnings.push_back(fmt::format(
        "{}: {}; the first: {}", where_,
        counted(scan.invalid_voxels,
                "value that is NaN, infinite or out of the range of float was taken as 0",
                "values that are NaN, infinite or out of the range of float were taken as 0"),
        bad_voxel(*scan.invalid)));
  }
  if (scan.negative_voxels > 0) {
    loaded.warnings.push_back(
        fmt::format("{}: {}", where_,
                    counted(scan.negative_voxels, "negative density was taken as 0",
                            "negative densities were taken as 0")));
  }
  loaded.field = {std::move(name), std::move(*builder_).finish(), index_to_world};
  return loaded;
}

void FieldAssembly::describe(const ValueScan& leaves, GridInfo& info) const {
  ValueScan scan = leaves;
  scan.merge(tile_scan_);
  info.active_voxels = scan.active_voxels;
  info.inactive_voxels = scan.inactive_voxels;
  info.active_tiles = active_tiles();
  if (!scan.empty()) {
    info.active_min = scan.active_min;
    info.active_max = scan.active_max;
    info.minimum = info.ranges.empty() ? scan.minimum : std::min(info.minimum, scan.minimum);
    info.maximum = info.ranges.empty() ? scan.maximum : std::max(info.maximum, scan.maximum);
    info.ranges.push_back({scan.minimum, scan.maximum});
  }
  with_tiles(leaves);
}

GridAssembly::GridAssembly(const std::string& file, const std::string& grid,
                           const LoadOptions& options, GridLayout layout, bool keep_values) {
  std::vector<VolumeLayout> layouts = std::move(layout).take();
  channels_.reserve(layouts.size());
  for (std::size_t channel = 0; channel < layouts.size(); ++channel) {
    std::string where = grid_label(file, grid);
    if (layouts.size() > 1) where += fmt::format(", channel {}", kChannelNames[channel]);
    channels_.emplace_back(where, options, std::move(layouts[channel]), keep_values);
  }
}

std::vector<LoadedField> GridAssembly::finish(const GridInfo& info, const GridScan& scan) && {
  std::vector<LoadedField> fields;
  for (std::size_t channel = 0; channel < channels_.size(); ++channel) {
    std::string name = info.name;
    if (channels_.size() > 1) name += fmt::format(".{}", kChannelNames[channel]);
    fields.push_back(std::move(channels_[channel])
                         .finish(std::move(name), info.index_to_world, scan.channels[channel]));
  }
  return fields;
}

void GridAssembly::describe(const GridScan& scan, GridInfo& info) const {
  for (std::size_t channel = 0; channel < channels_.size(); ++channel) {
    channels_[channel].describe(scan.channels[channel], info);
  }
}

}  // namespace freepath::io
