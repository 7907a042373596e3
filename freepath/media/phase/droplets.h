#pragma once
/// @file The phase function of fog and clouds.

#include "freepath/base/vector.h"
#include "freepath/media/phase/draine.h"
#include "freepath/media/phase/henyey_greenstein.h"

namespace freepath {

/// Water droplets in air, by the fit of [Jendersie23] to Mie's theory, averaged over sizes:
///
///     p = (1 - w) HenyeyGreenstein(g_hg) + w Draine(g_d, alpha)
///
/// with four functions of the diameter, given piecewise below 0.1 µm (where it tends to Rayleigh's
/// function), to 1.5 µm, to 5 µm (haze and mist) and from 5 µm on (fog and cloud). At these borders
/// it jumps by 0.02 or less in the mean cosine, but by up to two thirds in its peak. Colour is not
/// part of the fit: its mean cosine is nearest to that of water at a wavelength of 0.4 µm. Coronas,
/// fog bow and glory are smoothed away.
class Droplets {
 public:
  /// The largest diameter of the fit [µm].
  static constexpr float kLargestDiameter = 50.0F;

  /// What the fit says.
  struct Parameters {
    float g_hg;    ///< mean cosine of the peak
    float g_d;     ///< g of Draine's function
    float alpha;   ///< alpha of Draine's function
    float weight;  ///< share of Draine's function
  };
  /// @param diameter [µm], in (0, kLargestDiameter]; whoever takes it from a user checks it
  static Parameters fit(float diameter);

  explicit Droplets(float diameter) : Droplets(fit(diameter)) {}

  /// Phase function for two directions of travel [1/sr].
  float evaluate(const Vec3f& before, const Vec3f& after) const {
    return (1.0F - weight_) * peak_.evaluate(before, after) +
           weight_ * rest_.evaluate(before, after);
  }

  /// Draws the direction after an event, with the phase function for its density.
  /// @param u1,u2 uniform in [0, 1)
  PhaseSample sample(const Vec3f& before, float u1, float u2) const;

  float mean_cosine() const { return (1.0F - weight_) * peak_.g() + weight_ * rest_.mean_cosine(); }

 private:
  explicit Droplets(const Parameters& parameters);

  HenyeyGreenstein peak_;
  Draine rest_;
  float weight_;  // of the rest
};

}  // namespace freepath
