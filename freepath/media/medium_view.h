#pragma once
/// @file A medium as the lanes read it: plain pointers and numbers.

#include <array>
#include <cstdint>

#include "freepath/media/medium.h"

namespace freepath {

/// Cross sections of one component in the channels that a walk carries [1/m per density].
struct ComponentView {
  const uint32_t* index = nullptr;            ///< Brick of each index entry.
  const float* voxels = nullptr;              ///< Voxels of the bricks.
  const DensityFunction* function = nullptr;  ///< In place of both, if set.
  std::array<int32_t, 3> brick_counts{};      ///< Of the index.
  AffineMap walk_to_voxels;  ///< Walk space → place in the voxels; used unless aligned.
  std::array<float, kChannels> sigma_a{};
  std::array<float, kChannels> sigma_s{};
  std::array<float, kChannels> emission{};  ///< sigma_a · L_e
};

/// A borrowed view of a Medium, valid while that lives.
struct MediumView {
  std::array<int32_t, 3> cell_counts{};
  int32_t cell_size = 1;
  const float* cells = nullptr;       ///< Medium::walk_cells()
  const float* minima = nullptr;      ///< SuperVoxels::minima
  std::array<float, 3> bounds_min{};  ///< Where the walk takes place [walk space].
  std::array<float, 3> bounds_max{};
  AffineMap world_to_walk;
  Interpolation interpolation = Interpolation::kTrilinear;
  std::array<float, 3> cell_origin{};  ///< Corner and edges of the first cell [world], where
  std::array<float, 3> cell_edge{};    ///< densities are computed.
  bool aligned = true;                 ///< Medium::aligned(): one voxel serves all components.
  int component_count = 0;
  std::array<ComponentView, Medium::kMaxComponents> components{};
};

/// @param channel the one channel to carry, or -1 for all of them
/// @param origin what positions of rays are relative to [world]
MediumView view_of(const Medium& medium, Interpolation interpolation, int channel,
                   const Vec3d& origin = Vec3d(0));

}  // namespace freepath
