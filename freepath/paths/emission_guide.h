#pragma once
/// @file Directions towards the light of an emissive medium.

#include <cstdint>
#include <optional>
#include <vector>

#include "freepath/base/distributions.h"
#include "freepath/base/random.h"
#include "freepath/base/vector.h"
#include "freepath/paths/emission_cells.h"

namespace freepath {

/// A direction that was drawn.
struct GuideSample {
  Vec3f direction;  ///< Unit [world].
  float pdf = 0;    ///< [1/sr]
};

/// Draws directions towards points of an emissive medium, for what a whole line through it emits
/// [Simon17]: a cell of a grid by what it emits, then a point uniform in the cell. The density of a
/// direction is that of all points along it.
///
/// Cells are drawn without regard to where one looks from: what is near fills so much of the sphere
/// that the phase function finds it. (In a fireball, weights by distance and by transmittance left
/// the variance of both techniques together as it was or raised it.)
///
/// Positions are relative to the origin. Immutable, so threads share it.
class EmissionGuide {
 public:
  /// More of them cost time, and left the variance of a fireball as it was.
  static constexpr int kMostCells = 1024;

  /// @param origin that positions are relative to [world]
  EmissionGuide(const BoundMedium& bound, const Vec3d& origin, int most_cells = kMostCells)
      : EmissionGuide(estimate_emission(bound, origin, most_cells)) {}
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
  std::vector<float> density_;     ///< Probability of a cell over its volume, divided by 3 [1/m³].
  std::vector<AliasEntry> table_;  ///< Alias table of the cells.
};

}  // namespace freepath
