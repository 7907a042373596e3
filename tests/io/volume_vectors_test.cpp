// Grids of vectors as the densities of R, G and B.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "freepath/io/volume.h"
#include "tests/io/volume_files.h"

namespace freepath {
namespace {

using namespace testing_volumes;  // NOLINT(google-build-using-namespace)

/// Three grids of the same voxels and tiles, with other values in each, and none in some.
std::array<TestGrid, 3> channels_of(const std::string& name = "density") {
  std::array<TestGrid, 3> channels;
  for (int c = 0; c < 3; ++c) {
    channels[c] = sample_grid();
    channels[c].name = name;
    channels[c].index_to_world = Matrix4d(0.5, 0, 0, 0, 0, -2, 0, 0, 0, 0, 3, 0, 1, 2, 3, 1);
    for (std::size_t i = 0; i < channels[c].voxels.size(); ++i) {
      channels[c].voxels[i].value *= i % 3 == static_cast<std::size_t>(c) ? 0 : c + 1;
    }
    for (TestTile& tile : channels[c].tiles) tile.value += 0.25 * c;
  }
  return channels;
}

struct Written {
  const char* file;
  const char* type;
  VectorValues values;
  double tolerance;
};

constexpr Written kWritten[] = {{"a.vdb", "vec3s", VectorValues::kFloat, 1e-7},
                                {"a.vdb", "vec3h", VectorValues::kHalf, 0x1p-10},
                                {"a.vdb", "vec3d", VectorValues::kDouble, 1e-7},
                                {"a.nvdb", "vec3f", VectorValues::kFloat, 1e-7}};

LoadOptions options_for(const char* grid) {
  LoadOptions options;
  options.selection = parse_grid_selection(grid);
  return options;
}

void write(const std::filesystem::path& path, const std::array<TestGrid, 3>& channels,
           VectorValues values = VectorValues::kFloat, Codec codec = Codec::kBlosc) {
  if (path.extension() == ".vdb") {
    write_vdb_vectors(path, channels, values, codec);
  } else {
    write_nvdb_vectors(path, channels, codec);
  }
}

TEST(VectorGrids, AreThreeFieldsOfOneLayoutUnderEveryTypeAndCodec) {
  const TemporaryFolder folder;
  const std::array<TestGrid, 3> channels = channels_of();
  for (const Written& written : kWritten) {
    for (const Codec codec : {Codec::kNone, Codec::kZip, Codec::kBlosc}) {
      SCOPED_TRACE(std::string(written.file) + ", " + written.type);
      write(folder / written.file, channels, written.values, codec);
      const std::vector<LoadedField> fields = load_fields(folder / written.file);
      ASSERT_EQ(fields.size(), 3U);
      for (int c = 0; c < 3; ++c) {
        const Field& field = fields[c].field;
        EXPECT_EQ(field.name, std::string("density.") + "RGB"[c]);
        EXPECT_EQ(field.index_to_world, fields[0].field.index_to_world);
        EXPECT_EQ(field.voxels.origin(), fields[0].field.voxels.origin());
        EXPECT_EQ(field.voxels.brick_counts(), fields[0].field.voxels.brick_counts());
        EXPECT_EQ(field.voxels.active_min(), Vec3i(-128, -3, -42));
        EXPECT_EQ(field.voxels.active_max(), Vec3i(130, 263, 127));
        for (const Voxel& voxel : channels[c].voxels) {
          ASSERT_NEAR(field.voxels.value(voxel.coord), voxel.value,
                      written.tolerance * (voxel.value + 1));
        }
        for (const TestTile& tile : channels[c].tiles) {
          ASSERT_NEAR(field.voxels.value(tile.origin + Vec3i(tile.size - 1)), tile.value,
                      written.tolerance);
        }
      }
    }
  }
}

TEST(VectorGrids, AreListedWithTheRangeOfEachChannel) {
  const TemporaryFolder folder;
  for (const Written& written : kWritten) {
    write(folder / written.file, channels_of(), written.values);
    const std::vector<GridInfo> grids = list_grids(folder / written.file);
    ASSERT_EQ(grids.size(), 1U);
    EXPECT_EQ(grids[0].type, written.type);
    EXPECT_TRUE(grids[0].loadable) << grids[0].reason;
    EXPECT_EQ(grids[0].channels, 3);
    ASSERT_EQ(grids[0].ranges.size(), 3U);
    const std::vector<LoadedField> fields = load_fields(folder / written.file);
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(grids[0].ranges[c].minimum, fields[c].minimum);
      EXPECT_EQ(grids[0].ranges[c].maximum, fields[c].maximum);
      EXPECT_LE(grids[0].minimum, fields[c].minimum);
      EXPECT_GE(grids[0].maximum, fields[c].maximum);
    }
    EXPECT_LT(fields[0].maximum, fields[2].maximum);
  }
}

TEST(VectorGrids, OfTheNameDensityAreTheDefaultAndOthersAreChosenByName) {
  const TemporaryFolder folder;
  for (const char* file : {"a.vdb", "a.nvdb"}) {
    write(folder / file, channels_of("velocity"));
    const std::string message = error_of([&] { load_fields(folder / file); });
    EXPECT_NE(message.find("no grid is named \"density\" and none could be one; choose (--grid) "
                           "among 0 \"velocity\" (vec3"),
              message.npos)
        << message;
    EXPECT_EQ(load_fields(folder / file, options_for("velocity")).size(), 3U);
    EXPECT_EQ(load_fields(folder / file, options_for("0")).size(), 3U);
    write(folder / file, channels_of());
    EXPECT_EQ(load_fields(folder / file).size(), 3U);
    const std::string scalar = error_of([&] { load_field(folder / file); });
    EXPECT_NE(scalar.find("grid \"density\": its voxels are of type vec3"), scalar.npos) << scalar;
    EXPECT_NE(scalar.find("3 densities; choose a grid of one"), scalar.npos) << scalar;
  }
}

TEST(VectorGrids, ValuesThatAreNoDensitiesNameGridVoxelAndChannel) {
  const TemporaryFolder folder;
  const std::pair<double, const char*> values[] = {
      {-0.5, "is negative (-0.5)"},
      {std::numeric_limits<double>::quiet_NaN(), "is NaN"},
      {std::numeric_limits<double>::infinity(), "is infinite"}};
  LoadOptions refusing = options_for("dye");
  refusing.invalid = InvalidPolicy::kError;
  for (const char* file : {"a.vdb", "a.nvdb"}) {
    for (int c = 0; c < 3; ++c) {
      for (const auto& [value, what] : values) {
        std::array<TestGrid, 3> channels = channels_of("dye");
        channels[c].voxels.back().value = value;  // at (130, -1, 0)
        write(folder / file, channels);
        const std::string expected =
            std::string("grid \"dye\", channel ") + "RGB"[c] + ": voxel (130, -1, 0) " + what;
        const std::string message = error_of([&] { load_fields(folder / file, refusing); });
        EXPECT_NE(message.find(expected), message.npos) << message;
        const GridInfo info = list_grids(folder / file)[0];
        EXPECT_EQ(info.loadable, !(value < 0 && std::isfinite(value)));
        EXPECT_TRUE(info.loadable || info.reason.find(what) != info.reason.npos) << info.reason;
      }
    }
    std::array<TestGrid, 3> channels = channels_of();
    channels[1].voxels.back().value = -0.5;
    write(folder / file, channels);
    LoadOptions clamp;
    clamp.negative = NegativePolicy::kClamp;
    const std::vector<LoadedField> clamped = load_fields(folder / file, clamp);
    EXPECT_EQ(clamped[0].warnings.size(), 0U);
    ASSERT_EQ(clamped[1].warnings.size(), 1U);
    EXPECT_NE(clamped[1].warnings[0].find("channel G: 1 negative density"),
              clamped[1].warnings[0].npos);
  }
}

}  // namespace
}  // namespace freepath
