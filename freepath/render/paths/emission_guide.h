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
/// [Simon17]: a cell of a grid, then a point uniform in the cell. The density of a direction is
/// that of all points along it.
///
/// How probable a cell is depends on where one looks from, by a table over the parts of the medium:
/// it is what the cell emits, over the square of the distance, times a rough estimate of the
/// transmittance. A line collects emission without regard to the distance, but the more points a
/// solid angle holds the farther they are.
///
/// Positions are relative to the origin. Immutable, so threads share it.
class EmissionGuide {
 public:
  /// Cells of either side of the table: it has 12 bytes for each pair.
  static constexpr int kMostCells = 512;

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
  void fill_row(std::size_t row);
  /// Of a position: that of its receiver, or the last.
  std::size_t row_of(const Vec3f& position) const;
  float pdf(std::size_t row, const Vec3f& position, const Vec3f& direction) const;

  EmissionCells cells_;
  double power_ = 0;
  // Rows of emitters, one for each receiver and one for positions beyond them.
  std::vector<float> density_;  ///< Probability over volume, divided by 3 [1/m³].
  std::vector<AliasEntry> table_;
};

}  // namespace freepath
