#pragma once
/// @file The layout of an OpenVDB file: its directory of grids, and the extent of every block of
/// values. OpenVDB's own reader trusts the sizes it finds in a file; here each is checked against
/// the file and against what it must be, before the library is given the bytes.
///
/// A file is a header, then for each grid a descriptor and the grid: compression flags, metadata,
/// transform, topology (all masks of the tree and the values of its inner nodes, depth first), and
/// buffers (the values of its leaves, in the same order).

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "freepath/io/volume_file.h"

namespace freepath::io {

/// Where a grid stands, and what its metadata says.
struct VdbGrid {
  std::string name;             ///< As the grid was named.
  std::string tree_type;        ///< "Tree_float_5_4_3".
  bool half = false;            ///< Reals are stored in half precision.
  int tree_of = -1;             ///< The grid whose tree this one shares, -1 for its own.
  uint64_t begin = 0, end = 0;  ///< Extent in the file [bytes].
  uint32_t compression = 0;     ///< OpenVDB's flags.
  std::string grid_class;       ///< "fog volume", "level set", "staggered" or "unknown".
  uint64_t transform = 0;       ///< Offset of the transform; the topology follows it.
  std::string transform_type;   ///< "UniformScaleMap", ...
};

struct VdbDirectory {
  uint32_t file_version = 0;
  uint32_t library_major = 0, library_minor = 0;
  std::vector<VdbGrid> grids;
};

/// Reads header, descriptors and metadata.
/// @throws Error if the file is damaged, or older than OpenVDB 3
VdbDirectory read_vdb_directory(const VolumeFile& file);

/// How the values of a node are stored.
struct VdbValueFormat {
  uint32_t compression = 0;
  std::size_t value_size = 4;   ///< Of a value in memory [bytes].
  std::size_t stored_size = 4;  ///< Of a value in the file [bytes], 2 for half.
};

/// Bytes that a node's block of values takes at the cursor, all its sizes checked.
/// @param ahead where the block begins, relative to the cursor
/// @param count how many values the node has
/// @param active how many of them are active
/// @throws Error if the block contradicts itself or the file ends before it does
uint64_t vdb_value_block(FileCursor& cursor, uint64_t ahead, const VdbValueFormat& format,
                         uint64_t count, uint64_t active);

}  // namespace freepath::io
