// Reads .nvdb files. NanoVDB's structures give the layout of nodes and decode quantised values; the
// tree is walked here, since NanoVDB's reader trusts every offset and holds the grid as a whole.

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include <nanovdb/NanoVDB.h>

#include "freepath/base/error.h"
#include "freepath/io/volume_assembly.h"
#include "freepath/io/volume_formats.h"
#include "freepath/io/volume_nvdb_layout.h"
#include "freepath/io/volume_pipeline.h"

namespace freepath::io {
namespace {

constexpr std::size_t kNvdbChunkBytes = std::size_t{1} << 20;

/// A node or leaf that a parent refers to.
struct NodeLocation {
  uint64_t offset = 0;  ///< In the grid.
  Vec3i origin;         ///< First voxel.
};

/// Walks from the root to the leaves of a grid, level by level.
template <class Build>
class TreeWalk {
 public:
  using Root = typename nanovdb::NanoRoot<Build>::DataType;
  using Upper = typename nanovdb::NanoUpper<Build>::DataType;
  using Lower = typename nanovdb::NanoLower<Build>::DataType;
  using Value = std::remove_cv_t<decltype(Root::mBackground)>;
  static constexpr bool kIsMask = std::is_same_v<Build, nanovdb::ValueMask>;

  TreeWalk(const VolumeFile& file, NvdbBytes& bytes) : file_(&file), bytes_(&bytes) {}

  GridLayout layout{ValueChannels<decltype(Root::mBackground)>::kCount};
  std::vector<NodeLocation> leaves;  ///< In the order of the file, as in the layout.

  void read(uint64_t root_offset) {
    std::vector<NodeLocation> upper = read_root(root_offset);
    // Two nodes of the root at one place would hold two values there.
    check_distinct(*file_, std::move(root_origins_));
    sort_level(upper, sizeof(Upper));
    std::vector<NodeLocation> lower;
    for (const NodeLocation& location : upper) read_node<Upper, 32, 128>(location, lower);
    sort_level(lower, sizeof(Lower));
    for (const NodeLocation& location : lower) read_node<Lower, 16, 8>(location, leaves);
    sort_level(leaves, 1);
    for (const NodeLocation& leaf : leaves) layout.add_leaf(leaf.origin);
  }

 private:
  std::vector<NodeLocation> read_root(uint64_t offset) {
    check_alignment(offset);
    bytes_->read(offset, buffer_.resize(sizeof(Root)));
    const uint32_t count = buffer_.node<Root>(0).mTableSize;
    layout.set_background(kIsMask ? Value{} : buffer_.node<Root>(0).mBackground);
    end_ = offset + sizeof(Root);
    std::vector<NodeLocation> children;
    using Tile = typename Root::Tile;
    for (uint32_t i = 0; i < count; ++i) {
      bytes_->read(end_, buffer_.resize(sizeof(Tile)));
      end_ += sizeof(Tile);
      const Tile& tile = buffer_.node<Tile>(0);
      const nanovdb::Coord corner = tile.origin();
      const Vec3i origin(corner[0], corner[1], corner[2]);
      root_origins_.push_back(origin);
      if (tile.isChild()) {
        children.push_back({offset + static_cast<uint64_t>(tile.child), origin});
      } else {
        add_tile(origin, 4096, tile.value, tile.state != 0);
      }
    }
    return children;
  }

  template <class Node, int kSide, int kEntrySize>
  void read_node(const NodeLocation& location, std::vector<NodeLocation>& children) {
    bytes_->read(location.offset, buffer_.resize(sizeof(Node)));
    const Node& node = buffer_.node<Node>(0);
    constexpr int kEntries = kSide * kSide * kSide;
    if (is_uniform<kEntries>(node)) {
      add_tile(location.origin, kEntrySize * kSide, node.mTable[0].value, node.mValueMask.isOn(0));
      return;
    }
    for (int entry = 0; entry < kEntries; ++entry) {
      const Vec3i origin =
          location.origin +
          Vec3i(entry / (kSide * kSide), entry / kSide % kSide, entry % kSide) * kEntrySize;
      if (node.mChildMask.isOn(entry)) {
        children.push_back(
            {location.offset + static_cast<uint64_t>(node.mTable[entry].child), origin});
      } else {
        add_tile(origin, kEntrySize, node.mTable[entry].value, node.mValueMask.isOn(entry));
      }
    }
  }

  /// Whether a node is one tile.
  template <int kEntries, class Node>
  static bool is_uniform(const Node& node) {
    if (!node.mChildMask.isOff() || !(node.mValueMask.isOn() || node.mValueMask.isOff())) {
      return false;
    }
    for (int entry = 1; entry < kEntries; ++entry) {
      if (!(node.mTable[entry].value == node.mTable[0].value)) return false;
    }
    return true;
  }

  void add_tile(const Vec3i& origin, int size, const Value& value, bool active) {
    if constexpr (kIsMask) {
      layout.add_tile(origin, size, active, active);
    } else {
      layout.add_tile(origin, size, value, active);
    }
  }

  void check_alignment(uint64_t offset) const {
    if (offset % NANOVDB_DATA_ALIGNMENT != 0) {
      file_->fail_damaged(fmt::format("a node at byte {} of its grid", offset));
    }
  }

  /// Orders the nodes of a level as they stand in the file; they must not overlap each other or
  /// what was read before.
  void sort_level(std::vector<NodeLocation>& nodes, uint64_t node_size) {
    std::sort(nodes.begin(), nodes.end(),
              [](const NodeLocation& a, const NodeLocation& b) { return a.offset < b.offset; });
    for (const NodeLocation& node : nodes) {
      check_alignment(node.offset);
      if (node.offset < end_ || node.offset > bytes_->size()) {
        file_->fail_damaged(fmt::format("two nodes at byte {} of their grid", node.offset));
      }
      end_ = node.offset + node_size;
    }
  }

  const VolumeFile* file_;
  NvdbBytes* bytes_;
  NodeBuffer buffer_;
  uint64_t end_ = 0;  // of what was read
  std::vector<Vec3i> root_origins_;
};

/// Leaves in a row, as they stand in the grid.
struct NvdbChunk {
  NodeBuffer buffer;
  std::size_t size = 0;
  std::size_t first = 0, last = 0;  ///< Half-open range of leaves.
};

template <class Build>
constexpr std::size_t largest_leaf() {
  using Leaf = typename nanovdb::NanoLeaf<Build>::DataType;
  constexpr std::size_t kWidestFpN = 16;  // bits a value
  if constexpr (std::is_same_v<Build, nanovdb::FpN>)
    return sizeof(Leaf) + kLeafVoxels / 8 * kWidestFpN;
  return sizeof(Leaf);
}

template <class Build>
std::shared_ptr<NvdbChunk> read_chunk(NvdbBytes& bytes, const std::vector<NodeLocation>& leaves,
                                      std::size_t first) {
  if (first == leaves.size()) return nullptr;
  auto chunk = std::make_shared<NvdbChunk>();
  chunk->first = first;
  const uint64_t begin = leaves[first].offset;
  uint64_t end = begin;
  std::size_t leaf = first;
  for (; leaf < leaves.size(); ++leaf) {
    const uint64_t next = leaf + 1 < leaves.size() ? leaves[leaf + 1].offset : bytes.size();
    const uint64_t leaf_end = std::min<uint64_t>(next, leaves[leaf].offset + largest_leaf<Build>());
    if (leaf_end - begin > kNvdbChunkBytes) break;
    end = leaf_end;
  }
  chunk->last = leaf;
  chunk->size = end - begin;
  bytes.read(begin, chunk->buffer.resize(chunk->size));
  return chunk;
}

/// Bytes that a leaf takes, 0 if it says something impossible.
template <class Leaf>
std::size_t leaf_size(const Leaf& leaf) {
  if constexpr (std::is_same_v<typename Leaf::BuildType, nanovdb::FpN>) {
    constexpr int kWidestLog2 = 4;
    return (leaf.mFlags >> 5) <= kWidestLog2 ? leaf.memUsage() : 0;
  } else {
    return sizeof(Leaf);
  }
}

template <class Build>
GridScan take_chunk(const VolumeFile& file, const NvdbChunk& chunk,
                    const std::vector<NodeLocation>& leaves, const GridAssembly& assembly) {
  using Leaf = typename nanovdb::NanoLeaf<Build>::DataType;
  using Value = typename Leaf::ValueType;
  GridScan scan;
  std::array<Value, kLeafVoxels> values;
  for (std::size_t i = chunk.first; i < chunk.last; ++i) {
    const std::size_t offset = leaves[i].offset - leaves[chunk.first].offset;
    const std::size_t left = chunk.size - offset;
    const Leaf& leaf = chunk.buffer.node<Leaf>(offset);
    const std::size_t size = left >= sizeof(Leaf) ? leaf_size(leaf) : 0;
    if (size == 0 || size > left) {
      file.fail_damaged(fmt::format("a leaf at byte {} of its grid", leaves[i].offset));
    }
    for (int voxel = 0; voxel < kLeafVoxels; ++voxel) {
      values[static_cast<std::size_t>(voxel)] = leaf.getValue(static_cast<uint32_t>(voxel));
    }
    uint64_t mask[8];
    static_assert(sizeof(leaf.mValueMask) == sizeof(mask));
    std::memcpy(mask, static_cast<const void*>(&leaf.mValueMask), sizeof(mask));
    assembly.take_leaf(i, values.data(), mask, scan);
  }
  return scan;
}

/// Reads all leaves: one thread reads and uncompresses, all decode.
template <class Build>
GridScan read_leaves(const VolumeFile& file, NvdbBytes& bytes,
                     const std::vector<NodeLocation>& leaves, const GridAssembly& assembly) {
  std::size_t next = 0;
  return scan_chunks<NvdbChunk>(
      [&] {
        auto chunk = read_chunk<Build>(bytes, leaves, next);
        if (chunk) next = chunk->last;
        return chunk;
      },
      [&](const NvdbChunk& chunk) { return take_chunk<Build>(file, chunk, leaves, assembly); });
}

template <class Build>
AssembledGrid read_grid_as(const VolumeFile& file, const NvdbGrid& grid, const GridInfo& info,
                           const LoadOptions& options, bool keep_values) {
  NvdbBytes bytes(file, grid.extent);
  const NvdbHead head = read_nvdb_head(file, grid, bytes);
  TreeWalk<Build> walk(file, bytes);
  walk.read(head.node_offsets[3]);
  AssembledGrid result;
  result.assembly = std::make_unique<GridAssembly>(file.name(), info.name, options,
                                                   std::move(walk.layout), keep_values);
  result.scan = read_leaves<Build>(file, bytes, walk.leaves, *result.assembly);
  return result;
}

using GridReader = AssembledGrid (*)(const VolumeFile&, const NvdbGrid&, const GridInfo&,
                                     const LoadOptions&, bool);

/// The reader for a type of grid, null where there is none.
GridReader reader_of(nanovdb::GridType type) {
  switch (type) {
    case nanovdb::GridType::Float:
      return read_grid_as<float>;
    case nanovdb::GridType::Double:
      return read_grid_as<double>;
    case nanovdb::GridType::Fp4:
      return read_grid_as<nanovdb::Fp4>;
    case nanovdb::GridType::Fp8:
      return read_grid_as<nanovdb::Fp8>;
    case nanovdb::GridType::Fp16:
      return read_grid_as<nanovdb::Fp16>;
    case nanovdb::GridType::FpN:
      return read_grid_as<nanovdb::FpN>;
    case nanovdb::GridType::Vec3f:
      return read_grid_as<nanovdb::Vec3f>;
    case nanovdb::GridType::Vec3d:
      return read_grid_as<nanovdb::Vec3d>;
    case nanovdb::GridType::Int16:
      return read_grid_as<int16_t>;
    case nanovdb::GridType::Int32:
      return read_grid_as<int32_t>;
    case nanovdb::GridType::Int64:
      return read_grid_as<int64_t>;
    case nanovdb::GridType::UInt32:
      return read_grid_as<uint32_t>;
    case nanovdb::GridType::Boolean:
      return read_grid_as<bool>;
    case nanovdb::GridType::Mask:
      return read_grid_as<nanovdb::ValueMask>;
    default:
      return nullptr;
  }
}

/// What the headers tell of each grid, without reading voxels.
std::vector<GridInfo> describe_directory(const VolumeFile& file,
                                         const std::vector<NvdbGrid>& grids) {
  std::vector<GridInfo> infos;
  for (const NvdbGrid& grid : grids) {
    GridInfo info;
    info.name = grid.name;
    info.index = static_cast<int>(infos.size());
    info.type = nvdb_value_type(grid);
    info.grid_class = nvdb_class_name(grid.grid_class);
    info.stored_bytes = grid.extent.stored_size;
    info.channels =
        grid.type == nanovdb::GridType::Vec3f || grid.type == nanovdb::GridType::Vec3d ? 3 : 1;
    NvdbBytes bytes(file, grid.extent);
    info.index_to_world = read_nvdb_head(file, grid, bytes).index_to_world;
    info.reason = reader_of(grid.type) != nullptr ? reason_against_class(info.grid_class)
                                                  : reason_against_type(info.type);
    if (info.reason.empty()) info.reason = reason_against_transform(info.index_to_world);
    info.loadable = info.reason.empty();
    infos.push_back(std::move(info));
  }
  make_names_unique(infos);
  return infos;
}

class NvdbReader : public VolumeReader {
 public:
  explicit NvdbReader(const VolumeFile& file) : file_(file), grids_(read_nvdb_directory(file)) {}

  std::vector<GridInfo> heads() const override { return describe_directory(file_, grids_); }

  bool is_readable(const GridInfo& head) const override {
    return reader_of(grid_of(head).type) != nullptr;
  }

  AssembledGrid read(const GridInfo& head, const LoadOptions& options,
                     bool keep_values) const override {
    const NvdbGrid& grid = grid_of(head);
    return reader_of(grid.type)(file_, grid, head, options, keep_values);
  }

 private:
  const NvdbGrid& grid_of(const GridInfo& head) const {
    return grids_[static_cast<std::size_t>(head.index)];
  }

  const VolumeFile& file_;
  std::vector<NvdbGrid> grids_;
};

}  // namespace

std::unique_ptr<VolumeReader> open_nvdb(const VolumeFile& file) {
  return std::make_unique<NvdbReader>(file);
}

}  // namespace freepath::io
