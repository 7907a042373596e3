// Transmittance by ratio tracking.

#if defined(FREEPATH_TRACKING_RATIO_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_RATIO_INL_H_
#undef FREEPATH_TRACKING_RATIO_INL_H_
#else
#define FREEPATH_TRACKING_RATIO_INL_H_
#endif

#include "freepath/tracking/method.h"
#include "freepath/tracking/roulette-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// The product of mu_n/rate over all tentative collisions [Novak14, Eq. 14]. Once the product is
/// small, Russian roulette ends rays whose rest would cost more than it is worth.
struct Ratio : MethodTraits {
  static constexpr MethodOption kOptions[] = {
      {"rate-scale", 1.0F, 1e-3F, 1e3F,
       "rate of tentative collisions, as a multiple of the majorant"},
      {"roulette", 0.1F, 0.0F, 1.0F, "weight below which Russian roulette is played, 0 for never"}};
  static constexpr MethodInfo kInfo = {"ratio",
                                       "the product of the null probabilities along the ray",
                                       "",
                                       "always; below a rate scale of 1 estimates may be negative",
                                       "[Novak14, Eq. 14]",
                                       kOptions,
                                       /*chromatic=*/true};

  explicit Ratio(std::span<const float> options) : rate_scale(options[0]), roulette(options[1]) {}

  template <class Bounds>
  HWY_INLINE VecF rate(const Bounds& bounds) const {
    return hn::Mul(channel_max(bounds.majorant), set(rate_scale));
  }

  template <int N, class Coefficients>
  HWY_INLINE void collide(const WalkModes& /*modes*/, const Coefficients& sigma,
                          Collision<N>& c) const {
    const VecF per_rate = hn::Div(set(1.0F), c.rate);
    for (int channel = 0; channel < N; ++channel) {
      const VecF sigma_t = hn::Add(sigma.sigma_a[channel], sigma.sigma_s[channel]);
      const VecF ratio = hn::Mul(hn::Sub(c.rate, sigma_t), per_rate);
      c.weight[channel] = hn::Mul(c.weight[channel], ratio);
    }
    play_roulette<N>(roulette, c);
  }

  float rate_scale;
  float roulette;
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_RATIO_INL_H_
