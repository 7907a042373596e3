#include "tests/io/volume_files.h"

#include <unistd.h>

#include <fstream>
#include <iterator>
#include <type_traits>

#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>

namespace freepath::testing_volumes {
namespace {

/// The value of a grid where three make a vector, or itself.
template <class Value>
Value value_of_channels(const std::array<double, 3>& channels) {
  if constexpr (std::is_arithmetic_v<Value>) {
    return static_cast<Value>(channels[0]);
  } else {
    using Real = typename Value::ValueType;
    return Value(static_cast<Real>(channels[0]), static_cast<Real>(channels[1]),
                 static_cast<Real>(channels[2]));
  }
}

/// A grid of reals made of one, or of vectors made of three with the same voxels and tiles.
template <class Grid>
typename Grid::Ptr openvdb_grid(const TestGrid& grid, const TestGrid* y = nullptr,
                                const TestGrid* z = nullptr) {
  using Value = typename Grid::ValueType;
  openvdb::initialize();
  const TestGrid& second = y != nullptr ? *y : grid;
  const TestGrid& third = z != nullptr ? *z : grid;
  auto made = Grid::create(
      value_of_channels<Value>({grid.background, second.background, third.background}));
  made->setName(grid.name);
  made->setGridClass(grid.level_set ? openvdb::GRID_LEVEL_SET : openvdb::GRID_FOG_VOLUME);
  openvdb::Mat4d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      matrix(row, column) = grid.index_to_world[row][column];
    }
  }
  made->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
  for (std::size_t i = 0; i < grid.tiles.size(); ++i) {
    const TestTile& tile = grid.tiles[i];
    const openvdb::Index level = tile.size == 8 ? 1 : tile.size == 128 ? 2 : 3;
    made->tree().addTile(
        level, openvdb::Coord(tile.origin.x, tile.origin.y, tile.origin.z),
        value_of_channels<Value>({tile.value, second.tiles[i].value, third.tiles[i].value}), true);
  }
  auto accessor = made->getAccessor();
  for (std::size_t i = 0; i < grid.voxels.size(); ++i) {
    const Voxel& voxel = grid.voxels[i];
    accessor.setValueOn(
        openvdb::Coord(voxel.coord.x, voxel.coord.y, voxel.coord.z),
        value_of_channels<Value>({voxel.value, second.voxels[i].value, third.voxels[i].value}));
  }
  return made;
}

void write_openvdb(const std::filesystem::path& path, const openvdb::GridPtrVec& grids,
                   Codec codec) {
  openvdb::io::File file(path.string());
  uint32_t flags = openvdb::io::COMPRESS_ACTIVE_MASK;
  if (codec == Codec::kZip) flags |= openvdb::io::COMPRESS_ZIP;
  if (codec == Codec::kBlosc) flags |= openvdb::io::COMPRESS_BLOSC;
  file.setCompression(flags);
  file.write(grids);
  file.close();
}

nanovdb::GridHandle<> nanovdb_grid(const TestGrid& grid, NvdbValues values) {
  if (values == NvdbValues::kDouble) {
    return nanovdb::openToNanoVDB(*openvdb_grid<openvdb::DoubleGrid>(grid));
  }
  const auto source = openvdb_grid<openvdb::FloatGrid>(grid);
  using nanovdb::HostBuffer, nanovdb::openToNanoVDB, openvdb::FloatTree;
  switch (values) {
    case NvdbValues::kFp4:
      return openToNanoVDB<HostBuffer, FloatTree, nanovdb::Fp4>(*source);
    case NvdbValues::kFp8:
      return openToNanoVDB<HostBuffer, FloatTree, nanovdb::Fp8>(*source);
    case NvdbValues::kFp16:
      return openToNanoVDB<HostBuffer, FloatTree, nanovdb::Fp16>(*source);
    case NvdbValues::kFpN:
      return openToNanoVDB<HostBuffer, FloatTree, nanovdb::FpN>(*source);
    default:
      return openToNanoVDB(*source);
  }
}

nanovdb::io::Codec nanovdb_codec(Codec codec) {
  return codec == Codec::kZip     ? nanovdb::io::Codec::ZIP
         : codec == Codec::kBlosc ? nanovdb::io::Codec::BLOSC
                                  : nanovdb::io::Codec::NONE;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "freepath_test_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Bytes read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_bytes(const std::filesystem::path& path, const Bytes& bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::string error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no error was thrown";
  return {};
}

TestGrid sample_grid() {
  TestGrid grid;
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) {
      for (int z = 0; z < 8; ++z) {
        grid.voxels.push_back({Vec3i(x - 8, y, z + 16), 0.01 * x + 0.1 * y + z + 0.003});
      }
    }
  }
  for (const Vec3i& coord : {Vec3i(-20, -3, 7), Vec3i(-19, -3, 7), Vec3i(40, 41, -42),
                             Vec3i(5, 5, 5), Vec3i(130, -1, 0)}) {
    grid.voxels.push_back({coord, 0.25 + 0.125 * (coord.x & 3)});
  }
  grid.tiles = {{Vec3i(64, 64, 64), 8, 0.75}, {Vec3i(-128, 0, 0), 128, 0.5}};
  // A voxel inside the tile's cube would split the tile, so the full leaf moves out of it.
  for (Voxel& voxel : grid.voxels) {
    if (voxel.coord.x < 0 && voxel.coord.y >= 0) voxel.coord.y += 256;
  }
  return grid;
}

double value_of(const TestGrid& grid, const Vec3i& coord) {
  for (const Voxel& voxel : grid.voxels) {
    if (voxel.coord == coord) return voxel.value;
  }
  for (const TestTile& tile : grid.tiles) {
    const Vec3i inside = coord - tile.origin;
    const auto in = [&](int part) { return part >= 0 && part < tile.size; };
    if (in(inside.x) && in(inside.y) && in(inside.z)) return tile.value;
  }
  return 0;
}

void write_vdb_file(const std::filesystem::path& path, const std::vector<TestGrid>& grids,
                    VdbValues values, Codec codec) {
  openvdb::GridPtrVec made;
  for (const TestGrid& grid : grids) {
    if (values == VdbValues::kDouble) {
      made.push_back(openvdb_grid<openvdb::DoubleGrid>(grid));
    } else {
      made.push_back(openvdb_grid<openvdb::FloatGrid>(grid));
      made.back()->setSaveFloatAsHalf(values == VdbValues::kHalf);
    }
  }
  write_openvdb(path, made, codec);
}

void write_vdb_vectors(const std::filesystem::path& path, const std::array<TestGrid, 3>& channels,
                       VectorValues values, Codec codec) {
  const auto& [x, y, z] = channels;
  openvdb::GridBase::Ptr grid;
  if (values == VectorValues::kDouble) {
    grid = openvdb_grid<openvdb::Vec3DGrid>(x, &y, &z);
  } else {
    grid = openvdb_grid<openvdb::Vec3SGrid>(x, &y, &z);
  }
  grid->setSaveFloatAsHalf(values == VectorValues::kHalf);
  write_openvdb(path, {grid}, codec);
}

void write_vdb_points(const std::filesystem::path& path) {
  openvdb::initialize();
  const std::vector<openvdb::Vec3R> positions{{0, 0, 0}, {1, 2, 3}};
  const openvdb::points::PointAttributeVector<openvdb::Vec3R> wrapper(positions);
  const auto transform = openvdb::math::Transform::createLinearTransform(0.5);
  auto grid =
      openvdb::points::createPointDataGrid<openvdb::points::NullCodec,
                                           openvdb::points::PointDataGrid>(positions, *transform);
  grid->setName("particles");
  write_openvdb(path, {grid}, Codec::kBlosc);
}

void write_nvdb_file(const std::filesystem::path& path, const std::vector<TestGrid>& grids,
                     NvdbValues values, Codec codec) {
  std::vector<nanovdb::GridHandle<>> handles;
  for (const TestGrid& grid : grids) handles.push_back(nanovdb_grid(grid, values));
  nanovdb::io::writeGrids(path.string(), handles, nanovdb_codec(codec));
}

void write_nvdb_vectors(const std::filesystem::path& path, const std::array<TestGrid, 3>& channels,
                        Codec codec) {
  const auto& [x, y, z] = channels;
  std::vector<nanovdb::GridHandle<>> handles;
  handles.push_back(nanovdb::openToNanoVDB(*openvdb_grid<openvdb::Vec3SGrid>(x, &y, &z)));
  nanovdb::io::writeGrids(path.string(), handles, nanovdb_codec(codec));
}

}  // namespace freepath::testing_volumes
