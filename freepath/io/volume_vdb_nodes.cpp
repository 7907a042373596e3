#include "freepath/io/volume_vdb_nodes.h"

#include <algorithm>
#include <string_view>

#include "freepath/base/error.h"

namespace freepath::io {
namespace {

constexpr std::size_t kOriginBytes = 12;

struct ValueType {
  std::string_view name;
  std::size_t size, half_size;  ///< Stored as reals and as half precision.
  VdbLeafKind leaf = VdbLeafKind::kValues;
};
// Whole numbers stay whole where reals are stored in half precision.
constexpr ValueType kValueTypes[] = {{"float", 4, 2},
                                     {"half", 4, 2},
                                     {"double", 8, 2},
                                     {"int32", 4, 4},
                                     {"int64", 8, 8},
                                     {"bool", 1, 1, VdbLeafKind::kBools},
                                     {"vec3s", 12, 6},
                                     {"vec3h", 12, 6},
                                     {"vec3d", 24, 6},
                                     {"vec3i", 12, 12},
                                     {"mask", 1, 1, VdbLeafKind::kNothing}};

uint32_t word_at(std::span<const std::byte> bytes, std::size_t offset) {
  uint32_t word;
  std::memcpy(&word, bytes.data() + offset, sizeof(word));
  return word;
}

/// A visitor that counts leaves.
struct LeafCount {
  uint64_t leaves = 0;
  void background(std::span<const std::byte> /*value*/) {}
  void tile(const Vec3i& /*origin*/, int /*size*/, std::span<const std::byte> /*value*/,
            bool /*active*/) {}
  template <class Mask>
  void inner(const Vec3i& /*origin*/, int /*size*/, const Mask& /*children*/,
             const Mask& /*active*/, std::span<const std::byte> /*block*/, uint64_t /*values*/) {}
  void leaf(const Vec3i& /*origin*/) { ++leaves; }
};

/// Bytes of a block of `bytes` uncompressed ones at `ahead`.
uint64_t compressed_block(FileCursor& cursor, uint64_t ahead, uint32_t compression, int64_t bytes) {
  if ((compression & (kVdbZip | kVdbBlosc)) == 0) return static_cast<uint64_t>(bytes);
  // The size of the compressed values, or minus the size of uncompressed ones.
  int64_t length;
  std::memcpy(&length, cursor.peek(ahead, sizeof(length)).data(), sizeof(length));
  constexpr int64_t kOverhead = 64;
  bool sound = length <= 0 ? length == -bytes : length <= bytes + kOverhead;
  if (sound && length > 0 && (compression & kVdbBlosc) != 0) {
    constexpr std::size_t kBloscHeader = 16;
    const auto header = cursor.peek(ahead + sizeof(length), kBloscHeader);
    sound = length >= static_cast<int64_t>(kBloscHeader) && word_at(header, 4) == bytes &&
            word_at(header, 12) == length;
  }
  if (!sound) {
    cursor.file().fail_damaged(
        fmt::format("the size of the values at byte {} is impossible", cursor.offset() + ahead));
  }
  return sizeof(length) + static_cast<uint64_t>(length < 0 ? -length : length);
}

/// Buffers of a leaf in files before kVdbNodeCompression, behind mask and origin.
uint64_t old_leaf_buffers(FileCursor& cursor, const VdbValueFormat& format) {
  const bool bools = format.leaf == VdbLeafKind::kBools;
  uint64_t ahead = kVdbLeafMaskBytes + kOriginBytes;
  // Those behind the first are of no use any more.
  const auto buffers = std::max<int8_t>(1, static_cast<int8_t>(cursor.peek(ahead, 1)[0]));
  ++ahead;
  const auto bytes = static_cast<int64_t>(kLeafVoxels * (bools ? 1 : format.stored_size));
  for (int8_t i = 0; i < buffers; ++i) {
    ahead += compressed_block(cursor, ahead, bools ? kVdbZip : format.compression, bytes);
  }
  return ahead;
}

}  // namespace

std::optional<VdbValueFormat> vdb_value_format(const VdbDirectory& directory, const VdbGrid& grid) {
  const std::string type = vdb_value_type(grid);
  const auto* const found = std::ranges::find(kValueTypes, type, &ValueType::name);
  if (found == std::end(kValueTypes)) return std::nullopt;
  return VdbValueFormat{directory.file_version, grid.compression, found->size,
                        grid.half ? found->half_size : found->size, found->leaf};
}

uint64_t vdb_value_block(FileCursor& cursor, uint64_t ahead, const VdbValueFormat& format,
                         uint64_t count, uint64_t active) {
  const VolumeFile& file = cursor.file();
  constexpr uint8_t kAllValues = 6;
  uint8_t kind = kAllValues;
  uint64_t size = 0;
  if (format.file_version >= kVdbNodeCompression) {
    // First a byte on how inactive values are stored: not at all, one or two of them with or
    // without a mask that tells which is where, or all in full.
    kind = static_cast<uint8_t>(cursor.peek(ahead, 1)[0]);
    if (kind > kAllValues) {
      file.fail_damaged(fmt::format("a node at byte {}", cursor.offset() + ahead));
    }
    size = 1;
    if (kind == 2 || kind == 4) size += format.value_size;
    if (kind == 5) size += 2 * format.value_size;
    if (kind >= 3 && kind <= 5) size += count / 8;
  }
  const bool active_only = (format.compression & kVdbActiveMask) != 0 && kind != kAllValues;
  const uint64_t stored = active_only ? active : count;
  if (stored == 0 && format.stored_size != format.value_size) return size;
  size += compressed_block(cursor, ahead + size, format.compression,
                           static_cast<int64_t>(stored * format.stored_size));
  file.require(cursor.offset() + ahead, size);
  return size;
}

uint64_t vdb_leaf_size(FileCursor& cursor, const VdbValueFormat& format) {
  uint64_t size = kVdbLeafMaskBytes + kOriginBytes;
  if (format.leaf == VdbLeafKind::kBools && format.file_version >= kVdbBoolBits) {
    size += kVdbLeafMaskBytes;
  } else if (format.leaf == VdbLeafKind::kBools ||
             (format.leaf == VdbLeafKind::kValues && format.file_version < kVdbNodeCompression)) {
    size = old_leaf_buffers(cursor, format);
  } else if (format.leaf == VdbLeafKind::kValues) {
    const auto mask = vdb_mask_from<openvdb::util::NodeMask<3>>(cursor.peek(0, kVdbLeafMaskBytes));
    size = kVdbLeafMaskBytes +
           vdb_value_block(cursor, kVdbLeafMaskBytes, format, kLeafVoxels, mask.countOn());
  }
  cursor.file().require(cursor.offset(), size);
  return size;
}

std::size_t vdb_leaf_values(const VdbValueFormat& format) {
  if (format.leaf == VdbLeafKind::kValues && format.file_version >= kVdbNodeCompression) {
    return kVdbLeafMaskBytes;
  }
  const bool bits = format.leaf == VdbLeafKind::kNothing ||
                    (format.leaf == VdbLeafKind::kBools && format.file_version >= kVdbBoolBits);
  return kVdbLeafMaskBytes + kOriginBytes + (bits ? 0 : 1);
}

VdbTreeEnds skip_vdb_topology(const VolumeFile& file, uint64_t offset,
                              const VdbValueFormat& format) {
  FileCursor cursor(file, offset);
  LeafCount count;
  VdbTopology(cursor, format, count).read();
  return {cursor.offset(), count.leaves};
}

}  // namespace freepath::io
