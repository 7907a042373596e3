#pragma once
/// @file Reading densities from volume files: OpenVDB, NanoVDB, VTK's images, NRRD, MetaImage,
/// NIfTI, NetCDF, and values without a header. What a file is is told by its first bytes, not by
/// its name.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/io/invalid_values.h"
#include "freepath/io/volume_raw.h"
#include "freepath/media/field.h"

namespace freepath {

/// What the channels of a grid of vectors are taken for.
inline constexpr char kChannelNames[] = {'R', 'G', 'B'};

/// Least and largest value of a channel, of its active voxels and those inactive ones that are not
/// 0; 0 where there are none.
struct GridRange {
  float minimum = 0, maximum = 0;
};

/// One grid of a volume file.
struct GridInfo {
  std::string name;  ///< Name, with a suffix where several share it: "density", "density[1]".
  int index = 0;     ///< Place in the file, from 0.
  std::string type;  ///< Type of a voxel: "float", "half", "int32", "bool", "Fp8", "vec3s", ...
  /// "fog volume", "level set", "staggered" or "unknown"; of files with a value for each voxel
  /// where those are: "samples", "samples at nodes" or "samples in cells".
  std::string grid_class;
  /// Centre of voxel (i,j,k) is the index point (i,j,k). Of a grid in a frustum only its affine
  /// part, until its fields are read.
  Matrix4d index_to_world;
  /// Inclusive bounds of the active voxels, and of inactive ones that are not 0 [index].
  Vec3i active_min{0}, active_max{-1};
  uint64_t active_voxels = 0;      ///< Number of active voxels, those of active tiles included.
  uint64_t inactive_voxels = 0;    ///< Inactive ones that are not 0: they count as they are.
  uint64_t active_tiles = 0;       ///< Constant cubes of 8, 128 or 4096 voxels a side.
  uint64_t stored_bytes = 0;       ///< Bytes of the grid in the file.
  float minimum = 0, maximum = 0;  ///< Range over all channels, as GridRange.
  int channels = 1;                ///< Densities in a voxel: 3 in a grid of vectors, R, G, B.
  std::vector<GridRange> ranges;   ///< Range of each channel, once it has been read.
  std::string length_unit;   ///< Unit of positions, as the file has it: "m", "mm"; empty: not told.
  std::string value_unit;    ///< Unit of values, "1/m", as the file has it; empty: not told.
  int times = 1;             ///< How often the grid stands in the file.
  int time = 0;              ///< The one that is meant, from 0.
  bool time_chosen = false;  ///< Whether the selection named it.
  bool loadable = false;     ///< Whether load_fields takes it.
  std::string reason;        ///< Why not.

  /// Whether nothing is in it, as in the first frames of many a sequence.
  bool empty() const { return active_voxels + inactive_voxels == 0; }
};

/// All grids of a file, in its order. Reads every grid of reals or vectors through, for bounds and
/// range; a grid that can't be read is listed with the reason.
/// @throws Error if the file can't be read or is no volume
std::vector<GridInfo> list_grids(const std::filesystem::path& path);

/// All grids of a file, from the headers alone: without bounds, ranges and counts: no voxel is
/// read.
/// @throws Error as list_grids
std::vector<GridInfo> list_grid_heads(const std::filesystem::path& path);

/// What to do about a negative density: refuse the grid, or put 0 in its place and say so.
enum class NegativePolicy { kError, kClamp };

/// Which grid of a file. With neither: the one named "density", else the one named "extinction",
/// else the only scalar one (vectors of another name are more often velocities than densities).
/// Where several have the same name, the name alone is the first, "name[1]" the second, and so on.
/// Behind the name of a grid that stands in the file for several times, "@3" is the fourth.
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
GridInfo find_grid(const std::filesystem::path& file, const std::vector<GridInfo>& grids,
                   const GridSelection& selection);

struct LoadOptions {
  GridSelection selection;
  NegativePolicy negative = NegativePolicy::kError;
  InvalidPolicy invalid = InvalidPolicy::kZero;
  bool scalar_only = false;        ///< Refuse grids of vectors.
  std::optional<RawLayout> raw{};  ///< Layout of the values in a file that has no header.
  /// Effective radius of droplets where a NetCDF file has none [m]; 0: it must have.
  double effective_radius = 0;
};

/// A field with what there is to say about it.
struct LoadedField {
  Field field;
  std::vector<std::string> warnings;  ///< One sentence each, with file and grid.
  uint64_t clamped_voxels = 0;        ///< Negative ones set to 0.
  uint64_t invalid_voxels = 0;        ///< Number of voxels set to 0 by InvalidPolicy::kZero.
  uint64_t active_voxels = 0;         ///< Number of active voxels, those of active tiles included.
  uint64_t inactive_voxels = 0;       ///< Inactive ones that are not 0.
  uint64_t active_tiles = 0;
  /// Range of all values that are active or not 0, after clamping.
  float minimum = 0, maximum = 0;
  std::string length_unit, value_unit;  ///< Units, as GridInfo has them.

  /// Whether nothing is in it: a field of zeros, a voxel large.
  bool empty() const { return active_voxels + inactive_voxels == 0; }
};

/// Reads one grid into a brick map, leaf by leaf and in parallel: at no time is the grid in memory
/// twice. Doubles and whole numbers are rounded to float; of bool grids true is 1, of masks an
/// active voxel. Inactive voxels of leaves and inactive tiles keep their values, as the samplers of
/// OpenVDB see them, but for the background where that is not 0: it would fill all space, and
/// counts as 0, with a warning. A grid without any voxels is a field of zeros, with a warning. A
/// grid in the frustum of a camera is resampled to voxels of one size; a warning tells how well.
/// @throws Error, naming file, grid and voxel, if there is no such file or grid; the file is
///   truncated or damaged; the grid is a level set, of points or not scalar; its transform is not
///   invertible; or a value is NaN, infinite or out of the range of float (see
///   InvalidPolicy), or negative (see NegativePolicy)
LoadedField load_field(const std::filesystem::path& path, const LoadOptions& options = {});

/// Loads a grid of any number of channels: one field, or three of one transform and layout
/// for the densities of R, G and B that a grid of vectors holds.
/// @throws Error as load_field; about a value it names the channel too
std::vector<LoadedField> load_fields(const std::filesystem::path& path,
                                     const LoadOptions& options = {});

/// Takes what list_grids tells of a grid and what load_fields gives, which is empty where it can't
/// be loaded.
using GridVisitor = std::function<void(const GridInfo& info, std::vector<LoadedField> fields)>;

/// Reads the grids of a file, each once and one at a time being in memory, in the file's order.
/// @param only one of them; nothing is all
/// @param options the selection doesn't count
/// @throws Error as list_grids and find_grid, and what `use` throws
void visit_grids(const std::filesystem::path& path, const std::optional<GridSelection>& only,
                 const LoadOptions& options, const GridVisitor& use);

}  // namespace freepath
