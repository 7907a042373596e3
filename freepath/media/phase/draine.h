#pragma once
/// @file The phase function of interstellar dust, which lies between those of Henyey and Rayleigh.

#include <algorithm>
#include <cmath>

#include "freepath/base/vector.h"
#include "freepath/media/phase/henyey_greenstein.h"

namespace freepath {

/// The phase function of [Draine03]: Henyey-Greenstein's for alpha = 0, Rayleigh's for g = 0 and
/// alpha = 1, that of Cornette and Shanks for alpha = 1.
///
///     p(cosine) = (1 - g²) (1 + alpha cosine²)
///                 / (4π (1 + alpha (1 + 2 g²) / 3) (1 + g² - 2 g cosine)^(3/2))
///
/// The denominator is evaluated through the distance from the peak, as in HenyeyGreenstein.
class Draine {
 public:
  /// @param g |g| < 1
  /// @param alpha at least 0; whoever takes the two from a user checks them
  Draine(float g, float alpha);

  /// Phase function for two directions of travel [1/sr], accurate at the peak.
  float evaluate(const Vec3f& before, const Vec3f& after) const {
    return evaluate_at((after - before * sign_).length2());
  }

  /// Draws the direction after an event, with the phase function for its density.
  /// @param u1,u2 uniform in [0, 1)
  PhaseSample sample(const Vec3f& before, float u1, float u2) const;

  /// g (1 + alpha (3 + 2 g²) / 5) / (1 + alpha (1 + 2 g²) / 3) [Draine03].
  float mean_cosine() const;

 private:
  /// @param distance2 squared distance between the direction and the peak, as points of the sphere
  float evaluate_at(float distance2) const {
    const float d = gap_ * gap_ + sharpness_ * distance2;
    const float cosine = 1.0F - 0.5F * distance2;
    return scale_ * (1.0F + alpha_ * cosine * cosine) / (d * std::sqrt(d));
  }
  double quantile(double u) const;

  float sharpness_;  // |g|
  float sign_;       // of g; the peak is at sign · before
  float gap_;        // 1 - |g|
  float alpha_;
  float scale_;  // all that does not depend on the direction
};

}  // namespace freepath
