#include "tests/io/volume_oddities.h"

#include <zlib.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <nanovdb/util/SampleFromVoxels.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

namespace freepath::testing_volumes {
namespace {

using openvdb::Coord, openvdb::FloatGrid, openvdb::FloatTree;

template <class Grid>
typename Grid::Ptr whole_grid() {
  openvdb::initialize();
  using Value = typename Grid::ValueType;
  auto grid = Grid::create();
  grid->setName("density");
  grid->tree().addTile(1, Coord(64, 0, 0), Value(3), true);
  grid->tree().addTile(2, Coord(0, 128, 0), Value(1), true);
  for (int i = 0; i < 10; ++i) {
    grid->tree().setValueOn(Coord(i, 2 * i, 5 * i), Value(i + 1));
  }
  return grid;
}

openvdb::GridBase::Ptr whole_grid(WholeValues values) {
  switch (values) {
    case WholeValues::kInt32:
      return whole_grid<openvdb::Int32Grid>();
    case WholeValues::kInt64:
      return whole_grid<openvdb::Int64Grid>();
    case WholeValues::kBool:
      return whole_grid<openvdb::BoolGrid>();
    case WholeValues::kMask:
      return whole_grid<openvdb::MaskGrid>();
    case WholeValues::kVec3i:
      break;
  }
  return whole_grid<openvdb::Vec3IGrid>();
}

void write_file(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids) {
  openvdb::io::File file(path.string());
  file.write(grids);
  file.close();
}

FloatGrid::Ptr inactive_grid(double background, bool nan) {
  openvdb::initialize();
  auto grid = FloatGrid::create(static_cast<float>(background));
  grid->setName("density");
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  FloatTree& tree = grid->tree();
  tree.addTile(1, Coord(16, 0, 0), 2.0F, false);
  tree.addTile(1, Coord(24, 0, 0), 3.0F, true);
  tree.addTile(2, Coord(128, 0, 0), 1.5F, false);
  tree.addTile(2, Coord(-256, 0, 0), 1.25F, true);
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      for (int k = 0; k < 8; ++k) {
        const float value = 1 + 0.01F * static_cast<float>(i * 64 + j * 8 + k);
        if ((i + j + k) % 3 == 0) tree.setValueOff(Coord(i, j, k), value);  // beside active ones
        if ((i + j + k) % 3 == 1) tree.setValueOn(Coord(i, j, k), value);
        if (k < 4) tree.setValueOff(Coord(i - 8, j, k), value);  // of a leaf without active ones
        tree.setValueOn(Coord(i, j + 8, k), value);
      }
    }
  }
  if (nan) tree.setValueOff(Coord(-8, 0, 7), std::numeric_limits<float>::quiet_NaN());
  return grid;
}

std::vector<Vec3d> points_around() {
  std::vector<Vec3d> points;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 2000; ++i) {
    // Half of them around leaves and small tiles, the others around the large tiles.
    if (i % 2 == 0) {
      points.emplace_back(-10 + 44 * unit(random), -2 + 20 * unit(random), -2 + 12 * unit(random));
    } else {
      points.emplace_back(-270 + 540 * unit(random), -10 + 150 * unit(random),
                          -10 + 150 * unit(random));
    }
  }
  return points;
}

/// Writes numbers and texts as .vdb files have them.
class OldWriter {
 public:
  OldWriter(uint32_t version, bool compressed) : version_(version), compressed_(compressed) {}

  template <class T>
  void put(const T& value) {
    bytes_.write(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  void put_text(const std::string& text) {
    put(static_cast<uint32_t>(text.size()));
    bytes_ << text;
  }
  void put_values(const std::vector<float>& values) {
    const auto size = static_cast<uLong>(values.size() * sizeof(float));
    const auto* const data = reinterpret_cast<const char*>(values.data());
    if (!compressed_) {
      bytes_.write(data, static_cast<std::streamsize>(size));
      return;
    }
    uLongf length = compressBound(size);
    std::vector<char> packed(length);
    compress(reinterpret_cast<Bytef*>(packed.data()), &length, reinterpret_cast<const Bytef*>(data),
             size);
    if (length < size) {
      put(static_cast<int64_t>(length));
      bytes_.write(packed.data(), static_cast<std::streamsize>(length));
    } else {
      put(-static_cast<int64_t>(size));
      bytes_.write(data, static_cast<std::streamsize>(size));
    }
  }
  template <class Node>
  void put_topology(const Node& node) {
    if constexpr (Node::LEVEL == 0) {
      node.getValueMask().save(bytes_);
    } else {
      node.getChildMask().save(bytes_);
      node.getValueMask().save(bytes_);
      std::vector<float> values;
      for (auto i = node.cbeginChildOff(); i; ++i) values.push_back(*i);
      put_values(values);
      for (auto child = node.cbeginChildOn(); child; ++child) put_topology(*child);
    }
  }
  void put_leaf(const FloatTree::LeafNodeType& leaf) {
    leaf.getValueMask().save(bytes_);
    for (int axis = 0; axis < 3; ++axis) put(leaf.origin()[axis]);
    put(int8_t{2});  // a second buffer, as early programs had, which nobody reads
    std::vector<float> values(leaf.buffer().data(), leaf.buffer().data() + leaf.SIZE);
    put_values(values);
    put_values(std::vector<float>(values.size(), 7.0F));
  }
  void put_transform(const FloatGrid& grid) {
    if (version_ >= 219) {
      put_text(grid.transform().mapType());
      grid.transform().baseMap()->write(bytes_);
      return;
    }
    throw std::logic_error("transforms before version 219 are not written");
  }
  uint64_t offset() { return static_cast<uint64_t>(bytes_.tellp()); }
  std::string text() const { return bytes_.str(); }

 private:
  uint32_t version_;
  bool compressed_;
  std::ostringstream bytes_;
};

}  // namespace

void write_vdb_whole(const std::filesystem::path& path, WholeValues values) {
  write_file(path, {whole_grid(values)});
}

void write_nvdb_whole(const std::filesystem::path& path, WholeValues values) {
  const auto write = [&](const auto& grid) {
    std::vector<nanovdb::GridHandle<>> handles;
    handles.push_back(nanovdb::openToNanoVDB(*grid));
    nanovdb::io::writeGrids(path.string(), handles);
  };
  if (values == WholeValues::kInt32) write(whole_grid<openvdb::Int32Grid>());
  if (values == WholeValues::kInt64) write(whole_grid<openvdb::Int64Grid>());
  if (values == WholeValues::kBool) write(whole_grid<openvdb::BoolGrid>());
  if (values == WholeValues::kMask) write(whole_grid<openvdb::MaskGrid>());
}

std::vector<Vec3d> write_vdb_inactive(const std::filesystem::path& path, double background,
                                      bool nan) {
  write_file(path, {inactive_grid(background, nan)});
  return points_around();
}

void write_nvdb_inactive(const std::filesystem::path& path) {
  std::vector<nanovdb::GridHandle<>> handles;
  handles.push_back(nanovdb::openToNanoVDB(*inactive_grid(0, false)));
  nanovdb::io::writeGrids(path.string(), handles);
}

std::vector<double> openvdb_samples(const std::filesystem::path& path,
                                    const std::vector<Vec3d>& points) {
  openvdb::initialize();
  openvdb::io::File file(path.string());
  file.open(false);
  const auto grid = openvdb::gridPtrCast<FloatGrid>(file.readGrid(file.beginName().gridName()));
  std::vector<double> samples;
  for (const Vec3d& p : points) {
    samples.push_back(
        openvdb::tools::BoxSampler::sample(grid->tree(), openvdb::Vec3R(p.x, p.y, p.z)));
  }
  return samples;
}

std::vector<double> nanovdb_samples(const std::filesystem::path& path,
                                    const std::vector<Vec3d>& points) {
  const auto handle = nanovdb::io::readGrid(path.string());
  const nanovdb::FloatGrid* const grid = handle.grid<float>();
  const auto sampler = nanovdb::createSampler<1>(grid->tree());
  std::vector<double> samples;
  for (const Vec3d& p : points) samples.push_back(sampler(nanovdb::Vec3d(p.x, p.y, p.z)));
  return samples;
}

std::vector<WorldSample> write_vdb_smooth_frustum(const std::filesystem::path& path) {
  openvdb::initialize();
  const auto grid = FloatGrid::create();
  grid->setName("density");
  constexpr int kWidth = 32, kDepth = 24;
  const auto transform = openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(kWidth, kWidth, kDepth)), 0.25, 2, 0.5);
  transform->postRotate(0.6, openvdb::math::X_AXIS);
  transform->postTranslate(openvdb::Vec3d(5, -3, 2));
  grid->setTransform(transform);
  for (int x = 0; x <= kWidth; ++x) {
    for (int y = 0; y <= kWidth; ++y) {
      for (int z = 0; z <= kDepth; ++z) {
        const double value =
            std::sin(M_PI * x / kWidth) * std::sin(M_PI * y / kWidth) * (0.2 + 0.8 * z / kDepth);
        grid->tree().setValueOn(Coord(x, y, z), static_cast<float>(std::max(0.0, value)));
      }
    }
  }
  write_file(path, {grid});
  const openvdb::tools::GridSampler<FloatGrid, openvdb::tools::BoxSampler> sampler(*grid);
  std::vector<WorldSample> samples;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 500; ++i) {
    const double x = unit(random), y = unit(random), z = unit(random);
    const openvdb::Vec3d world =
        transform->indexToWorld(openvdb::Vec3d(x * kWidth, y * kWidth, z * kDepth));
    samples.push_back({Vec3d(world.x(), world.y(), world.z()), sampler.wsSample(world)});
  }
  return samples;
}

static openvdb::GridCPtrVec shared_grids() {
  const FloatGrid::Ptr grid = inactive_grid(0, false);
  const openvdb::GridBase::Ptr copy = grid->copyGrid();  // of the same tree
  copy->setName("copy");
  copy->setTransform(openvdb::math::Transform::createLinearTransform(2.0));
  return {grid, copy};
}

void write_vdb_shared(const std::filesystem::path& path) { write_file(path, shared_grids()); }

void write_vdb_stream(const std::filesystem::path& path, bool unknown) {
  openvdb::GridCPtrVec grids = shared_grids();
  const auto flags = whole_grid<openvdb::BoolGrid>();
  flags->setName("flags");
  grids.push_back(flags);
  const FloatGrid::Ptr last = inactive_grid(0, false);
  last->setName("last");
  last->setTransform(openvdb::math::Transform::createLinearTransform(3.0));
  grids.push_back(last);
  std::ostringstream stream;
  openvdb::io::Stream(stream).write(grids);
  std::string bytes = stream.str();
  if (unknown) bytes.replace(bytes.find("Tree_bool"), 9, "Tree_rare");
  std::ofstream(path, std::ios::binary) << bytes;
}

std::vector<Vec3d> write_vdb_old(const std::filesystem::path& path, uint32_t version,
                                 bool compressed) {
  const FloatGrid::Ptr grid = inactive_grid(0, false);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  OldWriter out(version, compressed);
  out.put(int64_t{0x56444220});
  out.put(version);
  out.put(uint32_t{0});  // the library's version
  out.put(uint32_t{99});
  out.put(uint8_t{1});  // with offsets
  if (version >= 220) out.put(static_cast<uint8_t>(compressed ? 1 : 0));
  if (version >= 218) {
    for (int i = 0; i < 36; ++i) out.put(i == 8 || i == 13 || i == 18 || i == 23 ? '-' : '0');
  } else {
    for (int i = 0; i < 16; ++i) out.put('0');
  }
  out.put(uint32_t{0});  // metadata of the file
  out.put(uint32_t{1});  // grids
  out.put_text("density");
  out.put_text("Tree_float_5_4_3");
  out.put_text("");
  const uint64_t table = out.offset();
  const uint64_t begin = table + 3 * sizeof(int64_t);
  OldWriter body(version, compressed);
  body.put(uint32_t{1});  // metadata of the grid
  body.put_text("class");
  body.put_text("string");
  body.put_text("fog volume");
  body.put_transform(*grid);
  const FloatTree& tree = grid->tree();
  body.put(uint32_t{1});  // buffers
  body.put(tree.background());
  uint32_t children = 0;
  for (auto i = tree.root().cbeginChildOn(); i; ++i) ++children;
  body.put(uint32_t{0});  // tiles
  body.put(children);
  for (auto child = tree.root().cbeginChildOn(); child; ++child) {
    for (int axis = 0; axis < 3; ++axis) body.put(child.getCoord()[axis]);
    body.put_topology(*child);
  }
  const uint64_t blocks = begin + body.offset();
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) body.put_leaf(*leaf);
  out.put(static_cast<int64_t>(begin));
  out.put(static_cast<int64_t>(blocks));
  out.put(static_cast<int64_t>(begin + body.offset()));
  std::ofstream file(path, std::ios::binary);
  file << out.text() << body.text();
  return points_around();
}

void write_nvdb_memory(const std::filesystem::path& path) {
  std::ofstream file(path, std::ios::binary);
  for (const char* const name : {"density", "heat"}) {
    const FloatGrid::Ptr grid = inactive_grid(0, false);
    grid->setName(name);
    auto handle = nanovdb::openToNanoVDB(*grid);
    auto* const data = reinterpret_cast<nanovdb::GridData*>(handle.data());
    data->mGridCount = 2;
    data->mGridIndex = name == std::string("heat") ? 1 : 0;
    file.write(reinterpret_cast<const char*>(handle.data()),
               static_cast<std::streamsize>(handle.size()));
  }
}

void write_vdb_empty(const std::filesystem::path& path, bool with_leaf) {
  openvdb::initialize();
  auto grid = FloatGrid::create();
  grid->setName("density");
  if (with_leaf) grid->tree().touchLeaf(Coord(80, 0, 0));
  write_file(path, {grid});
}

void write_nvdb_empty(const std::filesystem::path& path) {
  openvdb::initialize();
  auto grid = FloatGrid::create();
  grid->setName("density");
  std::vector<nanovdb::GridHandle<>> handles;
  handles.push_back(nanovdb::openToNanoVDB(*grid));
  nanovdb::io::writeGrids(path.string(), handles);
}

void write_vdb_many(const std::filesystem::path& path, int count) {
  openvdb::initialize();
  openvdb::GridCPtrVec grids;
  for (int i = 0; i < count; ++i) {
    auto grid = FloatGrid::create();
    grid->setName("g" + std::to_string(i));
    grid->tree().setValueOn(Coord(i, 0, 0), 1.0F);
    grids.push_back(grid);
  }
  write_file(path, grids);
}

}  // namespace freepath::testing_volumes
