#pragma once
/// @file A medium as the lanes read it: plain pointers and numbers.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "freepath/base/sampled_spectrum.h"
#include "freepath/media/medium.h"
#include "freepath/media/medium_channels.h"

namespace freepath {

/// A RadianceField as the lanes read it.
struct RadianceView {
  const uint32_t* index = nullptr;  ///< Null: there is none.
  const float* voxels = nullptr;
  std::array<int32_t, 3> brick_counts{};
  AffineMap walk_to_voxels;
  const float* table = nullptr;  ///< Null: the field is the radiance.
  float first = 0;               ///< Field at the first value of the table.
  float per_step = 1;            ///< Values of the table per unit of the field.
  float last = 0;                ///< Number of its last value.
};

/// Cross sections of one component in the channels that a walk carries [1/m per density].
struct ComponentView {
  const uint32_t* index = nullptr;            ///< Brick of each index entry.
  const float* voxels = nullptr;              ///< Voxels of the bricks.
  const DensityFunction* function = nullptr;  ///< Density in place of both, if set.
  std::array<int32_t, 3> brick_counts{};      ///< Size of the index along each axis.
  AffineMap walk_to_voxels;  ///< Walk space → position in the voxels; used unless aligned.
  std::array<float, kMaxChannels> sigma_a{};
  std::array<float, kMaxChannels> sigma_s{};
  std::array<float, kMaxChannels> emission{};        ///< sigma_a · L_e, where that does not vary.
  const RadianceView* radiance = nullptr;            ///< Emission of each channel, where it does;
  std::array<float, kMaxChannels> radiance_scale{};  ///< and what it is multiplied by, sigma_a too.
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
  /// Number of the medium's components; a record of `cells` has as many numbers.
  int component_count = 0;
  /// Components that scatter or absorb in one of the channels, at least one: all others are of no
  /// matter to a walk, and are not looked up.
  std::span<const int32_t> matter() const { return {matter_.data(), matter_count_}; }
  int channels = 1;  ///< Number of the paths' channels; a walk of more repeats them.
  std::array<ComponentView, Medium::kMaxComponents> components{};
  /// What the components' radiance points at; null where emission does not vary.
  std::shared_ptr<const std::vector<RadianceView>> radiance_views{};

  /// The channel of a path that a channel of the walk stands for.
  int source(int channel) const { return channel < channels ? channel : channel % channels; }

  /// Finds the components that matter, by their cross sections.
  void find_matter();

 private:
  std::array<int32_t, Medium::kMaxComponents> matter_{};
  std::size_t matter_count_ = 0;
};

/// The view of a medium that is one part, or of the first of several.
/// @param channels of its components; their fields must live as long. A walk of more channels than
///   these meets them again from the first one on.
/// @param origin what positions of rays are relative to [world]
MediumView view_of(const Medium& medium, Interpolation interpolation,
                   const MediumChannels& channels, const Vec3d& origin = Vec3d(0));

/// What the components' radiance points at in a part of a medium; null where emission does not
/// vary.
std::shared_ptr<const std::vector<RadianceView>> radiance_views_of(const Medium& medium,
                                                                   const WalkPart& part,
                                                                   const MediumChannels& channels);

/// Turns the view of a medium into that of one of its parts.
/// @param origin what positions of rays are relative to [world]
/// @param radiance radiance_views_of() that part
void show_part(const Medium& medium, const WalkPart& part, const Vec3d& origin,
               std::shared_ptr<const std::vector<RadianceView>> radiance, MediumView& view);

}  // namespace freepath
