#pragma once
/// @file The layout of a NanoVDB file: its directory of grids and the headers of a grid, checked
/// against the file before they are used.
///
/// A file is a row of segments, each a header, metadata of its grids and the grids, or nothing but
/// grids as they stand in memory. A grid is its
/// header, the tree's header, the root with its tiles, then all upper nodes, all lower nodes and
/// all leaves, which refer to each other by relative offsets. All offsets point forward.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nanovdb/NanoVDB.h>

#include "freepath/base/vector.h"
#include "freepath/io/volume_nvdb_bytes.h"

namespace freepath::io {

/// A grid as the file's metadata announce it.
struct NvdbGrid {
  std::string name;
  nanovdb::GridType type = nanovdb::GridType::Unknown;
  nanovdb::GridClass grid_class = nanovdb::GridClass::Unknown;
  NvdbExtent extent;
};

/// Memory for nodes, aligned as they are in a grid.
struct alignas(NANOVDB_DATA_ALIGNMENT) NodeWords {
  std::byte bytes[NANOVDB_DATA_ALIGNMENT];
};
class NodeBuffer {
 public:
  std::span<std::byte> resize(std::size_t bytes) {
    words_.resize((bytes + sizeof(NodeWords) - 1) / sizeof(NodeWords));
    return {reinterpret_cast<std::byte*>(words_.data()), bytes};
  }
  template <class Node>
  const Node& node(std::size_t offset) const {
    return *reinterpret_cast<const Node*>(reinterpret_cast<const std::byte*>(words_.data()) +
                                          offset);
  }

 private:
  std::vector<NodeWords> words_;
};

/// What the headers of a grid say.
struct NvdbHead {
  Matrix4d index_to_world;
  /// Offsets in the grid of leaves, lower, upper nodes and root.
  std::array<uint64_t, 4> node_offsets{};
};

/// All grids of a file.
/// @throws Error if the file is damaged, or of a version that can't be read
std::vector<NvdbGrid> read_nvdb_directory(const VolumeFile& file);

/// "float", "Fp8", "points", ...
std::string nvdb_value_type(const NvdbGrid& grid);
/// "fog volume", "level set", "staggered" or "unknown".
std::string nvdb_class_name(nanovdb::GridClass grid_class);

/// Reads the headers of a grid and its tree.
/// @throws Error if they contradict the file
NvdbHead read_nvdb_head(const VolumeFile& file, const NvdbGrid& grid, NvdbBytes& bytes);

}  // namespace freepath::io
