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
struct NodePlace {
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

  TreeWalk(const VolumeFile& file, NvdbBytes& bytes) : file_(&file), bytes_(&bytes) {}

  GridLayout layout{ValueChannels<decltype(Root::mBackground)>::kCount};
  std::vector<NodePlace> leaves;  ///< In the order of the file, as in the layout.

  void read(uint64_t root_offset) {
    std::vector<NodePlace> upper = read_root(root_offset);
    sort_level(upper, sizeof(Upper));
    std::vector<NodePlace> lower;
    for (const NodePlace& place : upper) read_node<Upper, 32, 128>(place, lower);
    sort_level(lower, sizeof(Lower));
    for (const NodePlace& place : lower) read_node<Lower, 16, 8>(place, leaves);
    sort_level(leaves, 1);
    for (const NodePlace& leaf : leaves) layout.add_leaf(leaf.origin);
  }

 private:
  std::vector<NodePlace> read_root(uint64_t offset) {
    check_alignment(offset);
    bytes_->read(offset, buffer_.resize(sizeof(Root)));
    const uint32_t count = buffer_.node<Root>(0).mTableSize;
    layout.set_background(buffer_.node<Root>(0).mBackground);
    end_ = offset + sizeof(Root);
    std::vector<NodePlace> children;
    using Tile = typename Root::Tile;
    for (uint32_t i = 0; i < count; ++i) {
      bytes_->read(end_, buffer_.resize(sizeof(Tile)));
      end_ += sizeof(Tile);
      const Tile& tile = buffer_.node<Tile>(0);
      const nanovdb::Coord corner = tile.origin();
      const Vec3i origin(corner[0], corner[1], corner[2]);
      if (tile.isChild()) {
        children.push_back({offset + static_cast<uint64_t>(tile.child), origin});
      } else if (tile.state != 0) {
        layout.add_tile(origin, 4096, tile.value);
      }
    }
    return children;
  }

  template <class Node, int kSide, int kEntrySize>
  void read_node(const NodePlace& place, std::vector<NodePlace>& children) {
    bytes_->read(place.offset, buffer_.resize(sizeof(Node)));
    const Node& node = buffer_.node<Node>(0);
    for (int entry = 0; entry < kSide * kSide * kSide; ++entry) {
      const bool child = node.mChildMask.isOn(entry);
      if (!child && !node.mValueMask.isOn(entry)) continue;
      const Vec3i origin =
          place.origin +
          Vec3i(entry / (kSide * kSide), entry / kSide % kSide, entry % kSide) * kEntrySize;
      if (child) {
        children.push_back(
            {place.offset + static_cast<uint64_t>(node.mTable[entry].child), origin});
      } else {
        layout.add_tile(origin, kEntrySize, node.mTable[entry].value);
      }
    }
  }

  void check_alignment(uint64_t offset) const {
    if (offset % NANOVDB_DATA_ALIGNMENT != 0) {
      file_->fail_damaged(fmt::format("a node at byte {} of its grid", offset));
    }
  }

  /// Orders the nodes of a level as they stand in the file; they must not overlap each other or
  /// what was read before.
  void sort_level(std::vector<NodePlace>& nodes, uint64_t node_size) {
    std::sort(nodes.begin(), nodes.end(),
              [](const NodePlace& a, const NodePlace& b) { return a.offset < b.offset; });
    for (const NodePlace& node : nodes) {
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
std::shared_ptr<NvdbChunk> read_chunk(NvdbBytes& bytes, const std::vector<NodePlace>& leaves,
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
                    const std::vector<NodePlace>& leaves, const GridAssembly& assembly) {
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
GridScan read_leaves(const VolumeFile& file, NvdbBytes& bytes, const std::vector<NodePlace>& leaves,
                     const GridAssembly& assembly) {
  std::size_t next = 0;
  return scan_chunks<NvdbChunk>(
      [&] {
        auto chunk = read_chunk<Build>(bytes, leaves, next);
        if (chunk) next = chunk->last;
        return chunk;
      },
      [&](const NvdbChunk& chunk) { return take_chunk<Build>(file, chunk, leaves, assembly); });
}

struct ReadNvdbGrid {
  std::unique_ptr<GridAssembly> assembly;
  GridScan scan;
};

template <class Build>
ReadNvdbGrid read_grid_as(const VolumeFile& file, const NvdbGrid& grid, const GridInfo& info,
                          const LoadOptions& options, bool keep_values) {
  NvdbBytes bytes(file, grid.extent);
  const NvdbHead head = read_nvdb_head(file, grid, bytes);
  TreeWalk<Build> walk(file, bytes);
  walk.read(head.node_offsets[3]);
  ReadNvdbGrid result;
  result.assembly = std::make_unique<GridAssembly>(file.name(), info.name, options,
                                                   std::move(walk.layout), keep_values);
  result.scan = read_leaves<Build>(file, bytes, walk.leaves, *result.assembly);
  return result;
}

using GridReader = ReadNvdbGrid (*)(const VolumeFile&, const NvdbGrid&, const GridInfo&,
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
    info.channels = grid.type == nanovdb::GridType::Vec3f ? 3 : 1;
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

}  // namespace

std::vector<GridInfo> list_nvdb_grids(const VolumeFile& file) {
  const std::vector<NvdbGrid> grids = read_nvdb_directory(file);
  std::vector<GridInfo> infos = describe_directory(file, grids);
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const GridReader read = reader_of(grids[i].type);
    if (read == nullptr) continue;
    try {
      const ReadNvdbGrid result = read(file, grids[i], infos[i], {}, false);
      result.assembly->describe(result.scan, infos[i]);
    } catch (const std::exception& error) {
      set_failure(file.name(), error.what(), infos[i]);
    }
  }
  return infos;
}

std::vector<LoadedField> load_nvdb_fields(const VolumeFile& file, const LoadOptions& options) {
  const std::vector<NvdbGrid> grids = read_nvdb_directory(file);
  const std::vector<GridInfo> infos = describe_directory(file, grids);
  const GridInfo& info = find_grid(file.name(), infos, options.selection);
  check_selected(file.name(), info, options);
  const NvdbGrid& grid = grids[static_cast<std::size_t>(info.index)];
  ReadNvdbGrid result = reader_of(grid.type)(file, grid, info, options, true);
  return std::move(*result.assembly).finish(info, result.scan);
}

}  // namespace freepath::io
