#include "freepath/io/volume_write.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include "freepath/base/error.h"
#include "freepath/base/version.h"
#include "freepath/io/content_digest.h"
#include "freepath/io/volume_text.h"
#include "freepath/io/volume_vdb_layout.h"
#include "freepath/io/volume_write_grid.h"

namespace freepath {
namespace {

using openvdb::FloatGrid;
using Leaf = FloatGrid::TreeType::LeafNodeType;

openvdb::math::Transform::Ptr transform_of(const Field& field) {
  openvdb::Mat4d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      matrix(row, column) = field.index_to_world[row][column];
    }
  }
  return openvdb::math::Transform::createLinearTransform(matrix);
}

/// Adds one brick, of which 0 is inactive, at its place.
void add_brick(std::span<const float> voxels, const openvdb::Coord& origin,
               FloatGrid::TreeType& tree) {
  if (voxels[0] != 0 && std::ranges::all_of(voxels, [&](float v) { return v == voxels[0]; })) {
    tree.addTile(1, origin, voxels[0], true);
    return;
  }
  auto* const leaf = tree.touchLeaf(origin);
  for (openvdb::Index offset = 0; offset < Leaf::SIZE; ++offset) {
    if (voxels[offset] != 0) leaf->setValueOn(offset, voxels[offset]);
  }
}

/// Puts a name of the contents where OpenVDB writes a random one, so that the same fields give the
/// same bytes.
void name_by_contents(const std::filesystem::path& path) {
  constexpr std::streamoff kOffset = 21;  // behind magic number, versions and a flag
  std::string name = "00000000-0000-0000-0000-000000000000";
  const auto write = [&] {
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(kOffset);
    file.write(name.data(), static_cast<std::streamsize>(name.size()));
    file.close();
    if (!file) fail("{}", std::generic_category().message(errno));
  };
  write();
  ContentDigest digest;
  digest.add_file(path.string());
  const std::string digits = digest.hex();
  auto digit = digits.begin();
  for (char& c : name) {
    if (c != '-') c = *digit++;
  }
  write();
}

void write_grids(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids) {
  openvdb::io::File file(path.string());
  file.setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
  openvdb::MetaMap metadata;
  metadata.insertMeta("creator", openvdb::StringMetadata(fmt::format("freepath {}", version())));
  file.write(grids, metadata);
  file.close();
  name_by_contents(path);
  // OpenVDB doesn't look whether the last bytes reached the disk; a full one cuts the file short.
  try {
    io::read_vdb_directory(io::VolumeFile(path));
  } catch (const Error&) {
    fail("it came out cut short; is the disk full, or the size of files limited?");
  }
}

}  // namespace

namespace io {

openvdb::FloatGrid::Ptr openvdb_grid_of(const Field& field) {
  auto grid = FloatGrid::create(0.0F);
  grid->setName(field.name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setTransform(transform_of(field));
  const BrickMap& map = field.voxels;
  map.for_each_brick([&](const PlacedBrick& placed) {
    const Vec3i origin = placed.coord * BrickMap::kBrickSize;
    add_brick(map.voxels().subspan(std::size_t{placed.brick} * BrickMap::kBrickVoxels,
                                   BrickMap::kBrickVoxels),
              openvdb::Coord(origin.x, origin.y, origin.z), grid->tree());
  });
  return grid;
}

}  // namespace io

void write_vdb(const std::filesystem::path& path, std::span<const Field* const> fields,
               const VdbWriteOptions& options) {
  AtomicFile file(path.string());
  write_vdb(file, fields, options);
}

void write_vdb(AtomicFile& file, std::span<const Field* const> fields,
               const VdbWriteOptions& options) {
  if (fields.empty()) fail("{}: there is no field to write", file.path());
  openvdb::initialize();
  try {
    openvdb::GridCPtrVec grids;
    for (const Field* field : fields) {
      const auto grid = io::openvdb_grid_of(*field);
      grid->setSaveFloatAsHalf(options.half);
      grids.push_back(grid);
    }
    write_grids(file.name(), grids);
  } catch (const std::exception& error) {
    file.give_up(error.what());
  }
  file.replace_target();
}

VolumeFormat volume_format(const std::string& path) {
  const std::string extension = io::lower_case(std::filesystem::path(path).extension().string());
  if (extension == ".vdb") return VolumeFormat::kVdb;
  if (extension == ".nvdb") return VolumeFormat::kNvdb;
  if (extension == ".vti") return VolumeFormat::kVti;
  fail("{}: can't write volumes with the extension \"{}\"; use .vdb, .nvdb or .vti", path,
       extension);
}

void write_volume(AtomicFile& file, std::span<const Field* const> fields,
                  const VdbWriteOptions& options) {
  switch (volume_format(file.path())) {
    case VolumeFormat::kVdb:
      return write_vdb(file, fields, options);
    case VolumeFormat::kNvdb:
      return write_nvdb(file, fields, options);
    case VolumeFormat::kVti:
      break;
  }
  if (options.half) fail("{}: a VTK image holds no halves; write a .vdb or .nvdb", file.path());
  write_vti(file, fields);
}

}  // namespace freepath
