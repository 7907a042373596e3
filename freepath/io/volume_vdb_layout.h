#pragma once
/// @file The layout of an OpenVDB file: its directory of grids. OpenVDB's own reader trusts the
/// sizes it finds in a file; here each is checked against the file and against what it must be,
/// before the library is given the bytes.
///
/// A file is a header, then for each grid a descriptor and the grid: compression flags, metadata,
/// transform, topology (all masks of the tree and the values of its inner nodes, depth first), and
/// buffers (the values of its leaves, in the same order). A grid that shares the tree of another
/// ends with its transform. A stream has the same parts, but does not say where a grid ends.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/io/volume_file.h"
#include "freepath/io/volume_frustum.h"

namespace freepath::io {

// Versions of the format at which the layout changed.
inline constexpr uint32_t kVdbOldest = 214;  ///< Oldest version with today's root and inner nodes.
inline constexpr uint32_t kVdbInstances = 216;  ///< Trees may be shared; transforms go first.
inline constexpr uint32_t kVdbBoolBits = 217;   ///< Leaves of truth values are bits.
inline constexpr uint32_t kVdbTextUuid = 218;
inline constexpr uint32_t kVdbMaps = 219;       ///< Transforms are maps.
inline constexpr uint32_t kVdbSelective = 220;  ///< The header tells of compression.
inline constexpr uint32_t kVdbNodeCompression =
    222;  ///< Today's nodes; a grid tells of compression.
inline constexpr uint32_t kVdbNewest = 224;

// OpenVDB's flags of compression.
inline constexpr uint32_t kVdbZip = 1, kVdbActiveMask = 2, kVdbBlosc = 4;

/// Where a grid stands, and what its metadata says.
struct VdbGrid {
  std::string name;             ///< Name that the grid was given.
  std::string tree_type;        ///< "Tree_float_5_4_3".
  bool half = false;            ///< Reals are stored in half precision.
  int tree_of = -1;             ///< The grid whose tree this one shares, -1 for its own.
  uint64_t begin = 0, end = 0;  ///< Extent in the file [bytes].
  uint32_t compression = 0;     ///< OpenVDB's flags.
  std::string grid_class;       ///< "fog volume", "level set", "staggered" or "unknown".
  uint64_t body = 0;            ///< Offset of what follows the metadata.
  std::string reason;           ///< Why nothing is known of the grid but its metadata.
};

struct VdbDirectory {
  uint32_t file_version = 0;
  uint32_t library_major = 0, library_minor = 0;
  std::vector<VdbGrid> grids;
};

/// Reads header, descriptors and metadata; of a stream the topology, too, to find where grids end.
/// @throws Error if the file is damaged, or of a version that can't be read
VdbDirectory read_vdb_directory(const VolumeFile& file);

/// "float" of "Tree_float_5_4_3", "points" of a point data tree, the whole name of a tree that
/// isn't 5-4-3.
std::string vdb_value_type(const VdbGrid& grid);

/// The transform of a grid, and where its tree stands.
struct VdbLocation {
  Matrix4d index_to_world;
  uint64_t topology = 0;                   ///< Offset of the tree.
  uint64_t end = 0;                        ///< Where the transform ends in the file.
  std::string reason;                      ///< Why the grid can't be loaded for its transform.
  std::optional<FrustumMap> frustum = {};  ///< A transform that is no affine map.
};

/// Reads the transform of a grid.
VdbLocation read_vdb_location(const VolumeFile& file, const VdbDirectory& directory,
                              const VdbGrid& grid);

}  // namespace freepath::io
