#pragma once
/// @file Volume files for tests, written through OpenVDB and NanoVDB into a folder of its own.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/vector.h"

namespace freepath::testing_volumes {

/// A temporary folder, removed with all in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

using Bytes = std::vector<char>;
Bytes read_bytes(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, const Bytes& bytes);

/// The message of the Error that a call throws; fails the test if it throws none.
std::string error_of(const std::function<void()>& call);

enum class VdbValues { kFloat, kHalf, kDouble };
enum class Codec { kNone, kZip, kBlosc };

/// A voxel of a test grid.
struct Voxel {
  Vec3i coord = Vec3i(0, 0, 0);
  double value = 0;
};

/// A constant cube of a test grid: size is 8, 128 or 4096.
struct TestTile {
  Vec3i origin = Vec3i(0, 0, 0);
  int size = 8;
  double value = 0;
};

/// What a test grid holds.
struct TestGrid {
  std::string name = "density";
  std::vector<Voxel> voxels;
  std::vector<TestTile> tiles;
  double background = 0;
  Matrix4d index_to_world;
  bool level_set = false;
};

/// A grid with leaves that are full, sparse and far apart, on both sides of the origin.
TestGrid sample_grid();

/// What a grid holds at a voxel.
double value_of(const TestGrid& grid, const Vec3i& voxel);

void write_vdb_file(const std::filesystem::path& path, const std::vector<TestGrid>& grids,
                    VdbValues values = VdbValues::kFloat, Codec codec = Codec::kBlosc);

enum class VectorValues { kFloat, kHalf, kDouble };

/// A grid of vectors whose x, y and z are the values of three grids, which have the same voxels and
/// tiles; name, background and the rest are the first one's.
void write_vdb_vectors(const std::filesystem::path& path, const std::array<TestGrid, 3>& channels,
                       VectorValues values = VectorValues::kFloat, Codec codec = Codec::kBlosc);
void write_nvdb_vectors(const std::filesystem::path& path, const std::array<TestGrid, 3>& channels,
                        Codec codec = Codec::kNone);

/// Grids no density can be read from.
void write_vdb_points(const std::filesystem::path& path);

enum class NvdbValues { kFloat, kDouble, kFp4, kFp8, kFp16, kFpN };

void write_nvdb_file(const std::filesystem::path& path, const std::vector<TestGrid>& grids,
                     NvdbValues values = NvdbValues::kFloat, Codec codec = Codec::kNone);

}  // namespace freepath::testing_volumes
