// Files that are valid and rare: what they hold is read as OpenVDB and NanoVDB read it.

#include "tests/io/volume_oddities.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "freepath/io/volume.h"
#include "freepath/io/volume_write.h"
#include "tests/io/volume_files.h"

namespace freepath {
namespace {

using namespace testing_volumes;  // NOLINT(google-build-using-namespace)

LoadedField load(const std::filesystem::path& path, const char* grid = "") {
  LoadOptions options;
  options.selection = parse_grid_selection(grid);
  return load_field(path, options);
}

/// The field's interpolant is what the sampler sees.
void expect_samples(const LoadedField& loaded, const std::vector<Vec3d>& points,
                    const std::vector<double>& samples) {
  ASSERT_EQ(points.size(), samples.size());
  int other_than_zero = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_NEAR(loaded.field.voxels.interpolate(points[i]), samples[i], 1e-5) << "at " << points[i];
    other_than_zero += samples[i] != 0 ? 1 : 0;
  }
  EXPECT_GT(other_than_zero, 500);
}

TEST(InactiveVoxels, OfLeavesAndTilesKeepTheirValuesAsTheSamplersSeeThem) {
  const TemporaryFolder folder;
  const std::vector<Vec3d> points = write_vdb_inactive(folder / "a.vdb");
  write_nvdb_inactive(folder / "a.nvdb");
  for (const char* const name : {"a.vdb", "a.nvdb"}) {
    const LoadedField loaded = load(folder / name);
    expect_samples(loaded, points,
                   name == std::string("a.vdb") ? openvdb_samples(folder / name, points)
                                                : nanovdb_samples(folder / name, points));
    EXPECT_TRUE(loaded.warnings.empty());
    // 170 of a full leaf, 256 of one without active voxels, and two tiles.
    EXPECT_EQ(loaded.inactive_voxels, 170U + 256U + 512U + 128U * 128U * 128U);
    EXPECT_EQ(loaded.active_tiles, 2U);
    EXPECT_EQ(loaded.field.voxels.active_max(), Vec3i(255, 127, 127));
    const GridInfo info = list_grids(folder / name)[0];
    EXPECT_EQ(info.inactive_voxels, loaded.inactive_voxels);
    EXPECT_EQ(info.active_voxels, loaded.active_voxels);
    EXPECT_EQ(info.active_max, loaded.field.voxels.active_max());
    EXPECT_EQ(info.maximum, loaded.maximum);
  }
}

TEST(InactiveVoxels, OfTheBackgroundCountAsZeroAndOthersDoNot) {
  const TemporaryFolder folder;
  for (const double background : {0.5, -1e30, std::numeric_limits<double>::quiet_NaN()}) {
    write_vdb_inactive(folder / "a.vdb", background);
    const LoadedField loaded = load(folder / "a.vdb");
    EXPECT_EQ(loaded.field.voxels.value(Vec3i(-8, 0, 7)), 0) << background;
    EXPECT_EQ(loaded.field.voxels.value(Vec3i(16, 0, 0)), 2);
    ASSERT_EQ(loaded.warnings.size(), 1U);
    EXPECT_NE(loaded.warnings[0].find("its background is"), std::string::npos);
  }
}

TEST(InactiveVoxels, ThatAreInvalidBecomeZeroWithAWarningOrAreRefused) {
  const TemporaryFolder folder;
  write_vdb_inactive(folder / "a.vdb", 0, true);
  const LoadedField loaded = load(folder / "a.vdb");
  EXPECT_EQ(loaded.invalid_voxels, 1U);
  EXPECT_EQ(loaded.field.voxels.value(Vec3i(-8, 0, 7)), 0);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("the first: voxel (-8, 0, 7) is NaN"), std::string::npos)
      << loaded.warnings[0];
  LoadOptions refuse;
  refuse.invalid = InvalidPolicy::kError;
  EXPECT_NE(error_of([&] { load_field(folder / "a.vdb", refuse); }).find("voxel (-8, 0, 7) is NaN"),
            std::string::npos);
}

TEST(WholeNumbers, AndTruthValuesAndMasksAreDensities) {
  const TemporaryFolder folder;
  const std::pair<WholeValues, const char*> types[] = {{WholeValues::kInt32, "int32"},
                                                       {WholeValues::kInt64, "int64"},
                                                       {WholeValues::kBool, "bool"},
                                                       {WholeValues::kMask, "mask"},
                                                       {WholeValues::kVec3i, "vec3i"}};
  for (const auto& [values, type] : types) {
    write_vdb_whole(folder / "a.vdb", values);
    std::vector<const char*> names = {"a.vdb"};
    if (values != WholeValues::kVec3i) {
      write_nvdb_whole(folder / "a.nvdb", values);
      names.push_back("a.nvdb");
    }
    const bool bits = values == WholeValues::kBool || values == WholeValues::kMask;
    for (const char* const name : names) {
      SCOPED_TRACE(std::string(name) + " " + type);
      EXPECT_EQ(list_grids(folder / name)[0].type, type);
      const std::vector<LoadedField> fields = load_fields(folder / name);
      EXPECT_EQ(fields.size(), values == WholeValues::kVec3i ? 3U : 1U);
      const BrickMap& map = fields.back().field.voxels;
      for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(map.value(Vec3i(i, 2 * i, 5 * i)), bits ? 1 : i + 1);
        EXPECT_EQ(map.value(Vec3i(i, 2 * i, 5 * i + 1)), 0);
      }
      EXPECT_EQ(map.value(Vec3i(71, 7, 7)), bits ? 1 : 3);
      EXPECT_EQ(map.value(Vec3i(100, 200, 100)), 1);
      EXPECT_EQ(fields[0].active_voxels, 10U + 512U + 128U * 128U * 128U);
    }
  }
}

TEST(Frustums, AreResampledToVoxelsOfOneSizeWithTheErrorThatTheWarningStates) {
  const TemporaryFolder folder;
  const std::vector<WorldSample> samples = write_vdb_smooth_frustum(folder / "a.vdb");
  const LoadedField loaded = load(folder / "a.vdb");
  const Matrix4d world_to_index = loaded.field.index_to_world.inverse();
  double largest = 0;
  for (const WorldSample& sample : samples) {
    const double value = loaded.field.voxels.interpolate(sample.point * world_to_index);
    largest = std::max(largest, std::abs(value - sample.value));
  }
  EXPECT_LT(largest, 0.005);
  EXPECT_GT(largest, 0);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  const std::string text = "largest difference at 4096 points is ";
  const std::size_t at = loaded.warnings[0].find(text);
  ASSERT_NE(at, std::string::npos) << loaded.warnings[0];
  const double stated = std::stod(loaded.warnings[0].substr(at + text.size()));
  EXPECT_LT(largest, 1.5 * stated);
  EXPECT_LT(stated, 0.005);
  EXPECT_NE(loaded.warnings[0].find("a.vdb: grid \"density\": its transform is a frustum"),
            std::string::npos);
  EXPECT_TRUE(list_grids(folder / "a.vdb")[0].loadable);
}

TEST(SharedTrees, AreReadForEachGridWithItsOwnTransform) {
  const TemporaryFolder folder;
  write_vdb_shared(folder / "a.vdb");
  const LoadedField density = load(folder / "a.vdb"), copy = load(folder / "a.vdb", "copy");
  EXPECT_EQ(density.field.index_to_world[0][0], 1);
  EXPECT_EQ(copy.field.index_to_world[0][0], 2);
  EXPECT_GT(density.active_voxels, 0U);
  EXPECT_TRUE(std::ranges::equal(density.field.voxels.voxels(), copy.field.voxels.voxels()));
  const auto grids = list_grids(folder / "a.vdb");
  ASSERT_EQ(grids.size(), 2U);
  EXPECT_TRUE(grids[1].loadable) << grids[1].reason;
  EXPECT_EQ(grids[1].active_voxels, density.active_voxels);
}

TEST(Streams, WithoutADirectoryAreReadFromOneGridToTheNext) {
  const TemporaryFolder folder;
  write_vdb_stream(folder / "a.vdb");
  const auto grids = list_grids(folder / "a.vdb");
  ASSERT_EQ(grids.size(), 4U);
  for (const GridInfo& grid : grids) EXPECT_TRUE(grid.loadable) << grid.name << grid.reason;
  const std::vector<Vec3d> points = write_vdb_inactive(folder / "b.vdb");
  const std::vector<double> samples = openvdb_samples(folder / "b.vdb", points);
  for (const auto& [name, edge] : {std::pair("density", 1), {"copy", 2}, {"last", 3}}) {
    const LoadedField loaded = load(folder / "a.vdb", name);
    expect_samples(loaded, points, samples);
    EXPECT_EQ(loaded.field.index_to_world[0][0], edge) << name;
  }
  EXPECT_EQ(load(folder / "a.vdb", "flags").field.voxels.value(Vec3i(1, 2, 5)), 1);
}

TEST(Streams, TellThatNothingIsFoundBehindAGridOfUnknownType) {
  const TemporaryFolder folder;
  write_vdb_stream(folder / "a.vdb", true);
  const auto grids = list_grids(folder / "a.vdb");
  ASSERT_EQ(grids.size(), 3U);  // the fourth can't be found
  EXPECT_FALSE(grids[2].loadable);
  EXPECT_NE(grids[2].reason.find("stream"), std::string::npos) << grids[2].reason;
  EXPECT_GT(load(folder / "a.vdb").active_voxels, 0U);
}

TEST(OldFiles, OfEveryVersionAreReadAsOpenVdbReadsThem) {
  const TemporaryFolder folder;
  for (uint32_t version = 219; version < 222; ++version) {
    for (const bool compressed : {false, true}) {
      if (!compressed && version < 220) continue;  // was always compressed
      SCOPED_TRACE(version);
      const auto points = write_vdb_old(folder / "a.vdb", version, compressed);
      const LoadedField loaded = load(folder / "a.vdb");
      expect_samples(loaded, points, openvdb_samples(folder / "a.vdb", points));
      EXPECT_EQ(loaded.field.index_to_world[0][0], 0.5);
    }
  }
}

TEST(GridMemory, OfNanoVdbIsReadWithoutAFileHeader) {
  const TemporaryFolder folder;
  write_nvdb_memory(folder / "a.nvdb");
  write_nvdb_inactive(folder / "b.nvdb");
  const auto grids = list_grids(folder / "a.nvdb");
  ASSERT_EQ(grids.size(), 2U);
  EXPECT_EQ(grids[0].name, "density");
  EXPECT_EQ(grids[1].name, "heat");
  const LoadedField in_file = load(folder / "b.nvdb");
  for (const char* const grid : {"density", "heat"}) {
    const LoadedField loaded = load(folder / "a.nvdb", grid);
    EXPECT_EQ(loaded.active_voxels, in_file.active_voxels);
    EXPECT_TRUE(std::ranges::equal(loaded.field.voxels.voxels(), in_file.field.voxels.voxels()));
  }
}

TEST(EmptyGrids, AreFieldsOfZerosWithAWarning) {
  const TemporaryFolder folder;
  write_vdb_empty(folder / "a.vdb");
  write_vdb_empty(folder / "b.vdb", true);
  write_nvdb_empty(folder / "a.nvdb");
  for (const char* const name : {"a.vdb", "b.vdb", "a.nvdb"}) {
    const LoadedField loaded = load(folder / name);
    EXPECT_TRUE(loaded.empty()) << name;
    EXPECT_FALSE(loaded.field.voxels.empty()) << name;  // a voxel, so that it stands somewhere
    EXPECT_EQ(loaded.maximum, 0);
    ASSERT_EQ(loaded.warnings.size(), 1U);
    EXPECT_NE(loaded.warnings[0].find("it is empty"), std::string::npos);
    const GridInfo info = list_grids(folder / name)[0];
    EXPECT_TRUE(info.loadable && info.empty()) << info.reason;
  }
}

/// Bytes that this process has read, from its own account.
uint64_t bytes_read() {
  std::ifstream account("/proc/self/io");
  std::string word;
  uint64_t bytes = 0;
  account >> word >> bytes;
  return word == "rchar:" ? bytes : 0;
}

// Work is counted as bytes that are read, which no load of the machine changes.
TEST(ManyGrids, TakeWorkInProportionToTheirNumber) {
  if (bytes_read() == 0) GTEST_SKIP() << "no /proc/self/io";
  const TemporaryFolder folder;
  const auto work_for = [&](int count) {
    write_vdb_many(folder / "a.vdb", count);
    const uint64_t before = bytes_read();
    int visited = 0;
    visit_grids(folder / "a.vdb", {}, {}, [&](const GridInfo&, std::vector<LoadedField> fields) {
      visited += static_cast<int>(fields.size());
    });
    EXPECT_EQ(visited, count);
    return static_cast<double>(bytes_read() - before);
  };
  const double some = work_for(20);
  EXPECT_LT(work_for(80), 4.5 * some);
  // And to their size, too, not to a window for each.
  EXPECT_LT(some, 20.0 * static_cast<double>(std::filesystem::file_size(folder / "a.vdb")));
}

TEST(WrittenVolumes, AreTheSameBytesEachTime) {
  const TemporaryFolder folder;
  BrickMapBuilder builder(Vec3i(0), Vec3i(20), 1);
  builder.set_voxel(Vec3i(3, 4, 5), 0.5F);
  const Field field{"density", std::move(builder).finish(), Matrix4d()};
  const Field* const fields[] = {&field};
  write_vdb(folder / "a.vdb", fields);
  write_vdb(folder / "b.vdb", fields);
  EXPECT_EQ(read_bytes(folder / "a.vdb"), read_bytes(folder / "b.vdb"));
  EXPECT_EQ(load(folder / "a.vdb").field.voxels.value(Vec3i(3, 4, 5)), 0.5F);
}

}  // namespace
}  // namespace freepath
