#pragma once
/// @file Volume files that are valid and rare, and what the samplers of OpenVDB and NanoVDB see in
/// them.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "freepath/base/vector.h"

namespace freepath::testing_volumes {

/// The types of grids that hold no reals.
enum class WholeValues { kInt32, kInt64, kBool, kMask, kVec3i };

/// A grid "density" of 0, 1, 2, ... or of true: voxel (i, 2i, 5i) has the value i + 1 for i from 0
/// to 9, the tile at (64, 0, 0) of 8 voxels a side has 3, and the one at (0, 128, 0) of 128 has 1.
void write_vdb_whole(const std::filesystem::path& path, WholeValues values);
void write_nvdb_whole(const std::filesystem::path& path, WholeValues values);

/// A grid "density" with leaves that are full, sparse and of inactive values alone, and with active
/// and inactive tiles on all levels; values are 1 and more where they are not the background.
/// @param nan an inactive voxel that is NaN
/// @return points [index] in and around all that differs from the background
std::vector<Vec3d> write_vdb_inactive(const std::filesystem::path& path, double background = 0,
                                      bool nan = false);
/// The same as NanoVDB.
void write_nvdb_inactive(const std::filesystem::path& path);

/// What OpenVDB's BoxSampler sees at points of the first grid of a file [index].
std::vector<double> openvdb_samples(const std::filesystem::path& path,
                                    const std::vector<Vec3d>& points);
/// What NanoVDB's trilinear sampler sees.
std::vector<double> nanovdb_samples(const std::filesystem::path& path,
                                    const std::vector<Vec3d>& points);

/// A value at a place in the world.
struct WorldSample {
  Vec3d point;
  double value = 0;
};

/// A smooth density, 0 to 1, in a turned frustum that is four times as wide at its far end.
/// @return what OpenVDB's sampler sees at points of the world
std::vector<WorldSample> write_vdb_smooth_frustum(const std::filesystem::path& path);

/// Two grids, "density" and "copy", of one tree, each with a transform of its own.
void write_vdb_shared(const std::filesystem::path& path);

/// The grids of write_vdb_shared, one of type bool and then one named "last", as a stream without a
/// directory.
/// @param unknown whether the one of type bool is given the name of a type that nobody knows
void write_vdb_stream(const std::filesystem::path& path, bool unknown = false);

/// The grid of write_vdb_inactive as a file of a version before 222, written by hand.
/// @param compressed by zip
std::vector<Vec3d> write_vdb_old(const std::filesystem::path& path, uint32_t version,
                                 bool compressed);

/// The memory of NanoVDB grids named "density" and "heat", without a file's header.
void write_nvdb_memory(const std::filesystem::path& path);

/// A grid without any voxels, and one whose only leaf is inactive and 0.
void write_vdb_empty(const std::filesystem::path& path, bool with_leaf = false);
void write_nvdb_empty(const std::filesystem::path& path);

/// So many grids of one voxel each.
void write_vdb_many(const std::filesystem::path& path, int count);

}  // namespace freepath::testing_volumes
