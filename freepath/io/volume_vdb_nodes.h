#pragma once
/// @file The nodes of trees in an OpenVDB file: the extent of every block of values, and the walk
/// through the topology.

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include <openvdb/util/NodeMasks.h>

#include "freepath/base/error.h"
#include "freepath/io/volume_assembly.h"
#include "freepath/io/volume_vdb_layout.h"

namespace freepath::io {

inline constexpr std::size_t kVdbLeafMaskBytes = kLeafVoxels / 8;

/// What a leaf holds beside its mask.
enum class VdbLeafKind { kValues, kBools, kNothing };

/// How the values of a grid are stored.
struct VdbValueFormat {
  uint32_t file_version = kVdbNewest;
  uint32_t compression = 0;
  std::size_t value_size = 4;   ///< Size of a value in memory [bytes].
  std::size_t stored_size = 4;  ///< Size of a value in the file [bytes], 2 for half.
  VdbLeafKind leaf = VdbLeafKind::kValues;
};

/// The format of a grid's own tree, nothing for a type of value that isn't known.
std::optional<VdbValueFormat> vdb_value_format(const VdbDirectory& directory, const VdbGrid& grid);

/// Bytes that a node's block of values takes at the cursor, all its sizes checked.
/// @param ahead where the block begins, relative to the cursor
/// @param count how many values the node has
/// @param active how many of them are active
/// @throws Error if the block contradicts itself or the file ends before it does
uint64_t vdb_value_block(FileCursor& cursor, uint64_t ahead, const VdbValueFormat& format,
                         uint64_t count, uint64_t active);

/// Bytes of the leaf at the cursor, from its mask on, all its sizes checked.
/// @throws Error as vdb_value_block
uint64_t vdb_leaf_size(FileCursor& cursor, const VdbValueFormat& format);
/// Where its values begin, relative to its mask.
std::size_t vdb_leaf_values(const VdbValueFormat& format);

/// Where the topology of a tree ends, and how many leaves it has.
struct VdbTreeEnds {
  uint64_t end = 0, leaves = 0;
};

/// Reads the topology of a tree without looking at its values.
VdbTreeEnds skip_vdb_topology(const VolumeFile& file, uint64_t offset,
                              const VdbValueFormat& format);

template <class Mask>
Mask vdb_mask_from(std::span<const std::byte> bytes) {
  Mask mask;
  for (openvdb::Index word = 0; word < Mask::WORD_COUNT; ++word) {
    std::memcpy(&mask.template getWord<uint64_t>(word), bytes.data() + std::size_t{8} * word, 8);
  }
  return mask;
}

/// First voxel of an entry of an inner node with 2^log2 entries a side.
inline Vec3i vdb_entry_origin(const Vec3i& origin, int log2, uint32_t entry, int size) {
  const uint32_t last = (1U << log2) - 1;
  return origin + Vec3i(static_cast<int>(entry >> (2 * log2)),
                        static_cast<int>((entry >> log2) & last), static_cast<int>(entry & last)) *
                      size;
}

/// Walks the topology of a tree in the file's depth-first order and calls the visitor's
///   background(value bytes),
///   tile(origin, size, value bytes, active) for the root's,
///   inner(origin, size of an entry, children, active, block of values, their number), and
///   leaf(origin).
template <class Visitor>
class VdbTopology {
 public:
  VdbTopology(FileCursor& cursor, const VdbValueFormat& format, Visitor& visitor)
      : cursor_(&cursor), format_(format), visitor_(&visitor) {}

  void read() {
    cursor_->skip(sizeof(uint32_t));  // a number of buffers, which nobody asks for
    visitor_->background(take_value());
    const auto tiles = cursor_->take<uint32_t>();
    const auto children = cursor_->take<uint32_t>();
    std::vector<Vec3i> origins;
    for (uint32_t i = 0; i < tiles; ++i) {
      origins.push_back(take_root_origin());
      const std::vector<std::byte> value = take_value();
      visitor_->tile(origins.back(), 4096, value, cursor_->take<uint8_t>() != 0);
    }
    for (uint32_t i = 0; i < children; ++i) {
      origins.push_back(take_root_origin());
      read_node<5, 4, 3>(origins.back());
    }
    check_distinct(cursor_->file(), std::move(origins));
  }

 private:
  std::vector<std::byte> take_value() {
    const auto bytes = cursor_->peek(0, format_.value_size);
    std::vector<std::byte> value(bytes.begin(), bytes.end());
    cursor_->skip(format_.value_size);
    return value;
  }

  Vec3i take_root_origin() {
    Vec3i origin;
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = cursor_->take<int32_t>();
      if ((origin[axis] & 4095) != 0) {
        cursor_->file().fail_damaged(
            fmt::format("a node of 4096 voxels a side begins at {}", origin[axis]));
      }
    }
    return origin;
  }

  /// A node with 2^kLog2 entries a side, whose children have the sizes that follow.
  template <int kLog2, int... kChildren>
  void read_node(const Vec3i& origin) {
    if constexpr (sizeof...(kChildren) == 0) {
      cursor_->skip(kVdbLeafMaskBytes);  // the mask stands before the leaf's values again
      visitor_->leaf(origin);
    } else {
      read_inner_node<kLog2, kChildren...>(origin);
    }
  }

  template <int kLog2, int kChild, int... kDeeper>
  void read_inner_node(const Vec3i& origin) {
    using Mask = openvdb::util::NodeMask<kLog2>;
    constexpr std::size_t kMaskBytes = Mask::SIZE / 8;
    constexpr int kEntrySize = 1 << (kChild + (0 + ... + kDeeper));
    const auto children = vdb_mask_from<Mask>(cursor_->peek(0, kMaskBytes));
    const auto active = vdb_mask_from<Mask>(cursor_->peek(kMaskBytes, kMaskBytes));
    cursor_->skip(2 * kMaskBytes);
    // Older files leave out the places of children.
    const uint64_t values =
        format_.file_version >= kVdbNodeCompression ? Mask::SIZE : children.countOff();
    const uint64_t block = vdb_value_block(*cursor_, 0, format_, values, active.countOn());
    visitor_->inner(origin, kEntrySize, children, active, cursor_->peek(0, block), values);
    cursor_->skip(block);
    for (auto entry = children.beginOn(); entry; ++entry) {
      read_node<kChild, kDeeper...>(vdb_entry_origin(origin, kLog2, entry.pos(), kEntrySize));
    }
  }

  FileCursor* cursor_;
  VdbValueFormat format_;
  Visitor* visitor_;
};

}  // namespace freepath::io
