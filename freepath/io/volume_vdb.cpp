// Reads .vdb files. OpenVDB decodes values, masks and transforms; the tree is walked here, since
// OpenVDB's own walk holds the whole grid in memory and trusts the file (see volume_vdb_layout.h).

#include <algorithm>
#include <array>
#include <cstring>
#include <istream>
#include <memory>

#include <openvdb/io/Compression.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>
#include <openvdb/util/NodeMasks.h>

#include "freepath/base/error.h"
#include "freepath/io/memory_buffer.h"
#include "freepath/io/volume_assembly.h"
#include "freepath/io/volume_formats.h"
#include "freepath/io/volume_pipeline.h"
#include "freepath/io/volume_vdb_layout.h"
#include "freepath/io/volume_vdb_nodes.h"

namespace freepath::io {
namespace {

using LeafMask = openvdb::util::NodeMask<3>;
constexpr std::size_t kVdbChunkBytes = std::size_t{1} << 20;

/// A truth value as OpenVDB stores it; in a damaged file it may be any byte.
struct StoredBool {
  uint8_t byte = 0;

  StoredBool() = default;
  explicit StoredBool(int value) : byte(value != 0 ? 1 : 0) {}
  /// What OpenVDB takes for the negative of a truth value.
  StoredBool operator-() const { return StoredBool(byte == 0 ? 1 : 0); }
  explicit operator double() const { return byte != 0 ? 1 : 0; }
  bool operator==(const StoredBool& other) const { return (byte != 0) == (other.byte != 0); }
};

/// Decodes blocks of values by OpenVDB, from bytes whose extent was checked.
class ValueDecoder {
 public:
  ValueDecoder(const VdbDirectory& directory, const VdbGrid& grid)
      : half_(grid.half), stream_(&buffer_) {
    stream_.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
    openvdb::io::setVersion(stream_,
                            openvdb::VersionId(directory.library_major, directory.library_minor),
                            directory.file_version);
    openvdb::io::setDataCompression(stream_, grid.compression);
  }

  /// @param background what inactive values may be; has to outlive the decoder
  void set_background(const void* background) {
    openvdb::io::setGridBackgroundValuePtr(stream_, background);
  }

  template <class T, class Mask>
  void decode(std::span<const std::byte> block, const Mask& active, std::span<T> values) {
    buffer_.reset(block);
    stream_.clear();
    openvdb::io::readCompressedValues(stream_, values.data(),
                                      static_cast<openvdb::Index>(values.size()), active, half_);
  }

 private:
  bool half_;
  MemoryBuffer buffer_;
  std::istream stream_;
};

template <class Mask>
bool is_uniform(const Mask& children, const Mask& active) {
  return children.isOff() && (active.isOn() || active.isOff());
}

/// Takes the tiles and leaves of a grid's topology into a layout.
template <class T>
class LayoutVisitor {
 public:
  LayoutVisitor(const VdbDirectory& directory, const VdbGrid& grid, const VdbValueFormat& format)
      : format_(format), decoder_(directory, grid) {}

  GridLayout layout{ValueChannels<T>::kCount};

  const T& background_value() const { return background_; }

  void background(std::span<const std::byte> value) {
    background_ = value_of(value);
    if (is_mask()) background_ = T{};
    decoder_.set_background(&background_);
    layout.set_background(background_);
  }
  void tile(const Vec3i& origin, int size, std::span<const std::byte> value, bool active) {
    add_tile(origin, size, value_of(value), active);
  }
  void leaf(const Vec3i& origin) { layout.add_leaf(origin); }

  template <class Mask>
  void inner(const Vec3i& origin, int size, const Mask& children, const Mask& active,
             std::span<const std::byte> block, uint64_t count) {
    constexpr auto kOnlyBackground = std::byte{0};  // the kind of a node without inactive values
    const bool known = format_.file_version >= kVdbNodeCompression;
    if (active.isOff() && known && block[0] == kOnlyBackground) return;
    std::vector<T> values(count);
    decoder_.decode(block, active, std::span(values));
    if (count < Mask::SIZE) values = spread(values, children);
    const auto differs = [&](const T& value) { return !(value == values[0]); };
    if (is_uniform(children, active) && std::ranges::none_of(values, differs)) {
      add_tile(origin, size << Mask::LOG2DIM, values[0], active.isOn());
      return;
    }
    for (uint32_t entry = 0; entry < Mask::SIZE; ++entry) {
      if (children.isOn(entry)) continue;
      add_tile(vdb_entry_origin(origin, Mask::LOG2DIM, entry, size), size, values[entry],
               active.isOn(entry));
    }
  }

 private:
  bool is_mask() const { return format_.leaf == VdbLeafKind::kNothing; }

  static T value_of(std::span<const std::byte> bytes) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }

  void add_tile(const Vec3i& origin, int size, const T& value, bool active) {
    if constexpr (std::is_same_v<T, StoredBool>) {
      layout.add_tile(origin, size, is_mask() ? StoredBool(active ? 1 : 0) : value, active);
    } else {
      layout.add_tile(origin, size, value, active);
    }
  }

  /// Values that stand without the places of children, at their places.
  template <class Mask>
  static std::vector<T> spread(const std::vector<T>& packed, const Mask& children) {
    std::vector<T> values(Mask::SIZE);
    std::size_t next = 0;
    for (uint32_t entry = 0; entry < Mask::SIZE; ++entry) {
      if (!children.isOn(entry)) values[entry] = packed[next++];
    }
    return values;
  }

  VdbValueFormat format_;
  ValueDecoder decoder_;
  T background_{};
};

/// Some leaves in a row, as they stand in the file.
struct VdbChunk {
  std::vector<std::byte> bytes;
  std::vector<std::size_t> ends;  ///< Where each leaf ends in `bytes`.
  std::size_t first_leaf = 0;
};

/// Cuts the leaves into chunks of about a megabyte.
class ChunkReader {
 public:
  ChunkReader(const VolumeFile& file, uint64_t offset, const VdbValueFormat& format,
              std::size_t leaves)
      : cursor_(file, offset), format_(format), leaves_(leaves) {}

  /// The next chunk, null behind the last.
  std::shared_ptr<VdbChunk> next() {
    if (leaf_ == leaves_) return nullptr;
    auto chunk = std::make_shared<VdbChunk>();
    chunk->first_leaf = leaf_;
    const uint64_t begin = cursor_.offset();
    while (leaf_ < leaves_ && cursor_.offset() - begin < kVdbChunkBytes) {
      cursor_.skip(vdb_leaf_size(cursor_, format_));
      chunk->ends.push_back(cursor_.offset() - begin);
      ++leaf_;
    }
    chunk->bytes.resize(cursor_.offset() - begin);
    cursor_.file().read(begin, chunk->bytes);
    return chunk;
  }

 private:
  FileCursor cursor_;
  VdbValueFormat format_;
  std::size_t leaves_;
  std::size_t leaf_ = 0;
};

/// The values of leaves, whatever way they are stored.
template <class T>
class LeafDecoder {
 public:
  LeafDecoder(const VdbDirectory& directory, const VdbGrid& grid, const VdbValueFormat& format,
              const T& background)
      : format_(format), background_(background), decoder_(directory, grid) {
    decoder_.set_background(&background_);
  }
  LeafDecoder(const LeafDecoder&) = delete;
  LeafDecoder& operator=(const LeafDecoder&) = delete;

  void decode(std::span<const std::byte> leaf, std::span<T> values) {
    const auto block = leaf.subspan(vdb_leaf_values(format_));
    if (format_.leaf == VdbLeafKind::kValues ||
        (format_.leaf == VdbLeafKind::kBools && format_.file_version < kVdbBoolBits)) {
      decoder_.decode(block, vdb_mask_from<LeafMask>(leaf), values);
      return;
    }
    const auto bits = vdb_mask_from<LeafMask>(
        format_.leaf == VdbLeafKind::kBools ? block : leaf.first(kVdbLeafMaskBytes));
    if constexpr (std::is_same_v<T, StoredBool>) {
      for (uint32_t i = 0; i < kLeafVoxels; ++i) values[i] = StoredBool(bits.isOn(i) ? 1 : 0);
    }
  }

 private:
  VdbValueFormat format_;
  T background_;
  ValueDecoder decoder_;
};

/// A grid with its tree, as the reader of a type of value needs it.
struct TreeSource {
  const VolumeFile& file;
  const VdbDirectory& directory;
  const VdbGrid& grid;  ///< The one whose tree it is.
  VdbValueFormat format;
};

template <class T>
GridScan take_chunk(const VdbChunk& chunk, const TreeSource& source, const T& background,
                    const GridAssembly& assembly) {
  GridScan scan;
  LeafDecoder<T> decoder(source.directory, source.grid, source.format, background);
  std::array<T, kLeafVoxels> values;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < chunk.ends.size(); ++i) {
    const auto leaf = std::span(chunk.bytes).subspan(begin, chunk.ends[i] - begin);
    decoder.decode(leaf, std::span<T>(values));
    uint64_t words[8];
    std::memcpy(words, leaf.data(), kVdbLeafMaskBytes);
    assembly.take_leaf(chunk.first_leaf + i, values.data(), words, scan);
    begin = chunk.ends[i];
  }
  return scan;
}

/// @param name of the grid, in messages
template <class T>
AssembledGrid read_tree(const TreeSource& source, const std::string& name,
                        const LoadOptions& options, bool keep_values) {
  const VdbLocation location = read_vdb_location(source.file, source.directory, source.grid);
  FileCursor cursor(source.file, location.topology);
  LayoutVisitor<T> visitor(source.directory, source.grid, source.format);
  VdbTopology(cursor, source.format, visitor).read();
  const T background = visitor.background_value();
  AssembledGrid result;
  result.assembly = std::make_unique<GridAssembly>(source.file.name(), name, options,
                                                   std::move(visitor.layout), keep_values);
  // Older files have the transform between topology and leaves.
  ChunkReader reader(source.file, std::max(cursor.offset(), location.end), source.format,
                     result.assembly->leaf_count());
  result.scan =
      scan_chunks<VdbChunk>([&] { return reader.next(); },
                            [&](const VdbChunk& chunk) {
                              return take_chunk<T>(chunk, source, background, *result.assembly);
                            });
  return result;
}

class VdbReader : public VolumeReader {
 public:
  explicit VdbReader(const VolumeFile& file) : file_(file), directory_(read_vdb_directory(file)) {}

  std::vector<GridInfo> heads() const override {
    std::vector<GridInfo> grids;
    for (const VdbGrid& grid : directory_.grids) {
      GridInfo info = head_of(grid);
      info.index = static_cast<int>(grids.size());
      grids.push_back(std::move(info));
    }
    make_names_unique(grids);
    return grids;
  }

  bool is_readable(const GridInfo& head) const override {
    return grid_of(head).reason.empty() && vdb_value_format(directory_, tree_of(head)).has_value();
  }

  AssembledGrid read(const GridInfo& head, const LoadOptions& options,
                     bool keep_values) const override {
    const VdbGrid& tree = tree_of(head);
    const TreeSource source{file_, directory_, tree, *vdb_value_format(directory_, tree)};
    const auto read_as = [&]<class T>(T /*value*/) {
      return read_tree<T>(source, head.name, options, keep_values);
    };
    const std::string type = vdb_value_type(tree);
    if (type == "double") return read_as(double{});
    if (type == "int32") return read_as(int32_t{});
    if (type == "int64") return read_as(int64_t{});
    if (type == "bool" || type == "mask") return read_as(StoredBool{});
    if (type == "vec3d") return read_as(openvdb::Vec3d{});
    if (type == "vec3i") return read_as(openvdb::Vec3i{});
    return type.starts_with("vec3") ? read_as(openvdb::Vec3s{}) : read_as(float{});
  }

  void finish(const GridInfo& head, std::vector<LoadedField>& fields) const override {
    const VdbLocation location = read_vdb_location(file_, directory_, grid_of(head));
    if (location.frustum) {
      resample_frustum(grid_label(file_.name(), head.name), *location.frustum, fields);
    }
  }

 private:
  GridInfo head_of(const VdbGrid& grid) const {
    GridInfo info;
    info.name = grid.name;
    info.type = vdb_value_type(grid);
    info.grid_class = grid.grid_class;
    info.stored_bytes = grid.end - grid.begin;
    info.reason = grid.reason;
    if (!info.reason.empty()) return info;
    const bool known = vdb_value_format(directory_, grid).has_value();
    info.channels = known && info.type.starts_with("vec3") ? 3 : 1;
    info.reason = known ? reason_against_class(info.grid_class) : reason_against_type(info.type);
    if (!known && directory_.file_version < kVdbInstances) return info;
    const VdbLocation location = read_vdb_location(file_, directory_, grid);
    info.index_to_world = location.index_to_world;
    if (info.reason.empty()) info.reason = location.reason;
    info.loadable = info.reason.empty();
    return info;
  }

  const VdbGrid& grid_of(const GridInfo& head) const {
    return directory_.grids[static_cast<std::size_t>(head.index)];
  }
  const VdbGrid& tree_of(const GridInfo& head) const {
    const VdbGrid& grid = grid_of(head);
    return grid.tree_of < 0 ? grid : directory_.grids[static_cast<std::size_t>(grid.tree_of)];
  }

  const VolumeFile& file_;
  VdbDirectory directory_;
};

}  // namespace

std::unique_ptr<VolumeReader> open_vdb(const VolumeFile& file) {
  return std::make_unique<VdbReader>(file);
}

}  // namespace freepath::io
