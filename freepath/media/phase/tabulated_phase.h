#pragma once
/// @file A phase function given by numbers.

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/media/phase/henyey_greenstein.h"

namespace freepath {

/// One row of a table.
struct PhaseTablePoint {
  double angle;  ///< Angle between the directions of travel before and after [degrees].
  double value;  ///< Phase function there, in any unit: the table is normalised.
};

/// What is wrong with a table.
struct PhaseTableFault {
  std::size_t point;  ///< Index of the point to blame.
  std::string what;
};

/// The first fault of a table: angles must rise from 0 to 180, values be finite, at least 0 and not
/// all 0.
std::optional<PhaseTableFault> find_fault(std::span<const PhaseTablePoint> points);

/// A phase function that is linear in the cosine between the points of a table. Its distribution
/// function is then quadratic from point to point, so that sampling inverts exactly what evaluation
/// and normalisation see. Copies share the table.
class TabulatedPhase {
 public:
  /// @param points without a fault
  explicit TabulatedPhase(std::span<const PhaseTablePoint> points);

  /// Phase function for two directions of travel [1/sr], accurate at 0 and 180 degrees.
  float evaluate(const Vec3f& before, const Vec3f& after) const;

  /// Draws the direction after an event, with the phase function for its density.
  /// @param u1,u2 uniform in [0, 1)
  PhaseSample sample(const Vec3f& before, float u1, float u2) const;

  float mean_cosine() const { return table_->mean_cosine; }

 private:
  struct Table {
    std::vector<double> h;       // (1 - cosine) / 2 of each point, from 0 to 1
    std::vector<double> value;   // [1/sr], normalised
    std::vector<double> chance;  // P(a sample lies before the point), from 0 to 1
    float mean_cosine = 0.0F;
  };
  std::shared_ptr<const Table> table_;
};

}  // namespace freepath
