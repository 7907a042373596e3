// Files that are cut short, damaged or noise: an error, or a field that keeps every promise.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "freepath/io/volume.h"
#include "tests/io/volume_files.h"

namespace freepath {
namespace {

using namespace testing_volumes;  // NOLINT(google-build-using-namespace)

/// A small file of each kind, for damaging.
std::vector<std::filesystem::path> write_small_files(const TemporaryFolder& folder) {
  TestGrid grid;
  grid.voxels = {{Vec3i(0), 1.0}, {Vec3i(3, 2, 1), 2.0}, {Vec3i(5, 4, 9), 0.5}};
  grid.tiles = {{Vec3i(8, 0, 0), 8, 0.25}};
  for (int i = 0; i < 200; ++i) grid.voxels.push_back({Vec3i(20 + i % 8, i / 8, 3), 0.01 * i});
  std::vector<std::filesystem::path> files;
  for (const Codec codec : {Codec::kNone, Codec::kZip, Codec::kBlosc}) {
    const std::string number = std::to_string(static_cast<int>(codec));
    files.push_back(folder / (number + ".vdb"));
    write_vdb_file(files.back(), {grid}, VdbValues::kHalf, codec);
    files.push_back(folder / (number + ".nvdb"));
    write_nvdb_file(files.back(), {grid}, NvdbValues::kFpN, codec);
  }
  return files;
}

/// A field, or the message of the Error that loading it threw. Anything else that is thrown fails
/// the test or ends it.
struct Attempt {
  std::optional<LoadedField> loaded;
  std::string message;
};

Attempt try_to_load(const std::filesystem::path& path) {
  try {
    return {load_field(path), {}};
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(path.filename()), message.npos) << message;
    return {std::nullopt, message};
  }
}

bool loads(const std::filesystem::path& path) { return try_to_load(path).loaded.has_value(); }

/// Whether the listing of a file offers nothing to load either, or is an Error.
bool nothing_is_loadable(const std::filesystem::path& path) {
  try {
    return std::ranges::none_of(list_grids(path), &GridInfo::loadable);
  } catch (const Error&) {
    return true;
  }
}

/// Whether values are densities, and those that differ from 0 stand within the active bounds.
::testing::AssertionResult is_sane(const LoadedField& loaded) {
  const BrickMap& map = loaded.field.voxels;
  const double determinant = loaded.field.index_to_world.determinant();
  if (!std::isfinite(determinant) || determinant == 0) {
    return ::testing::AssertionFailure() << "determinant " << determinant;
  }
  if (map.empty()) return ::testing::AssertionFailure() << "no voxel";
  const auto [lowest, highest] = std::ranges::minmax(map.voxels());
  if (!(lowest >= 0 && highest <= loaded.maximum && std::isfinite(loaded.maximum)) ||
      !std::ranges::none_of(map.voxels(), [](float value) { return std::isnan(value); })) {
    return ::testing::AssertionFailure() << "values from " << lowest << " to " << highest;
  }
  ::testing::AssertionResult sane = ::testing::AssertionSuccess();
  map.for_each_brick([&](const PlacedBrick& placed) {
    if (placed.brick >= map.brick_count()) {
      sane = ::testing::AssertionFailure() << "brick " << placed.brick;
      return;
    }
    const Vec3i first = placed.coord * BrickMap::kBrickSize;
    for (int offset = 0; offset < BrickMap::kBrickVoxels; ++offset) {
      if (map.voxels()[placed.brick * std::size_t{BrickMap::kBrickVoxels} + offset] == 0) continue;
      const Vec3i voxel = first + Vec3i(offset >> 6, offset >> 3 & 7, offset & 7);
      for (int axis = 0; axis < 3; ++axis) {
        if (voxel[axis] < map.active_min()[axis] || voxel[axis] > map.active_max()[axis]) {
          sane = ::testing::AssertionFailure() << "voxel " << voxel << " is out of bounds";
        }
      }
    }
  });
  return sane;
}

/// Whether the listing tells of a field what loading it does.
::testing::AssertionResult is_listed(const LoadedField& loaded,
                                     const std::vector<GridInfo>& grids) {
  for (const GridInfo& grid : grids) {
    if (grid.name != loaded.field.name) continue;
    const BrickMap& map = loaded.field.voxels;
    const bool same = grid.loadable && grid.active_voxels == loaded.active_voxels &&
                      grid.active_tiles == loaded.active_tiles && grid.minimum == loaded.minimum &&
                      grid.maximum == loaded.maximum &&
                      (grid.empty() || (grid.active_min == map.active_min() &&
                                        grid.active_max == map.active_max())) &&
                      grid.index_to_world == loaded.field.index_to_world;
    return (same ? ::testing::AssertionSuccess() : ::testing::AssertionFailure())
           << "grid " << grid.name << ", reason " << grid.reason;
  }
  return ::testing::AssertionFailure() << "no grid " << loaded.field.name;
}

TEST(DamagedVolumes, EveryTruncationIsAnError) {
  const TemporaryFolder folder;
  for (const auto& path : write_small_files(folder)) {
    const Bytes whole = read_bytes(path);
    ASSERT_TRUE(loads(path)) << path;
    // Every length near both ends, and some 100 between.
    const std::size_t step = std::max<std::size_t>(1, whole.size() / 100);
    for (std::size_t length = 1; length < whole.size();
         length += length < 300 || length + 30 > whole.size() ? 1 : step) {
      const std::filesystem::path cut = folder / "cut";
      write_bytes(cut, Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)));
      EXPECT_FALSE(loads(cut)) << path << " cut to " << length << " of " << whole.size();
      EXPECT_TRUE(nothing_is_loadable(cut)) << path << " cut to " << length;
    }
  }
}

TEST(DamagedVolumes, OneWrongByteIsAnErrorOrGivesASaneField) {
  const TemporaryFolder folder;
  const std::filesystem::path damaged = folder / "damaged";
  constexpr std::size_t kMagic = 8;       // what a file is known by
  constexpr std::size_t kHeaders = 1100;  // the headers of file, grid and tree, every byte of them
  constexpr int kFlips[] = {0x80, 0xFF, 0x01};
  for (const auto& path : write_small_files(folder)) {
    Bytes bytes = read_bytes(path);
    const std::size_t step = std::max<std::size_t>(1, bytes.size() / 150);
    for (std::size_t offset = 0; offset < bytes.size(); offset += offset < kHeaders ? 1 : step) {
      SCOPED_TRACE(path.string() + ", byte " + std::to_string(offset));
      const char whole = bytes[offset];
      bytes[offset] = static_cast<char>(whole ^ kFlips[offset % 3]);
      write_bytes(damaged, bytes);
      bytes[offset] = whole;
      const auto [loaded, message] = try_to_load(damaged);
      if (loaded) {
        ASSERT_GE(offset, kMagic);
        ASSERT_TRUE(is_sane(*loaded));
        ASSERT_TRUE(is_listed(*loaded, list_grids(damaged)));
      } else {
        // A listing needs no index of bricks, which coordinates that are far off make too large.
        ASSERT_TRUE(nothing_is_loadable(damaged) || message.find("crop") != message.npos)
            << message;
      }
    }
  }
}

TEST(DamagedVolumes, RandomBytesBehindAMagicNumberAreAnError) {
  const TemporaryFolder folder;
  uint32_t state = 1;
  for (const std::string& magic : {std::string(" BDV\0\0\0\0", 8), std::string("NanoVDB0")}) {
    for (int trial = 0; trial < 100; ++trial) {
      Bytes bytes(magic.begin(), magic.end());
      for (int i = 0; i < 2000; ++i) {
        state = state * 1664525U + 1013904223U;
        bytes.push_back(static_cast<char>(state >> 24));
      }
      write_bytes(folder / "noise", bytes);
      EXPECT_FALSE(loads(folder / "noise"));
      EXPECT_TRUE(nothing_is_loadable(folder / "noise"));
    }
  }
}

}  // namespace
}  // namespace freepath
