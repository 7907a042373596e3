// Formats with a value for each voxel: values, order of axes, where samples lie, and damage.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "freepath/io/volume.h"
#include "tests/gzip.h"
#include "tests/io/dense_files.h"
#include "tests/io/volume_files.h"

namespace freepath {
namespace {

using namespace testing_volumes;  // NOLINT(google-build-using-namespace)

/// A file of some format, with what it holds.
struct DenseFile {
  std::string name, bytes;
  SampleGrid grid;
};

/// One file of each format and each way to store values in it.
std::vector<DenseFile> dense_files() {
  std::vector<DenseFile> files;
  const auto add = [&](const std::string& name, const std::string& bytes, const SampleGrid& grid) {
    files.push_back({std::to_string(files.size()) + name, bytes, grid});
  };
  for (const bool cells : {false, true}) {
    for (const bool big_endian : {false, true}) {
      for (const bool packed : {false, true}) {
        for (const bool wide : {false, true}) {
          VtiStorage storage{.packed = packed,
                             .wide = wide,
                             .big_endian = big_endian,
                             .cells = cells,
                             .doubles = wide};
          add("raw.vti", vti_file(storage), vti_samples(storage));
          storage.base64 = true;
          add("text.vti", vti_file(storage), vti_samples(storage));
          storage.format = "binary";
          add("inline.vti", vti_file(storage), vti_samples(storage));
        }
      }
    }
    const VtiStorage ascii{.format = "ascii", .cells = cells};
    add("ascii.vti", vti_file(ascii), vti_samples(ascii));
    for (const bool text : {false, true}) {
      add("old.vtk", legacy_vtk_file(text, cells), legacy_vtk_samples(cells));
    }
  }
  for (const bool big_endian : {false, true}) {
    for (const char* const encoding : {"raw", "gzip", "ascii"}) {
      add("a.nrrd", nrrd_file(encoding, big_endian), sample_positions());
    }
    for (const bool packed : {false, true}) {
      add("a.mha", metaimage_file(packed, big_endian), sample_positions());
    }
    for (const int version : {1, 2}) {
      for (const bool quaternion : {false, true}) {
        const std::string bytes = nifti_file(version, quaternion, big_endian);
        add("a.nii", bytes, sample_positions());
        add("a.nii.gz", testing::gzip(bytes), sample_positions());
      }
    }
  }
  return files;
}

TEST(DenseVolumes, AnAffineFunctionIsWhereItsSamplesAre) {
  const TemporaryFolder folder;
  for (const DenseFile& file : dense_files()) {
    SCOPED_TRACE(file.name);
    write_text(folder / file.name, file.bytes);
    const LoadedField loaded = load_field(folder / file.name);
    expect_affine(loaded, file.grid);
    EXPECT_TRUE(loaded.warnings.empty());
  }
}

TEST(DenseVolumes, ADisplacementByHalfAVoxelIsSeen) {
  // The check above must catch cells read as nodes: half a step along x changes the function by a
  // hundred times the tolerance, at least.
  const TemporaryFolder folder;
  write_text(folder / "a.vti", vti_file({.cells = true}));
  const LoadedField loaded = load_field(folder / "a.vti");
  const Vec3d position = Vec3d(4, 4, 4) * sample_positions(0).index_to_world;
  const Vec3d index = position * loaded.field.index_to_world.inverse();
  EXPECT_NEAR(loaded.field.voxels.interpolate(index), affine_density(position), 1e-4);
  EXPECT_NEAR((Vec3d(3.5, 3.5, 3.5) - index).length(), 0, 1e-9);
}

TEST(DenseVolumes, ListingsAgreeWithWhatIsLoaded) {
  const TemporaryFolder folder;
  for (const DenseFile& file : dense_files()) {
    SCOPED_TRACE(file.name);
    write_text(folder / file.name, file.bytes);
    const GridInfo info = list_grids(folder / file.name).front();
    const LoadedField loaded = load_field(folder / file.name);
    EXPECT_TRUE(info.loadable) << info.reason;
    EXPECT_EQ(info.name, "density");
    EXPECT_EQ(info.index_to_world, loaded.field.index_to_world);
    EXPECT_EQ(info.active_voxels, 10U * 9 * 11);
    EXPECT_EQ(info.minimum, loaded.minimum);
    EXPECT_EQ(info.maximum, loaded.maximum);
    EXPECT_GT(info.stored_bytes, 0U);
  }
}

TEST(DenseVolumes, EveryTruncationIsAnError) {
  const TemporaryFolder folder;
  for (const DenseFile& file : dense_files()) {
    SCOPED_TRACE(file.name);
    // Behind the last value there may be an end of markup, a line's end, or another array.
    const std::size_t appended = file.bytes.find("\n</AppendedData");
    const bool text = file.bytes.find("encoding: ascii") != std::string::npos;
    const std::size_t last = file.name.ends_with(".vtk")     ? file.bytes.rfind("again") - 40
                             : appended != std::string::npos ? appended - 1
                                                             : file.bytes.size() - (text ? 30 : 5);
    // Each place in the header, and some among the values.
    for (std::size_t size = 1; size < last; size += size < 600 ? 11 : 1997) {
      write_text(folder / file.name, file.bytes.substr(0, size));
      EXPECT_NE(load_message(folder / file.name), "") << "cut at " << size;
    }
    write_text(folder / file.name, file.bytes.substr(0, last));
    EXPECT_NE(load_message(folder / file.name), "") << "cut at " << last;
  }
}

TEST(DenseVolumes, DamagedBytesGiveAFieldOrAnError) {
  const TemporaryFolder folder;
  uint64_t state = 1;
  for (const DenseFile& file : dense_files()) {
    SCOPED_TRACE(file.name);
    for (int i = 0; i < 25; ++i) {
      state = state * 6364136223846793005U + 1442695040888963407U;
      std::string bytes = file.bytes;
      const std::size_t offset = (state >> 33U) % std::min<std::size_t>(bytes.size(), 700);
      bytes[offset] = static_cast<char>(state >> 20U);
      write_text(folder / file.name, bytes);
      // Another byte at the beginning may make it another format; none is empty for long.
      load_message(folder / file.name);
      try {
        list_grids(folder / file.name);
      } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(file.name), std::string::npos);
      }
    }
  }
}

TEST(DenseVolumes, TimesAreChosenByNumber) {
  const TemporaryFolder folder;
  std::string bytes = nifti_file(1, false);
  const std::size_t header = 352;
  bytes += stored<float>(std::vector<double>(10 * 9 * 11, 7.0));
  bytes.replace(40, 2, stored<int16_t>({4}));
  bytes.replace(48, 2, stored<int16_t>({2}));
  ASSERT_GT(bytes.size(), header);
  write_text(folder / "a.nii", bytes);
  LoadOptions options;
  const LoadedField first = load_field(folder / "a.nii", options);
  expect_affine(first, sample_positions());
  ASSERT_EQ(first.warnings.size(), 1U);
  EXPECT_NE(first.warnings[0].find("2 times"), std::string::npos);
  options.selection = parse_grid_selection("density@1");
  const LoadedField second = load_field(folder / "a.nii", options);
  EXPECT_EQ(second.minimum, 14.5F);  // 2 · 7 + 0.5
  EXPECT_TRUE(second.warnings.empty());
  options.selection = parse_grid_selection("density@2");
  EXPECT_NE(error_of([&] { load_field(folder / "a.nii", options); }).find("no time 2"),
            std::string::npos);
}

TEST(DenseVolumes, DetachedValuesAreReadBesideTheirHeader) {
  const TemporaryFolder folder;
  const SampleGrid grid = sample_positions(0, false);
  const std::string values = stored<float>(affine_values(grid));
  write_text(folder / "values.raw", "12345" + values);
  write_text(folder / "a.nhdr",
             "NRRD0004\ntype: float\ndimension: 3\nsizes: 10 9 11\nspacings: 0.5 0.25 2\n"
             "axis mins: 1 2 3\ncenters: node node node\nendian: little\nencoding: raw\n"
             "byte skip: 5\ndata file: values.raw\n");
  expect_affine(load_field(folder / "a.nhdr"), grid);
  write_text(folder / "values.mhd",
             "NDims = 3\nDimSize = 10 9 11\nElementType = MET_FLOAT\nElementSpacing = 0.5 0.25 2\n"
             "Offset = 1 2 3\nBinaryData = True\nHeaderSize = -1\nElementDataFile = values.raw\n");
  expect_affine(load_field(folder / "values.mhd"), grid);
  // A raw file is read through the header beside it.
  expect_affine(load_field(folder / "values.raw"), grid);
}

TEST(DenseVolumes, AxesOfNrrdBeginHalfAStepBeforeCells) {
  const TemporaryFolder folder;
  const SampleGrid grid = sample_positions(0.5, false);
  write_text(folder / "a.nrrd",
             "NRRD0004\ntype: float\ndimension: 3\nsizes: 10 9 11\naxis mins: 1 2 3\n"
             "axis maxs: 6 4.25 25\ncenters: cell cell cell\nendian: little\nencoding: raw\n\n" +
                 stored<float>(affine_values(grid)));
  expect_affine(load_field(folder / "a.nrrd"), grid);
}

TEST(DenseVolumes, RawValuesNeedALayoutThatFits) {
  const TemporaryFolder folder;
  const SampleGrid grid = sample_positions(0, false);
  write_text(folder / "a.raw", "123" + stored<double>(affine_values(grid), std::endian::big));
  EXPECT_NE(load_message(folder / "a.raw").find("--raw-size"), std::string::npos);
  LoadOptions options;
  RawLayout layout{.counts = grid.counts,
                   .type = "float64",
                   .order = std::endian::big,
                   .offset = 3,
                   .spacing = Vec3d(0.5, 0.25, 2),
                   .origin = Vec3d(1, 2, 3)};
  options.raw = layout;
  expect_affine(load_field(folder / "a.raw", options), grid);
  const auto message = [&](const std::function<void(RawLayout&)>& change) {
    options.raw = layout;
    change(*options.raw);
    return error_of([&] { load_field(folder / "a.raw", options); });
  };
  EXPECT_NE(message([](RawLayout& l) { l.counts.x = 11; }).find("bytes"), std::string::npos);
  EXPECT_NE(message([](RawLayout& l) { l.counts.y = 0; }).find("along y"), std::string::npos);
  EXPECT_NE(message([](RawLayout& l) { l.offset = 1 << 30; }).find("bytes"), std::string::npos);
  EXPECT_NE(message([](RawLayout& l) { l.type = "float128"; }).find("float128"), std::string::npos);
  EXPECT_NE(message([](RawLayout& l) { l.spacing.z = 0; }).find("invertible"), std::string::npos);
}

TEST(DenseVolumes, ZerosAreEmptyAndConstantBlocksAreTiles) {
  const TemporaryFolder folder;
  const auto write = [&](const Vec3i& counts, const std::vector<double>& values) {
    write_text(folder / "a.mha",
               fmt::format("NDims = 3\nDimSize = {} {} {}\nElementType = MET_UCHAR\n"
                           "BinaryData = True\nElementDataFile = LOCAL\n",
                           counts.x, counts.y, counts.z) +
                   stored<uint8_t>(values));
  };
  std::vector<double> values(16 * 8 * 8, 0);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = i % 16 >= 8 ? 3 : 0;
  write(Vec3i(16, 8, 8), values);
  const LoadedField tile = load_field(folder / "a.mha");
  EXPECT_EQ(tile.active_tiles, 1U);
  EXPECT_EQ(tile.field.voxels.active_min(), Vec3i(8, 0, 0));
  EXPECT_EQ(tile.field.voxels.active_max(), Vec3i(15, 7, 7));
  EXPECT_EQ(tile.field.voxels.value(Vec3i(9, 3, 3)), 3);
  write(Vec3i(2, 2, 2), std::vector<double>(8, 0));
  const LoadedField empty = load_field(folder / "a.mha");
  EXPECT_TRUE(empty.empty());
  EXPECT_EQ(empty.warnings.size(), 1U);
}

TEST(DenseVolumes, NegativeAndInvalidValuesFollowThePolicies) {
  const TemporaryFolder folder;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto write = [&](double value) {
    std::vector<double> values(27, 1);
    values[13] = value;
    write_text(folder / "a.nrrd",
               "NRRD0004\ntype: double\ndimension: 3\nsizes: 3 3 3\nendian: little\nencoding: "
               "raw\n\n" +
                   stored<double>(values));
  };
  write(-2);
  EXPECT_NE(load_message(folder / "a.nrrd").find("voxel (1, 1, 1) is negative (-2)"),
            std::string::npos);
  LoadOptions clamp;
  clamp.negative = NegativePolicy::kClamp;
  EXPECT_EQ(load_field(folder / "a.nrrd", clamp).clamped_voxels, 1U);
  for (const double value : {nan, 1e300, -1e300}) {
    write(value);
    EXPECT_EQ(load_field(folder / "a.nrrd").invalid_voxels, 1U);
    LoadOptions strict;
    strict.invalid = InvalidPolicy::kError;
    EXPECT_NE(error_of([&] { load_field(folder / "a.nrrd", strict); }).find("voxel (1, 1, 1)"),
              std::string::npos);
  }
}

TEST(DenseVolumes, VectorsAreThreeDensities) {
  const TemporaryFolder folder;
  std::vector<double> values;
  for (int i = 0; i < 27; ++i) {
    for (int k = 1; k <= 3; ++k) values.push_back(k * (i + 1));
  }
  write_text(folder / "a.nrrd",
             "NRRD0004\ntype: float\ndimension: 4\nsizes: 3 3 3 3\nendian: little\nencoding: "
             "raw\nspacings: nan 1 1 1\n\n" +
                 stored<float>(values));
  const std::vector<LoadedField> fields =
      load_fields(folder / "a.nrrd", {.selection = {"density", {}}});
  ASSERT_EQ(fields.size(), 3U);
  for (int k = 1; k <= 3; ++k) {
    EXPECT_EQ(fields[static_cast<std::size_t>(k - 1)].field.voxels.value(Vec3i(2, 1, 0)),
              static_cast<float>(k * 6));
  }
}

}  // namespace
}  // namespace freepath
