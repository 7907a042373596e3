#pragma once
/// @file Directions towards the light of an emissive medium.

#include <cstdint>
#include <optional>
#include <vector>

#include "freepath/base/random.h"
#include "freepath/base/vector.h"
#include "freepath/render/paths/emission_cells.h"
#include "freepath/render/sampling.h"

namespace freepath {

/// A direction that was drawn.
struct GuideSample {
  Vec3f direction;  ///< Unit [world].
  float pdf = 0;    ///< [1/sr]
};

/// Draws directions towards points of an emissive medium, for what a whole line through it emits
/// [Simon17]: a cell of a grid by what it emits, then a point uniform in the cell. The density of a
/// direction is that of all points along it. Positions are relative to the origin. Immutable, so
/// threads share it.
class EmissionGuide {
 public:
  static constexpr int kResolution = 32;  ///< Cells along the longest edge of a medium.

  /// @param origin that positions are relative to [world]
  EmissionGuide(const BoundMedium& bound, const Vec3d& origin, int resolution = kResolution)
      : EmissionGuide(estimate_emission(bound, origin, resolution)) {}
  explicit EmissionGuide(EmissionCells cells);

  /// Mean emission times volume, about [radiance · m²]; 0 where there is nothing to draw.
  double power() const { return power_; }

  /// Draws a direction; none where nothing emits.
  std::optional<GuideSample> sample(const Vec3f& position, RandomStream& random) const;

  /// The density of a direction [1/sr].
  /// @param direction unit [world]
  float pdf(const Vec3f& position, const Vec3f& direction) const;

  const EmissionCells& cells() const { return cells_; }

 private:
  EmissionCells cells_;
  double power_ = 0;
  /// Probability of a cell over its volume, divided by 3 [1/m³].
  std::vector<float> density_;
  std::vector<uint32_t> occupied_;  ///< Cells that emit.
  std::vector<AliasEntry> table_;   ///< Of occupied_.
  Vec3i first_{0}, last_{-1};       ///< Bounds of the cells that emit, inclusive.
};

}  // namespace freepath
