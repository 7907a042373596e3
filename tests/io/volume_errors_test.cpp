// What can't be loaded: one clear message each, and never a crash.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "freepath/io/volume.h"
#include "freepath/io/volume_write.h"
#include "tests/io/volume_files.h"

namespace freepath {
namespace {

using namespace testing_volumes;  // NOLINT(google-build-using-namespace)

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void expect_contains(const std::string& message, std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts) {
    EXPECT_NE(message.find(part), message.npos) << "\"" << part << "\" is not in: " << message;
  }
}

/// Writes a grid in both formats and returns the loader's messages.
std::vector<std::string> messages_for(const TestGrid& grid, const LoadOptions& options = {}) {
  const TemporaryFolder folder;
  write_vdb_file(folder / "a.vdb", {grid});
  write_nvdb_file(folder / "a.nvdb", {grid});
  return {error_of([&] { load_field(folder / "a.vdb", options); }),
          error_of([&] { load_field(folder / "a.nvdb", options); })};
}

LoadOptions refusing() {
  LoadOptions options;
  options.invalid = InvalidPolicy::kError;
  return options;
}

TEST(VolumeErrors, MissingFileDirectoryEmptyFileAndOtherFormats) {
  const TemporaryFolder folder;
  const auto load = [&](const char* name) { return error_of([&] { load_field(folder / name); }); };
  expect_contains(load("none.vdb"), {"none.vdb", "no such file"});
  expect_contains(error_of([&] { load_field(folder.path()); }), {"is a directory"});
  write_bytes(folder / "empty.vdb", {});
  expect_contains(load("empty.vdb"), {"empty.vdb", "is empty"});
  write_bytes(folder / "text.vdb", Bytes(100, 'x'));
  expect_contains(load("text.vdb"), {"text.vdb", "is not a volume file"});
  write_bytes(folder / "short.vdb", Bytes(3, 'x'));
  expect_contains(load("short.vdb"), {"is not a volume file"});
}

TEST(VolumeErrors, TheFormatIsToldByContentNotByName) {
  const TemporaryFolder folder;
  write_nvdb_file(folder / "nano.vdb", {sample_grid()});
  EXPECT_NO_THROW(load_field(folder / "nano.vdb"));
  write_vdb_file(folder / "open.nvdb", {sample_grid()});
  EXPECT_NO_THROW(load_field(folder / "open.nvdb"));
}

TEST(VolumeErrors, LevelSetsAndPoints) {
  const TemporaryFolder folder;
  TestGrid level_set = sample_grid();
  level_set.level_set = true;
  level_set.background = 3;
  for (const std::string& message : messages_for(level_set)) {
    expect_contains(message, {"grid \"density\"", "level set", "fog volume"});
  }
  write_vdb_points(folder / "points.vdb");
  expect_contains(error_of([&] { load_field(folder / "points.vdb"); }),
                  {"grid \"particles\"", "points"});
  const auto grids = list_grids(folder / "points.vdb");
  ASSERT_EQ(grids.size(), 1U);
  EXPECT_FALSE(grids[0].loadable);
  EXPECT_FALSE(grids[0].reason.empty());
}

TEST(VolumeErrors, AFileWithoutGrids) {
  const TemporaryFolder folder;
  write_vdb_file(folder / "a.vdb", {});
  expect_contains(error_of([&] { load_field(folder / "a.vdb"); }), {"a.vdb", "no grids"});
  EXPECT_TRUE(list_grids(folder / "a.vdb").empty());
}

TEST(VolumeErrors, NanInfinityAndNegativeNameTheVoxel) {
  const std::pair<double, const char*> cases[] = {{kNan, "is NaN"},
                                                  {kInfinity, "is infinite"},
                                                  {-kInfinity, "is infinite"},
                                                  {-0.5, "is negative (-0.5)"}};
  for (const auto& [value, text] : cases) {
    TestGrid grid = sample_grid();
    grid.voxels[3].value = value;
    const Vec3i coord = grid.voxels[3].coord;
    const std::string voxel = fmt::format("voxel ({}, {}, {}) ", coord.x, coord.y, coord.z);
    for (const std::string& message : messages_for(grid, refusing())) {
      expect_contains(message, {"grid \"density\"", voxel, text});
    }
    TestGrid tiled;
    tiled.tiles = {{Vec3i(64, 128, -8), 8, value}};
    for (const std::string& message : messages_for(tiled, refusing())) {
      expect_contains(message, {"voxel (64, 128, -8)", text});
    }
  }
}

TEST(VolumeErrors, InvalidValuesBecomeZeroWithOneWarning) {
  const TemporaryFolder folder;
  TestGrid grid = sample_grid();
  grid.voxels[3].value = kNan;
  grid.voxels[7].value = kInfinity;
  grid.tiles[0].value = -kInfinity;  // 8³ voxels
  write_vdb_file(folder / "a.vdb", {grid});
  write_nvdb_file(folder / "a.nvdb", {grid});
  for (const char* name : {"a.vdb", "a.nvdb"}) {
    const LoadedField loaded = load_field(folder / name);
    EXPECT_EQ(loaded.invalid_voxels, 2U + 512U) << name;
    EXPECT_EQ(loaded.field.voxels.value(grid.voxels[3].coord), 0);
    EXPECT_EQ(loaded.field.voxels.value(grid.voxels[7].coord), 0);
    EXPECT_EQ(loaded.field.voxels.value(grid.tiles[0].origin), 0);
    ASSERT_EQ(loaded.warnings.size(), 1U);
    const Vec3i coord = grid.voxels[3].coord;
    expect_contains(loaded.warnings[0],
                    {name, "density", "514 values",
                     fmt::format("voxel ({}, {}, {}) is NaN", coord.x, coord.y, coord.z)});
    EXPECT_TRUE(list_grids(folder / name)[0].loadable);
  }
}

TEST(VolumeErrors, DoublesOutOfTheRangeOfFloatNameTheVoxel) {
  const TemporaryFolder folder;
  TestGrid grid = sample_grid();
  grid.voxels[5].value = 1e39;
  write_vdb_file(folder / "a.vdb", {grid}, VdbValues::kDouble);
  write_nvdb_file(folder / "a.nvdb", {grid}, NvdbValues::kDouble);
  for (const char* name : {"a.vdb", "a.nvdb"}) {
    expect_contains(error_of([&] { load_field(folder / name, refusing()); }),
                    {"voxel (-8, 256, 21)", "1e+39", "range of float"});
    const LoadedField mended = load_field(folder / name);
    EXPECT_EQ(mended.invalid_voxels, 1U);
    EXPECT_EQ(mended.field.voxels.value(Vec3i(-8, 256, 21)), 0);
  }
}

TEST(VolumeErrors, ClampingTakesNegativeAsZeroButNeverNan) {
  const TemporaryFolder folder;
  TestGrid grid = sample_grid();
  grid.voxels[0].value = -1;
  grid.voxels[9].value = -0.25;
  grid.tiles[0].value = -2;  // 8³ voxels
  write_vdb_file(folder / "a.vdb", {grid});
  write_nvdb_file(folder / "a.nvdb", {grid});
  LoadOptions options;
  options.negative = NegativePolicy::kClamp;
  for (const char* name : {"a.vdb", "a.nvdb"}) {
    const LoadedField loaded = load_field(folder / name, options);
    EXPECT_EQ(loaded.clamped_voxels, 2U + 512U) << name;
    EXPECT_EQ(loaded.minimum, 0) << name;
    EXPECT_EQ(loaded.field.voxels.value(grid.voxels[0].coord), 0);
    EXPECT_EQ(loaded.field.voxels.value(grid.tiles[0].origin), 0);
    ASSERT_EQ(loaded.warnings.size(), 1U);
    expect_contains(loaded.warnings[0], {name, "density", "514 negative"});
  }
  grid.voxels[1].value = kNan;
  options.invalid = InvalidPolicy::kError;
  for (const std::string& message : messages_for(grid, options)) {
    expect_contains(message, {"is NaN"});
  }
}

TEST(VolumeErrors, TheFirstBadVoxelIsNamedWhateverTheThreads) {
  TestGrid grid;
  for (int i = 0; i < 3000; ++i) grid.voxels.push_back({Vec3i(i, i, i), i % 7 == 3 ? -1.0 : 1.0});
  const auto first = messages_for(grid);
  for (int again = 0; again < 3; ++again) {
    const auto next = messages_for(grid);
    for (int format = 0; format < 2; ++format) {
      const auto tail = [&](const std::string& message) {
        return message.substr(message.find(": grid"));
      };
      EXPECT_EQ(tail(next[static_cast<std::size_t>(format)]),
                tail(first[static_cast<std::size_t>(format)]));
      expect_contains(next[static_cast<std::size_t>(format)], {"voxel (3, 3, 3)"});
    }
  }
}

}  // namespace
}  // namespace freepath
