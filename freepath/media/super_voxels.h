#pragma once
/// @file Super-voxels [SzirmayKalos11]: bounds of the densities over coarse cells.

#include <cstdint>
#include <span>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/media/brick_map.h"
#include "freepath/media/voxel_range.h"

namespace freepath {

/// Minimum and maximum of each component's density over a grid of cubic cells, *as the interpolant
/// sees it*: the voxels of a cell dilated by one, which is the reach of the trilinear filter. They
/// bound nearest, trilinear and stochastic interpolation alike, and a position that rounding moves
/// just over a cell's face still reads voxels that the cell has counted.
///
/// Cell (x,y,z) covers the voxels [cell_size·x, cell_size·(x+1)) counted from the first voxel of
/// the brick map's index, or of the WalkPart. Entries are stored x slowest: cell = (x · ny + y) ·
/// nz
/// + z.
struct SuperVoxels {
  int cell_size = 8;          ///< Edge of a cell [voxels].
  Vec3i counts{0};            ///< Cells along each axis.
  int components = 1;         ///< Densities per cell.
  std::vector<float> minima;  ///< [cell · components + component]
  std::vector<float> maxima;  ///< [cell · components + component]
  /// Chebyshev radius of the empty cube around a cell [cells]: with radius r every cell nearer than
  /// r along all axes is empty (0: the cell itself is not). A walk leaves the whole cube in a step.
  std::vector<int32_t> empty_radius;
  /// Steps that the search for empty cubes took; in proportion to the cells.
  std::size_t radius_steps = 0;

  std::size_t cell_count() const { return empty_radius.size(); }
  std::size_t memory_bytes() const;
};

/// What the cells of one component are like.
struct SuperVoxelSummary {
  std::size_t cells = 0;
  std::size_t occupied = 0;  ///< Cells whose maximum is not 0.
  double mean_maximum = 0;   ///< Over the occupied cells.
  double mean_minimum = 0;   ///< Over the occupied cells; its share of the maximum is what a
                             ///< control of minima can decide without a look-up.
  void merge(const SuperVoxelSummary& other);
};

SuperVoxelSummary summarize(const SuperVoxels& cells, int component = 0);

/// Edge lengths that build_super_voxels chooses from [voxels].
inline constexpr int kSuperVoxelSizes[] = {4, 8, 16, 32, 64};

/// What the choice of the cell size weighs against each other.
struct SuperVoxelCost {
  double step = 1.0;    ///< Cost of a step into the next cell [relative].
  double lookup = 2.5;  ///< Cost of a tentative collision and its look-up [relative].
};

/// A component's voxels, and where they stand in the grid that is cut into cells.
///
/// The bounds of a cell are those of the voxels that the cell's own box of positions covers, grown
/// by one. A tap of the trilinear filter reads half a voxel less far: so much a position may be
/// off.
struct PlacedVoxels {
  const VoxelRanges* ranges = nullptr;  ///< Ranges of the component's map.
  BrickWindow window;                   ///< What of the map the grid reaches.
  Matrix4d to_component;  ///< Position in the grid → position in the window; see WalkSpace.
};

/// How many cells are not too many.
struct CellLimits {
  static constexpr std::size_t kFew = std::size_t{4} << 20;

  std::size_t few = kFew;   ///< So many may have 4 voxels a side,
  std::size_t most = kFew;  ///< and so many 8 or more.
};

/// Builds the super-voxels of densities over a grid of voxels. A voxel beyond a window is 0.
///
/// @param densities the components
/// @param voxel_counts extent of the grid
/// @param extinction the largest extinction per unit of density of each component, per voxel edge
///   of the grid [1/voxel]; only the choice of the size depends on it
/// @param cell_size one of kSuperVoxelSizes, or 0 to take the one with the least expected cost of
///   a unit of length: steps cost 1.5/cell_size, look-ups the mean majorant of the cells that are
///   not empty. Within the limits it may be larger than any of those.
/// @throws Error for another cell_size, or one that makes too many cells
SuperVoxels build_super_voxels(std::span<const PlacedVoxels> densities, const Vec3i& voxel_counts,
                               std::span<const float> extinction, int cell_size,
                               const CellLimits& limits = {}, const SuperVoxelCost& cost = {});

/// Super-voxels for densities that share origin and brick counts, whose voxels are the grid. Their
/// indices must be dense.
SuperVoxels build_super_voxels(std::span<const BrickMap* const> densities,
                               std::span<const float> extinction, int cell_size,
                               const SuperVoxelCost& cost = {});

}  // namespace freepath
