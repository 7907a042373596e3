// Round trips: what other programs write is what the loaders return.

#include "freepath/io/volume.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "tests/io/volume_files.h"

namespace freepath {
namespace {

using namespace testing_volumes;  // NOLINT(google-build-using-namespace)

/// Compares a loaded field with what was written, at every voxel written and around it.
void expect_same(const TestGrid& grid, const LoadedField& loaded, double tolerance) {
  const BrickMap& map = loaded.field.voxels;
  for (const Voxel& voxel : grid.voxels) {
    ASSERT_NEAR(map.value(voxel.coord), voxel.value, tolerance * (std::abs(voxel.value) + 1));
    for (int axis = 0; axis < 3; ++axis) {
      Vec3i beside = voxel.coord;
      ++beside[axis];
      const double expected = value_of(grid, beside);
      ASSERT_NEAR(map.value(beside), expected, tolerance * (std::abs(expected) + 1));
    }
  }
  uint64_t active = grid.voxels.size();
  for (const TestTile& tile : grid.tiles) {
    active += uint64_t(tile.size) * uint64_t(tile.size) * uint64_t(tile.size);
    const Vec3i last = tile.origin + Vec3i(tile.size - 1);
    for (const Vec3i& corner : {tile.origin, last, tile.origin + Vec3i(tile.size / 2)}) {
      ASSERT_NEAR(map.value(corner), tile.value, tolerance);
    }
    ASSERT_EQ(map.value(tile.origin - Vec3i(1)), value_of(grid, tile.origin - Vec3i(1)));
    ASSERT_EQ(map.value(last + Vec3i(1)), value_of(grid, last + Vec3i(1)));
  }
  EXPECT_EQ(loaded.active_voxels, active);
  EXPECT_EQ(loaded.active_tiles, grid.tiles.size());
}

void expect_bounds(const LoadedField& loaded, const Vec3i& low, const Vec3i& high) {
  EXPECT_EQ(loaded.field.voxels.active_min(), low);
  EXPECT_EQ(loaded.field.voxels.active_max(), high);
}

TEST(VdbRoundTrip, FloatHalfAndDoubleUnderEveryCodec) {
  const TemporaryFolder folder;
  const TestGrid grid = sample_grid();
  for (const Codec codec : {Codec::kNone, Codec::kZip, Codec::kBlosc}) {
    for (const VdbValues values : {VdbValues::kFloat, VdbValues::kHalf, VdbValues::kDouble}) {
      write_vdb_file(folder / "a.vdb", {grid}, values, codec);
      const LoadedField loaded = load_field(folder / "a.vdb");
      expect_same(grid, loaded, values == VdbValues::kHalf ? 0x1p-11 : 1e-7);
      expect_bounds(loaded, Vec3i(-128, -3, -42), Vec3i(130, 263, 127));
      EXPECT_TRUE(loaded.warnings.empty());
      const auto infos = list_grids(folder / "a.vdb");
      ASSERT_EQ(infos.size(), 1U);
      EXPECT_EQ(infos[0].type, values == VdbValues::kFloat  ? "float"
                               : values == VdbValues::kHalf ? "half"
                                                            : "double");
      EXPECT_TRUE(infos[0].loadable) << infos[0].reason;
      EXPECT_EQ(infos[0].grid_class, "fog volume");
      EXPECT_EQ(infos[0].active_voxels, loaded.active_voxels);
      EXPECT_EQ(infos[0].active_min, loaded.field.voxels.active_min());
      EXPECT_EQ(infos[0].maximum, loaded.maximum);
    }
  }
}

TEST(NvdbRoundTrip, EveryTypeUnderEveryCodec) {
  const TemporaryFolder folder;
  const TestGrid grid = sample_grid();
  // Quantised leaves span up to 8 in value, hence steps of 8/15, 8/255 and 8/65535.
  const std::pair<NvdbValues, double> types[] = {
      {NvdbValues::kFloat, 1e-7},    {NvdbValues::kDouble, 1e-7}, {NvdbValues::kFp4, 8.0 / 15},
      {NvdbValues::kFp8, 8.0 / 255}, {NvdbValues::kFp16, 1e-3},   {NvdbValues::kFpN, 0.1}};
  for (const Codec codec : {Codec::kNone, Codec::kZip, Codec::kBlosc}) {
    for (const auto& [values, tolerance] : types) {
      write_nvdb_file(folder / "a.nvdb", {grid}, values, codec);
      const LoadedField loaded = load_field(folder / "a.nvdb");
      expect_same(grid, loaded, tolerance);
      expect_bounds(loaded, Vec3i(-128, -3, -42), Vec3i(130, 263, 127));
    }
  }
  const auto infos = list_grids(folder / "a.nvdb");
  ASSERT_EQ(infos.size(), 1U);
  EXPECT_EQ(infos[0].type, "FpN");
  EXPECT_EQ(infos[0].grid_class, "fog volume");
}

TEST(VolumeTransforms, RotatedMirroredAnisotropicAndShearedSurvive) {
  const TemporaryFolder folder;
  const double c = std::cos(0.7), s = std::sin(0.7);
  const Matrix4d matrices[] = {
      Matrix4d(), Matrix4d(2, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 3, 0, 1, 2, 3, 1),
      Matrix4d(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1),
      Matrix4d(c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, 7, 1),
      Matrix4d(0.1, 0.02, 0, 0, 0, 0.1, 0.03, 0, 0, 0, 0.1, 0, -9, 4, 2, 1)};
  for (const Matrix4d& matrix : matrices) {
    TestGrid grid = sample_grid();
    grid.index_to_world = matrix;
    write_vdb_file(folder / "a.vdb", {grid});
    write_nvdb_file(folder / "a.nvdb", {grid});
    for (const char* name : {"a.vdb", "a.nvdb"}) {
      EXPECT_TRUE(load_field(folder / name).field.index_to_world.equalWithAbsError(matrix, 1e-12))
          << name;
      EXPECT_TRUE(list_grids(folder / name)[0].index_to_world.equalWithAbsError(matrix, 1e-12));
    }
  }
}

TEST(VolumeSelection, ByNameByNumberAndByDefault) {
  const TemporaryFolder folder;
  std::vector<TestGrid> grids(4);
  const char* const names[] = {"heat", "density", "density", "2"};
  for (int i = 0; i < 4; ++i) {
    grids[static_cast<std::size_t>(i)].name = names[i];
    grids[static_cast<std::size_t>(i)].voxels = {{Vec3i(i), 1.0 + i}};
  }
  write_vdb_file(folder / "a.vdb", grids);
  write_nvdb_file(folder / "a.nvdb", grids);
  for (const char* file : {"a.vdb", "a.nvdb"}) {
    const auto loaded = [&](const char* text) {
      LoadOptions options;
      options.selection = parse_grid_selection(text);
      return load_field(folder / file, options).maximum;
    };
    EXPECT_EQ(loaded(""), 2) << file;  // the first of those named "density"
    EXPECT_EQ(loaded("density"), 2) << file;
    EXPECT_EQ(loaded("density[0]"), 2) << file;
    EXPECT_EQ(loaded("density[1]"), 3) << file;
    EXPECT_EQ(loaded("heat"), 1) << file;
    EXPECT_EQ(loaded("3"), 4) << file;  // a number is a place
    for (const char* missing : {"smoke", "4", "density[2]"}) {
      const std::string message = error_of([&] { loaded(missing); });
      EXPECT_NE(message.find("0 \"heat\" (float), 1 \"density\" (float), 2 \"density[1]\" (float), "
                             "3 \"2\" (float)"),
                message.npos)
          << message;
    }
  }
}

TEST(VolumeSelection, TheOnlyScalarGridIsTheDefaultAndSeveralAreAnError) {
  const TemporaryFolder folder;
  TestGrid heat = sample_grid(), steam = sample_grid();
  heat.name = "heat";
  steam.name = "steam";
  write_vdb_file(folder / "a.vdb", {heat});
  EXPECT_EQ(load_field(folder / "a.vdb").field.name, "heat");
  write_vdb_file(folder / "a.vdb", {heat, steam});
  const std::string message = error_of([&] { load_field(folder / "a.vdb"); });
  EXPECT_NE(message.find("several"), message.npos) << message;
  EXPECT_NE(message.find("\"steam\""), message.npos) << message;
}

TEST(VolumeLoad, IsTheSameOnAnyNumberOfThreads) {
  const TemporaryFolder folder;
  TestGrid grid;
  for (int i = 0; i < 4000; ++i) {
    grid.voxels.push_back({Vec3i(i * 7 % 301, i * 11 % 203, i * 13 % 107), 0.001 * i});
  }
  write_vdb_file(folder / "a.vdb", {grid});
  write_nvdb_file(folder / "a.nvdb", {grid}, NvdbValues::kFp16);
  for (const char* name : {"a.vdb", "a.nvdb"}) {
    const LoadedField many = load_field(folder / name);
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    const LoadedField single = load_field(folder / name);
    EXPECT_TRUE(std::ranges::equal(many.field.voxels.index(), single.field.voxels.index()));
    EXPECT_TRUE(std::ranges::equal(many.field.voxels.voxels(), single.field.voxels.voxels()));
  }
}

TEST(VolumeLoad, ABackgroundOtherThanZeroIsWarnedOfAndCountsAsZero) {
  const TemporaryFolder folder;
  TestGrid grid;
  grid.background = 0.5;
  grid.voxels = {{Vec3i(0), 1.0}};
  write_vdb_file(folder / "a.vdb", {grid});
  write_nvdb_file(folder / "a.nvdb", {grid});
  for (const char* name : {"a.vdb", "a.nvdb"}) {
    const LoadedField loaded = load_field(folder / name);
    EXPECT_EQ(loaded.field.voxels.value(Vec3i(1)), 0) << name;
    ASSERT_EQ(loaded.warnings.size(), 1U) << name;
    EXPECT_NE(loaded.warnings[0].find("its background is 0.5"), std::string::npos);
  }
}

TEST(VolumeLoad, BoundsThatAreTooLargeAreRefusedBeforeTheyCostAnything) {
  const TemporaryFolder folder;
  TestGrid grid;
  grid.tiles = {{Vec3i(0), 128, 0.5}};
  grid.voxels = {{Vec3i(100000, 0, 0), 1.0}};
  write_vdb_file(folder / "a.vdb", {grid});
  EXPECT_EQ(load_field(folder / "a.vdb").field.voxels.value(Vec3i(100000, 0, 0)), 1);
  grid.tiles = {{Vec3i(4096, 0, -4096), 4096, 0.5}};  // a tile of the root
  write_vdb_file(folder / "a.vdb", {grid});
  write_nvdb_file(folder / "a.nvdb", {grid});
  for (const char* name : {"a.vdb", "a.nvdb"}) {
    const std::string message = error_of([&] { load_field(folder / name); });
    EXPECT_NE(message.find("grid \"density\": the active voxels span"), message.npos) << message;
    const GridInfo info = list_grids(folder / name)[0];
    EXPECT_EQ(info.active_voxels, uint64_t{4096} * 4096 * 4096 + 1);
  }
}

// A stray voxel, or a cloud at the other end of the sky: what is loaded is what there is.
TEST(VolumeLoad, MemoryFollowsTheVoxelsAndNotTheirBox) {
  const TemporaryFolder folder;
  const auto bytes_at = [&](const Vec3i& stray, const char* name) {
    TestGrid grid;
    grid.tiles = {{Vec3i(0), 8, 0.5}, {Vec3i(64, 0, 8), 8, 0.25}};
    grid.voxels = {{Vec3i(-3, 20, 7), 2.0}, {stray, 1.0}};
    if (std::string(name) == "a.vdb") {
      write_vdb_file(folder / name, {grid});
    } else {
      write_nvdb_file(folder / name, {grid});
    }
    const LoadedField loaded = load_field(folder / name);
    expect_same(grid, loaded, 1e-7);
    return loaded.field.voxels.memory_bytes();
  };
  for (const char* name : {"a.vdb", "a.nvdb"}) {
    const std::size_t near = bytes_at(Vec3i(6000), name);
    EXPECT_LT(near, 16'384U);
    EXPECT_EQ(bytes_at(Vec3i(1 << 18, -(1 << 19), 24000), name), near);
    EXPECT_EQ(bytes_at(Vec3i(1 << 22), name), near);
  }
}

struct Real {
  const char* file;
  std::size_t index;
  uint64_t active, tiles;
  Vec3i size;
  double largest;
};

TEST(RealVolumes, HaveTheNumbersOfTheirDescription) {
  const std::filesystem::path data = FREEPATH_TEST_DATA;
  const std::filesystem::path volumes = data / "volumes";
  if (!std::filesystem::exists(volumes)) {
    GTEST_SKIP() << "no volumes in " << data << " (CMake variable FREEPATH_TEST_DATA)";
  }
  const Real reals[] = {
      {"smoke.vdb", 0, 1049275, 0, Vec3i(111, 222, 112), 5.715},
      {"wdas_cloud_sixteenth.vdb", 0, 415642, 130, Vec3i(126, 86, 154), 1},
      {"dragon_with_xform.vdb", 0, 156161, 20, Vec3i(141, 99, 63), 1},
      {"three_density_grids.vdb", 0, 491, 0, Vec3i(11, 11, 11), 10},
      {"three_density_grids.vdb", 1, 2222, 0, Vec3i(19, 19, 22), 10},
      {"three_density_grids.vdb", 2, 803, 0, Vec3i(11, 11, 11), 10},
  };
  for (const Real& real : reals) {
    LoadOptions options;
    options.selection.index = static_cast<int>(real.index);
    const LoadedField loaded = load_field(volumes / real.file, options);
    EXPECT_EQ(loaded.active_voxels, real.active) << real.file;
    EXPECT_EQ(loaded.active_tiles, real.tiles) << real.file;
    const BrickMap& map = loaded.field.voxels;
    EXPECT_EQ(map.active_max() - map.active_min() + Vec3i(1), real.size) << real.file;
    EXPECT_NEAR(loaded.maximum, real.largest, 1e-3) << real.file;
  }
}

TEST(RealVolumes, AreTheSameFromOpenVdbAndNanoVdb) {
  const std::filesystem::path data = FREEPATH_TEST_DATA;
  const std::filesystem::path scenes = data / ".." / "bench" / "scenes";
  if (!std::filesystem::exists(scenes)) {
    GTEST_SKIP() << "no scenes beside " << data << " (CMake variable FREEPATH_TEST_DATA)";
  }
  for (const char* name : {"smoke", "wdas_cloud_sixteenth"}) {
    const auto a = load_field(data / "volumes" / (std::string(name) + ".vdb"));
    const auto b = load_field(scenes / (std::string(name) + ".nvdb"));
    EXPECT_TRUE(a.field.index_to_world.equalWithAbsError(b.field.index_to_world, 1e-9)) << name;
    const Vec3i low = a.field.voxels.active_min(), high = a.field.voxels.active_max();
    ASSERT_EQ(low, b.field.voxels.active_min());
    ASSERT_EQ(high, b.field.voxels.active_max());
    int different = 0;
    for (int x = low.x; x <= high.x; ++x) {
      for (int y = low.y; y <= high.y; ++y) {
        for (int z = low.z; z <= high.z; ++z) {
          const Vec3i voxel(x, y, z);
          different += a.field.voxels.value(voxel) != b.field.voxels.value(voxel) ? 1 : 0;
        }
      }
    }
    EXPECT_EQ(different, 0) << name;
  }
}

}  // namespace
}  // namespace freepath
