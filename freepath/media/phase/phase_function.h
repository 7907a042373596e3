#pragma once
/// @file Any phase function, as a value.

#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/media/phase/draine.h"
#include "freepath/media/phase/droplets.h"
#include "freepath/media/phase/henyey_greenstein.h"
#include "freepath/media/phase/phase_mixture.h"
#include "freepath/media/phase/rayleigh.h"
#include "freepath/media/phase/tabulated_phase.h"

namespace freepath {

/// How light that scatters spreads over directions. It integrates to 1 over the sphere [1/sr] and
/// depends on the angle between the directions alone. Immutable, and cheap to copy: tables are
/// shared.
class PhaseFunction {
 public:
  /// Isotropic.
  PhaseFunction() : function_(HenyeyGreenstein(0.0F)) {}

  static PhaseFunction isotropic() { return {}; }

  /// See HenyeyGreenstein.
  /// @param g mean cosine
  /// @throws Error unless -1 < g < 1
  static PhaseFunction henyey_greenstein(float g);

  /// See Rayleigh.
  static PhaseFunction rayleigh() { return PhaseFunction(Rayleigh()); }

  /// See Draine.
  /// @throws Error unless -1 < g < 1 and 0 ≤ alpha
  static PhaseFunction draine(float g, float alpha);

  /// See Droplets.
  /// @param diameter of the droplets [µm]
  /// @throws Error unless it lies in (0, 50]
  static PhaseFunction droplets(float diameter);

  /// See TabulatedPhase.
  /// @throws Error for a table with a fault
  static PhaseFunction tabulated(std::span<const PhaseTablePoint> points);

  /// See PhaseMixture.
  /// @param parts weights, which must sum to 1 within 1e-4 and are normalised, and functions
  /// @throws Error for a negative weight or another sum
  static PhaseFunction mixture(const std::vector<std::pair<float, PhaseFunction>>& parts);

  /// Phase function for two directions of travel, unit vectors [1/sr]. It is also the density of
  /// sample().
  float evaluate(const Vec3f& before, const Vec3f& after) const {
    if (const auto* const hg = std::get_if<HenyeyGreenstein>(&function_)) {
      return hg->evaluate(before, after);
    }
    return evaluate_other(before, after);
  }

  /// Draws the direction of travel after an event, with the phase function for its density.
  /// @param before direction of travel, a unit vector
  /// @param u1,u2 uniform in [0, 1)
  PhaseSample sample(const Vec3f& before, float u1, float u2) const {
    if (const auto* const hg = std::get_if<HenyeyGreenstein>(&function_)) {
      return hg->sample(before, u1, u2);
    }
    return sample_other(before, u1, u2);
  }

  /// Mean of the cosine between the directions before and after.
  float mean_cosine() const;

  /// The function itself, if it is this one; else null.
  const HenyeyGreenstein* as_henyey_greenstein() const {
    return std::get_if<HenyeyGreenstein>(&function_);
  }

 private:
  using Function =
      std::variant<HenyeyGreenstein, Rayleigh, Draine, Droplets, TabulatedPhase, PhaseMixture>;

  explicit PhaseFunction(Function function) : function_(std::move(function)) {}
  float evaluate_other(const Vec3f& before, const Vec3f& after) const;
  PhaseSample sample_other(const Vec3f& before, float u1, float u2) const;

  Function function_;
};

struct PhaseMixture::Part {
  float weight;
  float begin;  ///< Sum of the weights before.
  PhaseFunction function;
};

}  // namespace freepath
