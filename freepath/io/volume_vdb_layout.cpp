#include "freepath/io/volume_vdb_layout.h"

#include <algorithm>

#include "freepath/base/error.h"

namespace freepath::io {
namespace {

constexpr uint32_t kOldestVersion = 222;  // the first with today's layout of nodes
constexpr uint32_t kNewestVersion = 224;
constexpr std::size_t kUuidBytes = 36;
constexpr char kNameSeparator = 0x1e;  // between a grid's name and its number among namesakes

// OpenVDB's flags of compression.
constexpr uint32_t kZip = 1, kActiveMask = 2, kBlosc = 4;

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

VdbGrid read_descriptor(FileCursor& cursor, std::string& unique_name, std::string& parent) {
  VdbGrid grid;
  unique_name = cursor.take_string();
  grid.name = unique_name.substr(0, unique_name.find(kNameSeparator));
  grid.tree_type = cursor.take_string();
  constexpr std::string_view kHalfSuffix = "_HalfFloat";
  if (grid.tree_type.ends_with(kHalfSuffix)) {
    grid.tree_type.resize(grid.tree_type.size() - kHalfSuffix.size());
    grid.half = true;
  }
  parent = cursor.take_string();
  const auto begin = cursor.take<int64_t>();
  const auto blocks = cursor.take<int64_t>();
  const auto end = cursor.take<int64_t>();
  const auto size = static_cast<int64_t>(cursor.file().size());
  if (begin < static_cast<int64_t>(cursor.offset()) || blocks < begin || end < blocks ||
      end > size) {
    cursor.file().fail_damaged(fmt::format("grid \"{}\" should stand at bytes {} to {} of {}",
                                           grid.name, begin, end, size));
  }
  grid.begin = static_cast<uint64_t>(begin);
  grid.end = static_cast<uint64_t>(end);
  return grid;
}

void read_grid_head(FileCursor& cursor, VdbGrid& grid) {
  cursor.seek(grid.begin);
  grid.compression = cursor.take<uint32_t>();
  if ((grid.compression & ~(kZip | kActiveMask | kBlosc)) != 0) {
    cursor.file().fail_damaged(
        fmt::format("grid \"{}\" has unknown compression {}", grid.name, grid.compression));
  }
  const Metadata metadata = read_metadata(cursor);
  grid.grid_class = metadata.grid_class;
  grid.half = grid.half || metadata.half;
  grid.transform = cursor.offset();
  grid.transform_type = cursor.take_string();
}

uint32_t read_header(FileCursor& cursor, VdbDirectory& directory) {
  cursor.skip(8);  // the magic number
  directory.file_version = cursor.take<uint32_t>();
  const std::string& name = cursor.file().name();
  if (directory.file_version < kOldestVersion) {
    fail("{}: OpenVDB file version {} is older than OpenVDB 3; save it again with a newer program",
         name, directory.file_version);
  }
  if (directory.file_version > kNewestVersion) {
    fail("{}: OpenVDB file version {} is newer than this program can read (up to {})", name,
         directory.file_version, kNewestVersion);
  }
  directory.library_major = cursor.take<uint32_t>();
  directory.library_minor = cursor.take<uint32_t>();
  const bool has_offsets = cursor.take<uint8_t>() != 0;
  cursor.skip(kUuidBytes);
  read_metadata(cursor);
  if (!has_offsets) {
    fail(
        "{}: it was written as a stream, without a directory of its grids; save it as a file "
        "(openvdb::io::File)",
        name);
  }
  return cursor.take<uint32_t>();
}

uint32_t word_at(std::span<const std::byte> bytes, std::size_t offset) {
  uint32_t word;
  std::memcpy(&word, bytes.data() + offset, sizeof(word));
  return word;
}

}  // namespace

VdbDirectory read_vdb_directory(const VolumeFile& file) {
  FileCursor cursor(file, 0);
  VdbDirectory directory;
  const uint32_t count = read_header(cursor, directory);
  std::map<std::string, int> places;
  for (uint32_t i = 0; i < count; ++i) {
    std::string unique_name, parent;
    VdbGrid grid = read_descriptor(cursor, unique_name, parent);
    if (!parent.empty()) {
      const auto found = places.find(parent);
      if (found == places.end()) {
        file.fail_damaged(
            fmt::format("grid \"{}\" shares the tree of a grid that isn't there", grid.name));
      }
      const int shared = directory.grids[static_cast<std::size_t>(found->second)].tree_of;
      grid.tree_of = shared >= 0 ? shared : found->second;
    }
    places.emplace(unique_name, static_cast<int>(i));
    read_grid_head(cursor, grid);
    cursor.seek(grid.end);
    directory.grids.push_back(std::move(grid));
  }
  return directory;
}

uint64_t vdb_value_block(FileCursor& cursor, uint64_t ahead, const VdbValueFormat& format,
                         uint64_t count, uint64_t active) {
  const VolumeFile& file = cursor.file();
  // First a byte on how inactive values are stored: not at all, one or two of them with or without
  // a mask that tells which is where, or all in full.
  const auto kind = static_cast<uint8_t>(cursor.peek(ahead, 1)[0]);
  if (kind > 6) file.fail_damaged(fmt::format("a node at byte {}", cursor.offset() + ahead));
  uint64_t size = 1;
  if (kind == 2 || kind == 4) size += format.value_size;
  if (kind == 5) size += 2 * format.value_size;
  if (kind >= 3 && kind <= 5) size += count / 8;
  const bool active_only = (format.compression & kActiveMask) != 0 && kind != 6;
  const uint64_t stored = active_only ? active : count;
  const auto bytes = static_cast<int64_t>(stored * format.stored_size);
  if (stored == 0 && format.stored_size != format.value_size) return size;
  if ((format.compression & (kZip | kBlosc)) == 0) {
    size += static_cast<uint64_t>(bytes);
  } else {
    // Then the size of the compressed values, or minus the size of uncompressed ones.
    int64_t length;
    std::memcpy(&length, cursor.peek(ahead + size, sizeof(length)).data(), sizeof(length));
    size += sizeof(length);
    constexpr int64_t kOverhead = 64;
    bool sound = length <= 0 ? length == -bytes : length <= bytes + kOverhead;
    if (sound && length > 0 && (format.compression & kBlosc) != 0) {
      constexpr std::size_t kBloscHeader = 16;
      const auto header = cursor.peek(ahead + size, kBloscHeader);
      sound = length >= static_cast<int64_t>(kBloscHeader) && word_at(header, 4) == bytes &&
              word_at(header, 12) == length;
    }
    if (!sound) {
      file.fail_damaged(
          fmt::format("the size of the values at byte {} is impossible", cursor.offset() + ahead));
    }
    size += static_cast<uint64_t>(length < 0 ? -length : length);
  }
  file.require(cursor.offset() + ahead, size);
  return size;
}

}  // namespace freepath::io
