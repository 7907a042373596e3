#pragma once
/// @file The Henyey-Greenstein phase function, isotropic scattering included.
///
/// A direction is always a unit vector of travel in world space, before and after the event, so
/// that a cosine of 1 means straight on. Nothing here branches on g, allocates or throws.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "freepath/base/tangent_frame.h"
#include "freepath/base/turn.h"
#include "freepath/base/vector.h"

namespace freepath {

/// A direction drawn from a phase function, and its density.
struct PhaseSample {
  Vec3f direction;
  float pdf;  ///< [1/sr]; also the value of the phase function.
};

/// The phase function of [Henyey41]; g is its mean cosine, 0 is isotropic, g > 0 scatters forward.
///
///     p(cosine) = (1 - g²) / (4π (1 + g² - 2 g cosine)^(3/2))
///
/// Evaluated through the distance from the peak, which is 1 - cosine for g > 0, because the
/// denominator as written cancels at the peak: with s = |g|,
/// 1 + g² - 2 g cosine = (1 - s)² + 2 s (1 ∓ cosine). The lanes do the same in the same order
/// (henyey_greenstein-inl.h).
class HenyeyGreenstein {
 public:
  /// @param g mean cosine, |g| < 1; whoever takes it from a user checks it
  explicit HenyeyGreenstein(float g)
      : sharpness_(std::abs(g)), sign_(std::copysign(1.0F, g)), gap_(1.0F - std::abs(g)) {}

  float g() const { return sign_ * sharpness_; }

  /// Phase function at a cosine between the directions before and after [1/sr]. It integrates to 1
  /// over the sphere. Close to the peak of a |g| > 0.99 the rounding of the cosine itself shows;
  /// the form that takes two directions has no such loss.
  float evaluate(float cosine) const {
    return evaluate_at(2.0F * std::max(0.0F, 1.0F - sign_ * cosine));
  }

  /// Phase function for two directions of travel [1/sr], accurate at the peak.
  float evaluate(const Vec3f& before, const Vec3f& after) const {
    return evaluate_at((after - before * sign_).length2());
  }

  /// Draws the direction after an event with a density that is the phase function itself.
  ///
  /// Inverts the distribution function [Henyey41] for the squared sine of half the angle from the
  /// peak, h = (1-s)² u (1 + s - s u) / (1 + s - 2 s u)², which holds for every s in [0, 1): the
  /// textbook's form for the cosine divides by g and loses all digits for small ones.
  /// @param u1,u2 uniform in [0, 1)
  PhaseSample sample(const Vec3f& before, float u1, float u2) const {
    const float s = sharpness_;
    const float ratio = gap_ / (gap_ + 2.0F * s * (1.0F - u1));  // 1 + s - 2 s u
    const float h = std::min(1.0F, ratio * ratio * u1 * (1.0F + s * (1.0F - u1)));
    const float sine = 2.0F * std::sqrt(h * (1.0F - h));
    const SinCos azimuth = sincos_of_turn(u2);
    const TangentFrame frame(before * sign_);
    const Vec3f after = frame.to_world(sine * azimuth.cosine, sine * azimuth.sine, 1.0F - 2.0F * h);
    // Normalised, so that rounding doesn't build up over thousands of events.
    return {after * (1.0F / std::sqrt(after.length2())), evaluate_at(4.0F * h)};
  }

 private:
  /// @param distance2 squared distance between the direction and the peak, as points of the sphere
  float evaluate_at(float distance2) const {
    const float d = gap_ * gap_ + sharpness_ * distance2;
    return gap_ * (1.0F + sharpness_) / (4.0F * std::numbers::pi_v<float> * d * std::sqrt(d));
  }

  float sharpness_;  // |g|
  float sign_;       // of g; the peak is at sign · before
  float gap_;        // 1 - |g|
};

}  // namespace freepath
