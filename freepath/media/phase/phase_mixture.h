#pragma once
/// @file A weighted sum of phase functions.

#include <memory>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/media/phase/henyey_greenstein.h"

namespace freepath {

class PhaseFunction;

/// p = Σ weight p_i, of any phase functions. A sample is drawn from one of them, picked by its
/// weight; its density is that of the sum. Copies share the parts.
class PhaseMixture {
 public:
  struct Part;

  /// @param parts with weights that sum to 1, none of them 0
  explicit PhaseMixture(std::vector<Part> parts);

  /// Phase function for two directions of travel [1/sr].
  float evaluate(const Vec3f& before, const Vec3f& after) const;

  /// Draws the direction after an event, with the phase function for its density.
  /// @param u1,u2 uniform in [0, 1)
  PhaseSample sample(const Vec3f& before, float u1, float u2) const;

  float mean_cosine() const;

 private:
  std::shared_ptr<const std::vector<Part>> parts_;
};

}  // namespace freepath
