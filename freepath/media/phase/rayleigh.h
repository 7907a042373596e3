#pragma once
/// @file The phase function of molecules.

#include <algorithm>
#include <numbers>

#include "freepath/base/vector.h"
#include "freepath/media/phase/cubic.h"
#include "freepath/media/phase/direction_around.h"
#include "freepath/media/phase/henyey_greenstein.h"

namespace freepath {

/// Scattering of unpolarised light by particles much smaller than its wavelength
/// [Chandrasekhar60], without depolarisation:
///
///     p(cosine) = 3 (1 + cosine²) / (16π)
class Rayleigh {
 public:
  /// Phase function for two directions of travel [1/sr].
  float evaluate(const Vec3f& before, const Vec3f& after) const {
    return evaluate(before.dot(after));
  }

  /// Phase function at a cosine between the directions before and after [1/sr].
  float evaluate(float cosine) const {
    return 3.0F / (16.0F * std::numbers::pi_v<float>)*(1.0F + cosine * cosine);
  }

  /// Draws the direction after an event, with the phase function for its density: the distribution
  /// function (4 + 3 c + c³) / 8 of the cosine is inverted by Cardano's formula.
  /// @param u1,u2 uniform in [0, 1)
  PhaseSample sample(const Vec3f& before, float u1, float u2) const {
    const double cosine = std::clamp(solve_rising_cubic(1.0, 2.0 - 4.0 * double{u1}), -1.0, 1.0);
    return {direction_around(before, 0.5 * (1.0 - cosine), u2),
            evaluate(static_cast<float>(cosine))};
  }

  float mean_cosine() const { return 0.0F; }
};

}  // namespace freepath
