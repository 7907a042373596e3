// Transmittance by residual ratio tracking.

#if defined(FREEPATH_TRACKING_RESIDUAL_RATIO_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_RESIDUAL_RATIO_INL_H_
#undef FREEPATH_TRACKING_RESIDUAL_RATIO_INL_H_
#else
#define FREEPATH_TRACKING_RESIDUAL_RATIO_INL_H_
#endif

#include "freepath/tracking/method.h"
#include "freepath/tracking/random-inl.h"
#include "freepath/tracking/roulette-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// exp(-∫mu^c) times the product of 1 - mu^r/rate^r over the tentative collisions with the residual
/// [Novak14, Eq. 17]. The control is the super-voxel's minimum: where the medium is homogeneous no
/// collision is left.
struct ResidualRatio : MethodTraits {
  static constexpr MethodOption kOptions[] = {
      {"rate-scale", 1.0F, 1e-3F, 1e3F,
       "rate of tentative collisions, as a multiple of the residual's majorant"},
      {"roulette", 0.1F, 0.0F, 1.0F,
       "product below which Russian roulette is played, 0 for never"}};
  static constexpr MethodInfo kInfo = {
      "residual-ratio",
      "the minimum of each super-voxel in closed form, ratio tracking of the rest",
      "",
      "always; below a rate scale of 1 estimates may be negative",
      "[Novak14, Eq. 17]",
      kOptions,
      /*chromatic=*/true};
  static constexpr bool kControl = true;
  static constexpr bool kDecides = false;
  static constexpr bool kRateNeedsControl = true;
  static constexpr bool kAdvances = true;
  /// ∫mu^c of each channel.
  template <int N>
  static constexpr int kRows = N;

  explicit ResidualRatio(std::span<const float> options)
      : rate_scale(options[0]), roulette(options[1]) {}

  float control_scale() const { return 1.0F; }
  template <int N>
  float row_start(int /*row*/) const {
    return 0.0F;
  }

  template <class Bounds>
  HWY_INLINE VecF rate(const Bounds& bounds) const {
    VecF largest = hn::Zero(kFloat);
    for (size_t channel = 0; channel < std::size(bounds.majorant); ++channel) {
      largest = hn::Max(largest, hn::Sub(bounds.majorant[channel], bounds.minorant[channel]));
    }
    return hn::Mul(largest, set(rate_scale));
  }

  template <int N, class Bounds>
  HWY_INLINE void advance(const Bounds& bounds, VecF length, VecF* rows) const {
    for (int channel = 0; channel < N; ++channel) {
      rows[channel] = mul_add(bounds.minorant[channel], length, rows[channel]);
    }
  }

  template <int N, class Coefficients>
  HWY_INLINE void collide(const WalkModes& /*modes*/, const Coefficients& residual,
                          Collision<N>& c) const {
    const VecF per_rate = hn::Div(set(1.0F), c.rate);
    for (int channel = 0; channel < N; ++channel) {
      const VecF sigma = hn::Add(residual.sigma_a[channel], residual.sigma_s[channel]);
      c.weight[channel] = hn::Mul(c.weight[channel], hn::Mul(hn::Sub(c.rate, sigma), per_rate));
    }
    play_roulette<N>(roulette, c);
  }

  template <int N>
  HWY_INLINE void finish(const VecF* rows, VecF /*depth*/, VecF (&weight)[N]) const {
    for (int channel = 0; channel < N; ++channel) {
      weight[channel] = hn::Mul(weight[channel], exp_of_negative(hn::Neg(rows[channel])));
    }
  }

  float rate_scale;
  float roulette;
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_RESIDUAL_RATIO_INL_H_
