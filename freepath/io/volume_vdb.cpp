// Reads .vdb files. OpenVDB decodes values, masks and transforms; the tree is walked here, since
// OpenVDB's own walk holds the whole grid in memory and trusts the file (see volume_vdb_layout.h).

#include <algorithm>
#include <array>
#include <cstring>
#include <istream>
#include <memory>
#include <streambuf>

#include <openvdb/io/Compression.h>
#include <openvdb/io/io.h>
#include <openvdb/math/Maps.h>
#include <openvdb/math/Transform.h>
#include <openvdb/openvdb.h>
#include <openvdb/util/NodeMasks.h>

#include "freepath/base/error.h"
#include "freepath/io/volume_assembly.h"
#include "freepath/io/volume_formats.h"
#include "freepath/io/volume_pipeline.h"
#include "freepath/io/volume_vdb_layout.h"

namespace freepath::io {
namespace {

using LeafMask = openvdb::util::NodeMask<3>;
constexpr std::size_t kLeafMaskBytes = 64;
constexpr std::size_t kVdbChunkBytes = std::size_t{1} << 20;

void initialize_openvdb() {
  static const bool kDone = (openvdb::initialize(), true);
  static_cast<void>(kDone);
}

/// A stream over bytes in memory.
class MemoryBuffer : public std::streambuf {
 public:
  void reset(std::span<const std::byte> bytes) {
    char* const begin = const_cast<char*>(reinterpret_cast<const char*>(bytes.data()));
    setg(begin, begin, begin + bytes.size());  // never written to: a streambuf is not const-correct
  }
  std::size_t taken() const { return static_cast<std::size_t>(gptr() - eback()); }

 protected:
  std::streamsize xsgetn(char* destination, std::streamsize count) override {
    count = std::min<std::streamsize>(count, egptr() - gptr());
    std::copy_n(gptr(), count, destination);
    setg(eback(), gptr() + count, egptr());
    return count;
  }
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
Mask mask_from(std::span<const std::byte> bytes) {
  Mask mask;
  for (openvdb::Index word = 0; word < Mask::WORD_COUNT; ++word) {
    std::memcpy(&mask.template getWord<uint64_t>(word), bytes.data() + std::size_t{8} * word, 8);
  }
  return mask;
}

template <class T>
VdbValueFormat format_of(const VdbGrid& grid) {
  return {grid.compression, sizeof(T), grid.half ? 2 * ValueChannels<T>::kCount : sizeof(T)};
}

/// Walks the topology of a grid: from the file's depth-first order of nodes to a layout.
template <class T>
class TopologyWalk {
 public:
  TopologyWalk(const VolumeFile& file, uint64_t offset, const VdbDirectory& directory,
               const VdbGrid& grid)
      : cursor_(file, offset), format_(format_of<T>(grid)), decoder_(directory, grid) {}

  /// Reads everything; the cursor then stands at the first leaf's values.
  GridLayout read() {
    const auto buffers = cursor_.take<uint32_t>();
    if (buffers != 1) cursor_.file().fail_damaged(fmt::format("leaves with {} buffers", buffers));
    layout_.set_background(cursor_.take<T>());
    const auto tiles = cursor_.take<uint32_t>();
    const auto children = cursor_.take<uint32_t>();
    for (uint32_t i = 0; i < tiles; ++i) {
      const Vec3i origin = take_root_origin();
      const T value = cursor_.take<T>();
      if (cursor_.take<uint8_t>() != 0) layout_.add_tile(origin, 4096, value);
    }
    for (uint32_t i = 0; i < children; ++i) read_node<5, 4, 3>(take_root_origin());
    return std::move(layout_);
  }

  uint64_t offset() const { return cursor_.offset(); }

 private:
  Vec3i take_root_origin() {
    Vec3i origin;
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = cursor_.take<int32_t>();
      if ((origin[axis] & 4095) != 0) {
        cursor_.file().fail_damaged(
            fmt::format("a node of 4096 voxels a side begins at {}", origin[axis]));
      }
    }
    return origin;
  }

  /// A node with 2^kLog2 entries a side, whose children have the sizes that follow.
  template <int kLog2, int... kChildren>
  void read_node(const Vec3i& origin) {
    if constexpr (sizeof...(kChildren) == 0) {
      cursor_.skip(kLeafMaskBytes);  // the mask stands before the leaf's values again
      layout_.add_leaf(origin);
    } else {
      read_inner_node<kLog2, kChildren...>(origin);
    }
  }

  template <int kLog2, int kChild, int... kDeeper>
  void read_inner_node(const Vec3i& origin) {
    using Mask = openvdb::util::NodeMask<kLog2>;
    constexpr std::size_t kMaskBytes = Mask::SIZE / 8;
    constexpr int kEntrySize = 1 << (kChild + (0 + ... + kDeeper));
    const auto children = mask_from<Mask>(cursor_.peek(0, kMaskBytes));
    const auto active = mask_from<Mask>(cursor_.peek(kMaskBytes, kMaskBytes));
    cursor_.skip(2 * kMaskBytes);
    const uint64_t block = vdb_value_block(cursor_, 0, format_, Mask::SIZE, active.countOn());
    if (!active.isOff()) {
      std::vector<T> values(Mask::SIZE);
      decoder_.decode(cursor_.peek(0, block), active, std::span(values));
      for (auto entry = active.beginOn(); entry; ++entry) {
        if (children.isOn(entry.pos())) continue;
        layout_.add_tile(entry_origin<kLog2>(origin, entry.pos(), kEntrySize), kEntrySize,
                         values[entry.pos()]);
      }
    }
    cursor_.skip(block);
    for (auto entry = children.beginOn(); entry; ++entry) {
      read_node<kChild, kDeeper...>(entry_origin<kLog2>(origin, entry.pos(), kEntrySize));
    }
  }

  template <int kLog2>
  static Vec3i entry_origin(const Vec3i& origin, uint32_t entry, int size) {
    constexpr uint32_t kLast = (1U << kLog2) - 1;
    return origin + Vec3i(static_cast<int>(entry >> (2 * kLog2)),
                          static_cast<int>((entry >> kLog2) & kLast),
                          static_cast<int>(entry & kLast)) *
                        size;
  }

  FileCursor cursor_;
  VdbValueFormat format_;
  ValueDecoder decoder_;
  GridLayout layout_{ValueChannels<T>::kCount};
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
      const auto mask = mask_from<LeafMask>(cursor_.peek(0, kLeafMaskBytes));
      cursor_.skip(kLeafMaskBytes +
                   vdb_value_block(cursor_, kLeafMaskBytes, format_, kLeafVoxels, mask.countOn()));
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

template <class T>
GridScan take_chunk(const VdbChunk& chunk, const VdbDirectory& directory, const VdbGrid& grid,
                    const GridAssembly& assembly) {
  GridScan scan;
  ValueDecoder decoder(directory, grid);
  std::array<T, kLeafVoxels> values;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < chunk.ends.size(); ++i) {
    const auto leaf = std::span(chunk.bytes).subspan(begin, chunk.ends[i] - begin);
    const auto mask = mask_from<LeafMask>(leaf);
    decoder.decode(leaf.subspan(kLeafMaskBytes), mask, std::span<T>(values));
    uint64_t words[8];
    std::memcpy(words, leaf.data(), kLeafMaskBytes);
    assembly.take_leaf(chunk.first_leaf + i, values.data(), words, scan);
    begin = chunk.ends[i];
  }
  return scan;
}

/// Reads the leaves from `offset` on: one thread reads, all decode.
template <class T>
GridScan read_leaves(const VolumeFile& file, uint64_t offset, const VdbDirectory& directory,
                     const VdbGrid& grid, const GridAssembly& assembly) {
  ChunkReader reader(file, offset, format_of<T>(grid), assembly.leaf_count());
  return scan_chunks<VdbChunk>(
      [&] { return reader.next(); },
      [&](const VdbChunk& chunk) { return take_chunk<T>(chunk, directory, grid, assembly); });
}

struct PlacedTransform {
  Matrix4d index_to_world;
  uint64_t end = 0;    ///< Where the transform ends in the file.
  std::string reason;  ///< Why the grid can't be loaded for it.
};

/// Reads the transform of a grid.
PlacedTransform read_transform(const VolumeFile& file, const VdbDirectory& directory,
                               const VdbGrid& grid) {
  initialize_openvdb();
  PlacedTransform placed;
  if (grid.transform_type == openvdb::math::NonlinearFrustumMap::mapType()) {
    placed.reason =
        "its transform is a frustum, not affine; resample it into an affine grid "
        "(openvdb::tools::resampleToMatch)";
    return placed;
  }
  if (!openvdb::math::MapRegistry::isRegistered(grid.transform_type)) {
    placed.reason = fmt::format(
        "its transform is of the unknown type \"{}\"; the file is damaged "
        "or made by a newer OpenVDB",
        grid.transform_type);
    return placed;
  }
  constexpr std::size_t kLongest = 1024;  // twice the longest affine map
  std::vector<std::byte> bytes(std::min<uint64_t>(kLongest, file.size() - grid.transform));
  file.read(grid.transform, bytes);
  MemoryBuffer buffer;
  buffer.reset(bytes);
  std::istream stream(&buffer);
  stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
  openvdb::io::setVersion(stream,
                          openvdb::VersionId(directory.library_major, directory.library_minor),
                          directory.file_version);
  openvdb::math::Transform transform;
  try {
    transform.read(stream);
  } catch (const openvdb::ArithmeticError&) {
    placed.reason = "its transform is not invertible; set another";
    return placed;
  }
  const auto matrix = transform.baseMap()->getAffineMap()->getMat4();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      placed.index_to_world[row][column] = matrix(row, column);
    }
  }
  placed.end = grid.transform + buffer.taken();
  placed.reason = reason_against_transform(placed.index_to_world);
  return placed;
}

/// "float" of "Tree_float_5_4_3", "points" of a point data tree; empty if the tree isn't 5-4-3.
std::string value_type(const VdbGrid& grid) {
  std::string_view type = grid.tree_type;
  if (type.find("ptdataidx") != type.npos || type.find("ptidx") != type.npos) return "points";
  constexpr std::string_view kPrefix = "Tree_", kSuffix = "_5_4_3";
  if (!type.starts_with(kPrefix) || !type.ends_with(kSuffix)) return grid.tree_type;
  type.remove_prefix(kPrefix.size());
  type.remove_suffix(kSuffix.size());
  if (type == "float" && grid.half) return "half";
  if (type == "vec3s" && grid.half) return "vec3h";
  return std::string(type);
}

/// Densities in a voxel of a type; 0 if it can't be read.
int channels_of(std::string_view type) {
  if (type == "float" || type == "half" || type == "double") return 1;
  return type == "vec3s" || type == "vec3h" || type == "vec3d" ? 3 : 0;
}

/// What the directory tells of each grid, without reading voxels.
std::vector<GridInfo> describe_directory(const VolumeFile& file, const VdbDirectory& directory) {
  std::vector<GridInfo> grids;
  for (const VdbGrid& grid : directory.grids) {
    GridInfo info;
    info.name = grid.name;
    info.index = static_cast<int>(grids.size());
    info.type = value_type(grid);
    info.grid_class = grid.grid_class;
    info.stored_bytes = grid.end - grid.begin;
    const int channels = channels_of(info.type);
    info.channels = std::max(channels, 1);
    info.reason =
        channels > 0 ? reason_against_class(info.grid_class) : reason_against_type(info.type);
    const PlacedTransform transform = read_transform(file, directory, grid);
    info.index_to_world = transform.index_to_world;
    if (info.reason.empty()) info.reason = transform.reason;
    info.loadable = info.reason.empty();
    grids.push_back(std::move(info));
  }
  make_names_unique(grids);
  return grids;
}

/// Reads the voxels of a grid; the assembly has no bricks unless `keep_values`.
struct ReadVdbGrid {
  std::unique_ptr<GridAssembly> assembly;
  GridScan scan;
};

template <class T>
ReadVdbGrid read_grid(const VolumeFile& file, const VdbDirectory& directory, const VdbGrid& grid,
                      const std::string& name, const LoadOptions& options, bool keep_values) {
  TopologyWalk<T> walk(file, read_transform(file, directory, grid).end, directory, grid);
  ReadVdbGrid result;
  result.assembly =
      std::make_unique<GridAssembly>(file.name(), name, options, walk.read(), keep_values);
  result.scan = read_leaves<T>(file, walk.offset(), directory, grid, *result.assembly);
  return result;
}

ReadVdbGrid read_grid(const VolumeFile& file, const VdbDirectory& directory, const GridInfo& info,
                      const LoadOptions& options, bool keep_values) {
  const VdbGrid& grid = directory.grids[static_cast<std::size_t>(info.index)];
  const VdbGrid& tree =
      grid.tree_of < 0 ? grid : directory.grids[static_cast<std::size_t>(grid.tree_of)];
  const auto read_as = [&]<class T>(T /*value*/) {
    return read_grid<T>(file, directory, tree, info.name, options, keep_values);
  };
  if (info.type == "double") return read_as(double{});
  if (info.type == "vec3d") return read_as(openvdb::Vec3d{});
  return info.channels == 3 ? read_as(openvdb::Vec3s{}) : read_as(float{});
}

}  // namespace

std::vector<GridInfo> list_vdb_grids(const VolumeFile& file) {
  const VdbDirectory directory = read_vdb_directory(file);
  std::vector<GridInfo> grids = describe_directory(file, directory);
  for (GridInfo& info : grids) {
    if (channels_of(info.type) == 0) continue;
    try {
      const ReadVdbGrid read = read_grid(file, directory, info, {}, false);
      read.assembly->describe(read.scan, info);
    } catch (const std::exception& error) {
      set_failure(file.name(), error.what(), info);
    }
  }
  return grids;
}

std::vector<LoadedField> load_vdb_fields(const VolumeFile& file, const LoadOptions& options) {
  const VdbDirectory directory = read_vdb_directory(file);
  const std::vector<GridInfo> grids = describe_directory(file, directory);
  const GridInfo& info = find_grid(file.name(), grids, options.selection);
  check_selected(file.name(), info, options);
  ReadVdbGrid read = read_grid(file, directory, info, options, true);
  return std::move(*read.assembly).finish(info, read.scan);
}

}  // namespace freepath::io
