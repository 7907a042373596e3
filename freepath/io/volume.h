#pragma once
/// @file Reading densities from volume files: OpenVDB (.vdb) and NanoVDB (.nvdb). What a file is is
/// told by its first bytes, not by its name.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/media/field.h"

namespace freepath {

/// What the channels of a grid of vectors are taken for.
inline constexpr char kChannelNames[] = {'R', 'G', 'B'};

/// Least and largest active value of a channel; 0 where there are none.
struct GridRange {
  float minimum = 0, maximum = 0;
};

/// One grid of a volume file.
struct GridInfo {
  std::string name;        ///< With a suffix where several share it: "density", "density[1]".
  int index = 0;           ///< Place in the file, from 0.
  std::string type;        ///< Of a voxel: "float", "half", "double", "Fp8", "vec3s", "points", ...
  std::string grid_class;  ///< "fog volume", "level set", "staggered" or "unknown".
  Matrix4d index_to_world;              ///< Centre of voxel (i,j,k) is the index point (i,j,k).
  Vec3i active_min{0}, active_max{-1};  ///< Inclusive bounds of the active voxels [index].
  uint64_t active_voxels = 0;           ///< Those of active tiles included.
  uint64_t active_tiles = 0;            ///< Constant cubes of 8, 128 or 4096 voxels a side.
  uint64_t stored_bytes = 0;            ///< Bytes of the grid in the file.
  float minimum = 0, maximum = 0;       ///< Of the active values, 0 where there are none.
  int channels = 1;                     ///< Densities in a voxel: 3 in a grid of vectors, R, G, B.
  std::vector<GridRange> ranges;        ///< Of each channel, once it has been read.
  bool loadable = false;                ///< Whether load_fields takes it.
  std::string reason;                   ///< Why not.
};

/// All grids of a file, in its order. Reads every grid of reals or vectors through, for bounds and
/// range; a grid that can't be read is listed with the reason.
/// @throws Error if the file can't be read or is no volume
std::vector<GridInfo> list_grids(const std::filesystem::path& path);

/// What to do about a negative density: refuse the grid, or put 0 in its place and say so.
enum class NegativePolicy { kError, kClamp };

/// Which grid of a file. With neither: the one named "density", else the only scalar one (vectors
/// of another name are more often velocities than densities). Where several have the same name, the
/// name alone is the first, "name[1]" the second, and so on.
struct GridSelection {
  std::optional<std::string> name;
  std::optional<int> index;
};

/// The selection for what a user typed: digits are an index, anything else is a name, and nothing
/// is the default.
GridSelection parse_grid_selection(std::string_view text);

/// The one of a file's grids that is selected.
/// @param file only for the message
/// @throws Error, listing what there is, if none is
const GridInfo& find_grid(const std::filesystem::path& file, const std::vector<GridInfo>& grids,
                          const GridSelection& selection);

struct LoadOptions {
  GridSelection selection;
  NegativePolicy negative = NegativePolicy::kError;
  bool scalar_only = false;  ///< Refuse grids of vectors.
};

/// A field with what there is to say about it.
struct LoadedField {
  Field field;
  std::vector<std::string> warnings;  ///< One sentence each, with file and grid.
  uint64_t clamped_voxels = 0;        ///< Negative ones set to 0.
  uint64_t active_voxels = 0;         ///< Those of active tiles included.
  uint64_t active_tiles = 0;
  float minimum = 0, maximum = 0;  ///< Of the active values, after clamping.
};

/// Reads one grid into a brick map, leaf by leaf and in parallel: at no time is the grid in memory
/// twice. Inactive voxels are 0. Doubles are rounded to float.
/// @throws Error, naming file, grid and voxel, if there is no such file or grid; the file is
///   truncated or damaged; the grid is a level set, of points, not scalar or empty; its transform
///   is not affine and invertible; or a value is NaN, infinite, out of the range of float, or
///   negative (see NegativePolicy)
LoadedField load_field(const std::filesystem::path& path, const LoadOptions& options = {});

/// The same for a grid of any number of channels: one field, or three of one transform and layout
/// for the densities of R, G and B that a grid of vectors holds.
/// @throws Error as load_field; about a value it names the channel too
std::vector<LoadedField> load_fields(const std::filesystem::path& path,
                                     const LoadOptions& options = {});

}  // namespace freepath
