#include "freepath/io/volume_vdb_layout.h"

#include <algorithm>
#include <map>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/io/volume_vdb_nodes.h"

namespace freepath::io {
namespace {

constexpr std::size_t kTextUuidBytes = 36, kUuidBytes = 16;
constexpr char kNameSeparator = 0x1e;  // between a grid's name and its number among namesakes

struct Metadata {
  std::string grid_class = "unknown";
  bool half = false;
};

Metadata read_metadata(FileCursor& cursor) {
  Metadata metadata;
  const auto count = cursor.take<uint32_t>();
  for (uint32_t i = 0; i < count; ++i) {
    const std::string key = cursor.take_string();
    const std::string type = cursor.take_string();
    if (key == "class" && type == "string") {
      metadata.grid_class = cursor.take_string();
      continue;
    }
    const auto bytes = cursor.take<uint32_t>();
    if (key == "is_saved_as_half_float" && type == "bool" && bytes == 1) {
      metadata.half = cursor.take<uint8_t>() != 0;
    } else {
      cursor.skip(bytes);
    }
  }
  return metadata;
}

/// What stands in front of a grid.
struct Descriptor {
  std::string unique_name, parent;
  int64_t begin = 0, end = 0;
  VdbGrid grid;
};

Descriptor read_descriptor(FileCursor& cursor, uint32_t file_version) {
  Descriptor read;
  VdbGrid& grid = read.grid;
  read.unique_name = cursor.take_string();
  grid.name = read.unique_name.substr(0, read.unique_name.find(kNameSeparator));
  grid.tree_type = cursor.take_string();
  constexpr std::string_view kHalfSuffix = "_HalfFloat";
  if (grid.tree_type.ends_with(kHalfSuffix)) {
    grid.tree_type.resize(grid.tree_type.size() - kHalfSuffix.size());
    grid.half = true;
  }
  if (file_version >= kVdbInstances) read.parent = cursor.take_string();
  read.begin = cursor.take<int64_t>();
  cursor.take<int64_t>();  // where the buffers begin: 0 for a shared tree, and nobody asks for it
  read.end = cursor.take<int64_t>();
  return read;
}

/// Takes the extent of a grid that the descriptor tells.
void take_extent(const FileCursor& cursor, Descriptor& descriptor) {
  const auto size = static_cast<int64_t>(cursor.file().size());
  const auto [begin, end] = std::pair(descriptor.begin, descriptor.end);
  if (begin < static_cast<int64_t>(cursor.offset()) || end < begin || end > size) {
    cursor.file().fail_damaged(fmt::format("grid \"{}\" should stand at bytes {} to {} of {}",
                                           descriptor.grid.name, begin, end, size));
  }
  descriptor.grid.begin = static_cast<uint64_t>(begin);
  descriptor.grid.end = static_cast<uint64_t>(end);
}

/// @param archive flags of compression that hold for grids which don't tell
void read_grid_head(FileCursor& cursor, uint32_t file_version, uint32_t archive, VdbGrid& grid) {
  cursor.seek(grid.begin);
  grid.compression = file_version >= kVdbNodeCompression ? cursor.take<uint32_t>() : archive;
  if ((grid.compression & ~(kVdbZip | kVdbActiveMask | kVdbBlosc)) != 0) {
    cursor.file().fail_damaged(
        fmt::format("grid \"{}\" has unknown compression {}", grid.name, grid.compression));
  }
  const Metadata metadata = read_metadata(cursor);
  grid.grid_class = metadata.grid_class;
  grid.half = grid.half || metadata.half;
  grid.body = cursor.offset();
}

struct Header {
  bool has_offsets = true;
  uint32_t compression = kVdbZip;
  uint32_t grids = 0;
};

Header read_header(FileCursor& cursor, VdbDirectory& directory) {
  cursor.skip(8);  // the magic number
  directory.file_version = cursor.take<uint32_t>();
  const std::string& name = cursor.file().name();
  if (directory.file_version < kVdbOldest) {
    fail("{}: OpenVDB file version {} is older than OpenVDB 1; save it again with a newer program",
         name, directory.file_version);
  }
  if (directory.file_version > kVdbNewest) {
    fail("{}: OpenVDB file version {} is newer than this program can read (up to {})", name,
         directory.file_version, kVdbNewest);
  }
  Header header;
  directory.library_major = cursor.take<uint32_t>();
  directory.library_minor = cursor.take<uint32_t>();
  header.has_offsets = cursor.take<uint8_t>() != 0;
  if (directory.file_version >= kVdbSelective && directory.file_version < kVdbNodeCompression) {
    header.compression = cursor.take<uint8_t>() != 0 ? kVdbZip : 0;
  }
  cursor.skip(directory.file_version >= kVdbTextUuid ? kTextUuidBytes : kUuidBytes);
  read_metadata(cursor);
  header.grids = cursor.take<uint32_t>();
  return header;
}

/// Finds where a grid of a stream ends, by reading all that comes before.
/// @return false if that can't be told
bool find_end(FileCursor& cursor, const VdbDirectory& directory, VdbGrid& grid) {
  const auto format = vdb_value_format(directory, grid);
  if (!format && grid.tree_of < 0) {
    grid.end = cursor.file().size();
    grid.reason = fmt::format(
        "the file is a stream, in which neither the end of a grid of type {} nor what is behind it "
        "can be found; save it as a file (openvdb::io::File)",
        vdb_value_type(grid));
    return false;
  }
  const VdbLocation location = read_vdb_location(cursor.file(), directory, grid);
  if (location.end == 0) {
    grid.end = cursor.file().size();
    grid.reason = location.reason;
    return false;
  }
  uint64_t end = location.end;
  if (grid.tree_of < 0) {
    const VdbTreeEnds tree = skip_vdb_topology(cursor.file(), location.topology, *format);
    cursor.seek(std::max(tree.end, end));
    for (uint64_t leaf = 0; leaf < tree.leaves; ++leaf) cursor.skip(vdb_leaf_size(cursor, *format));
    end = cursor.offset();
  }
  cursor.seek(end);
  grid.end = end;
  return true;
}

}  // namespace

VdbDirectory read_vdb_directory(const VolumeFile& file) {
  FileCursor cursor(file, 0);
  VdbDirectory directory;
  const Header header = read_header(cursor, directory);
  std::map<std::string, int> numbers;
  for (uint32_t i = 0; i < header.grids; ++i) {
    Descriptor descriptor = read_descriptor(cursor, directory.file_version);
    VdbGrid& grid = descriptor.grid;
    if (!descriptor.parent.empty()) {
      const auto found = numbers.find(descriptor.parent);
      if (found == numbers.end()) {
        file.fail_damaged(
            fmt::format("grid \"{}\" shares the tree of a grid that isn't there", grid.name));
      }
      const int shared = directory.grids[static_cast<std::size_t>(found->second)].tree_of;
      grid.tree_of = shared >= 0 ? shared : found->second;
    }
    numbers.emplace(descriptor.unique_name, static_cast<int>(i));
    if (header.has_offsets) {
      take_extent(cursor, descriptor);
    } else {
      grid.begin = cursor.offset();
    }
    read_grid_head(cursor, directory.file_version, header.compression, grid);
    const bool goes_on = header.has_offsets || find_end(cursor, directory, grid);
    cursor.seek(grid.end);
    directory.grids.push_back(std::move(grid));
    if (!goes_on) break;
  }
  return directory;
}

std::string vdb_value_type(const VdbGrid& grid) {
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

}  // namespace freepath::io
