#include "freepath/io/volume_nvdb_layout.h"

#include <cstring>

#include <nanovdb/util/IO.h>

#include "freepath/base/error.h"

namespace freepath::io {
namespace {

constexpr uint64_t kBareGridMagic = 0x314244566f6e614eULL;  // "NanoVDB1"
constexpr uint64_t kFileMagic = 0x324244566f6e614eULL;      // "NanoVDB2", of later 32.x

void check_version(const VolumeFile& file, nanovdb::Version version) {
  if (version.getMajor() != NANOVDB_MAJOR_VERSION_NUMBER) {
    fail("{}: NanoVDB version {}.{} can't be read, only {}.x; convert it again", file.name(),
         version.getMajor(), version.getMinor(), NANOVDB_MAJOR_VERSION_NUMBER);
  }
}

nanovdb::io::Header take_segment_header(FileCursor& cursor) {
  const VolumeFile& file = cursor.file();
  const auto header = cursor.take<nanovdb::io::Header>();
  if (header.magic == nanovdb::io::reverseEndianness(NANOVDB_MAGIC_NUMBER)) {
    fail("{}: it was written by a big-endian machine; convert it again", file.name());
  }
  if (header.magic != NANOVDB_MAGIC_NUMBER && header.magic != kFileMagic) {
    file.fail_damaged(
        fmt::format("no segment begins at byte {}", cursor.offset() - sizeof(header)));
  }
  check_version(file, header.version);
  return header;
}

NvdbGrid take_metadata(FileCursor& cursor, NvdbCodec codec) {
  const VolumeFile& file = cursor.file();
  const auto metadata = cursor.take<nanovdb::io::MetaData>();
  constexpr uint32_t kLongestName = 1 << 16;
  const uint32_t length = metadata.nameSize;
  if (length > kLongestName) file.fail_damaged(fmt::format("a name of {} bytes", length));
  const auto* const name = reinterpret_cast<const char*>(cursor.peek(0, length).data());
  NvdbGrid grid;
  grid.name.assign(name, strnlen(name, length));
  grid.type = metadata.gridType;
  grid.grid_class = metadata.gridClass;
  grid.extent = {codec, 0, metadata.fileSize, metadata.gridSize};
  if (codec == NvdbCodec::kNone && metadata.fileSize != metadata.gridSize) {
    file.fail_damaged(fmt::format("grid \"{}\" has two sizes", grid.name));
  }
  cursor.skip(length);
  return grid;
}

/// Whether a file is the memory of grids. In early versions it begins with the same word as a file
/// of segments, whose header goes on with a version, where a grid has a checksum.
bool is_grid_memory(const VolumeFile& file) {
  if (file.size() < sizeof(nanovdb::GridData)) return false;
  FileCursor cursor(file, 0);
  const auto header = cursor.take<nanovdb::io::Header>();
  if (header.magic == kBareGridMagic) return true;
  if (header.magic != NANOVDB_MAGIC_NUMBER) return false;
  if (header.version.getMajor() == NANOVDB_MAJOR_VERSION_NUMBER) return false;
  NodeBuffer buffer;
  file.read(0, buffer.resize(sizeof(nanovdb::GridData)));
  const auto& data = buffer.node<nanovdb::GridData>(0);
  return data.mVersion.getMajor() == NANOVDB_MAJOR_VERSION_NUMBER &&
         data.mGridSize >= sizeof(data) && data.mGridSize <= file.size();
}

/// The grids of a file that is the memory of one or several.
std::vector<NvdbGrid> read_grid_memory(const VolumeFile& file) {
  std::vector<NvdbGrid> grids;
  NodeBuffer buffer;
  uint32_t count = 1;
  for (uint64_t offset = 0; grids.size() < count;) {
    file.read(offset, buffer.resize(sizeof(nanovdb::GridData)));
    const auto& data = buffer.node<nanovdb::GridData>(0);
    check_version(file, data.mVersion);
    if (data.mGridSize < sizeof(data)) {
      file.fail_damaged(fmt::format("a grid of {} bytes at byte {}", data.mGridSize, offset));
    }
    file.require(offset, data.mGridSize);
    count = data.mGridCount;
    NvdbGrid grid;
    grid.name.assign(data.mGridName, strnlen(data.mGridName, sizeof(data.mGridName)));
    grid.type = data.mGridType;
    grid.grid_class = data.mGridClass;
    grid.extent = {NvdbCodec::kNone, offset, data.mGridSize, data.mGridSize};
    grids.push_back(std::move(grid));
    offset += data.mGridSize;
  }
  return grids;
}

}  // namespace

std::vector<NvdbGrid> read_nvdb_directory(const VolumeFile& file) {
  if (is_grid_memory(file)) return read_grid_memory(file);
  std::vector<NvdbGrid> grids;
  FileCursor cursor(file, 0);
  while (cursor.offset() < file.size()) {
    const auto header = take_segment_header(cursor);
    const auto codec = static_cast<uint16_t>(header.codec);
    if (codec > static_cast<uint16_t>(NvdbCodec::kBlosc)) {
      file.fail_damaged(fmt::format("codec {} is unknown", codec));
    }
    const std::size_t first = grids.size();
    for (int i = 0; i < header.gridCount; ++i) {
      grids.push_back(take_metadata(cursor, static_cast<NvdbCodec>(codec)));
    }
    for (std::size_t i = first; i < grids.size(); ++i) {
      grids[i].extent.begin = cursor.offset();
      cursor.skip(grids[i].extent.stored_size);
    }
  }
  return grids;
}

std::string nvdb_value_type(const NvdbGrid& grid) {
  using nanovdb::GridClass, nanovdb::GridType;
  const GridClass grid_class = grid.grid_class;
  if (grid_class == GridClass::PointIndex || grid_class == GridClass::PointData) return "points";
  static constexpr std::array kNames{
      "unknown", "float", "double", "int16", "int32", "int64", "vec3f", "vec3d", "mask", "half",
      "uint32", "bool", "rgba8", "Fp4", "Fp8", "Fp16", "FpN", "vec4f", "vec4d", "index",
      // Of later 32.x: values, masks of values and points by their index.
      "index", "index", "index", "points"};
  const auto type = static_cast<std::size_t>(grid.type);
  return type < kNames.size() ? kNames[type] : fmt::format("number {}", type);
}

std::string nvdb_class_name(nanovdb::GridClass grid_class) {
  switch (grid_class) {
    case nanovdb::GridClass::LevelSet:
      return "level set";
    case nanovdb::GridClass::FogVolume:
      return "fog volume";
    case nanovdb::GridClass::Staggered:
      return "staggered";
    default:
      return "unknown";
  }
}

NvdbHead read_nvdb_head(const VolumeFile& file, const NvdbGrid& grid, NvdbBytes& bytes) {
  using nanovdb::GridData, nanovdb::TreeData;
  NodeBuffer buffer;
  bytes.read(0, buffer.resize(sizeof(GridData) + sizeof(TreeData<3>)));
  const auto& data = buffer.node<GridData>(0);
  const auto& tree = buffer.node<TreeData<3>>(sizeof(GridData));
  const bool known = data.mMagic == NANOVDB_MAGIC_NUMBER || data.mMagic == kBareGridMagic;
  if (!known || data.mGridSize != bytes.size() || data.mGridType != grid.type) {
    file.fail_damaged(fmt::format("the header of grid \"{}\" contradicts the file's", grid.name));
  }
  check_version(file, data.mVersion);
  NvdbHead head;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      head.index_to_world[row][column] = data.mMap.mMatD[3 * column + row];
    }
    head.index_to_world[3][row] = data.mMap.mVecD[row];
  }
  for (int level = 0; level < 4; ++level) {
    const uint64_t offset = tree.mNodeOffset[level];
    if (offset > bytes.size()) {
      file.fail_damaged(
          fmt::format("grid \"{}\" refers to byte {} of {}", grid.name, offset, bytes.size()));
    }
    head.node_offsets[level] = sizeof(GridData) + offset;
  }
  return head;
}

}  // namespace freepath::io
