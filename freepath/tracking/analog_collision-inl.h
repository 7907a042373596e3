// The collision of delta tracking.

#if defined(FREEPATH_TRACKING_ANALOG_COLLISION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_ANALOG_COLLISION_INL_H_
#undef FREEPATH_TRACKING_ANALOG_COLLISION_INL_H_
#else
#define FREEPATH_TRACKING_ANALOG_COLLISION_INL_H_
#endif

#include "freepath/tracking/collision-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

template <int N, class Coefficients>
HWY_INLINE void add_analog_emission(const WalkModes& modes, const Coefficients& sigma,
                                    MaskF collided, Collision<N>& c) {
  VecF share = hn::Div(set(1.0F), c.rate);
  if (modes.emission == EmissionTally::kAnalog) {
    const MaskF counted = emission_event<N>(modes, c, collided);
    const VecF real =
        hn::Add(channel_mean<N>(sigma.sigma_a), modes.absorption == Absorption::kWeighted
                                                    ? channel_mean<N>(sigma.sigma_s)
                                                    : hn::Zero(kFloat));
    share = hn::IfThenElseZero(counted, divide_or_zero(set(1.0F), real));
  }
  for (int channel = 0; channel < N; ++channel) {
    c.emitted[channel] =
        mul_add(hn::Mul(c.weight[channel], sigma.emission[channel]), share, c.emitted[channel]);
  }
}

/// P_e = mu_e/rate: real collisions happen with their own probability, and the weight of a null
/// collision is exactly 1 [Woodcock65].
template <int N, class Coefficients>
HWY_INLINE void collide_by_delta(const WalkModes& modes, const Coefficients& sigma,
                                 Collision<N>& c) {
  const VecF absorb = channel_mean<N>(sigma.sigma_a);
  const VecF scatter = channel_mean<N>(sigma.sigma_s);
  const VecF real = hn::Add(absorb, scatter);
  const bool weighted = modes.absorption == Absorption::kWeighted;
  const VecF scatter_share = weighted ? real : scatter;
  const MaskF collided = set_events(hn::Mul(c.uniform, c.rate),
                                    weighted ? hn::Zero(kFloat) : absorb, scatter_share, c);
  if (modes.emits) add_analog_emission<N>(modes, sigma, collided, c);
  if (N == 1 && !weighted) return;  // every weight is 1
  const VecF per_share = hn::Div(
      set(1.0F),
      hn::IfThenElse(c.absorb, absorb, hn::IfThenElse(c.scatter, scatter_share, set(1.0F))));
  for (int channel = 0; channel < N; ++channel) {
    const VecF coefficient =
        hn::IfThenElse(c.absorb, sigma.sigma_a[channel], sigma.sigma_s[channel]);
    assign(c.weight[channel], collided,
           hn::Mul(c.weight[channel], hn::Mul(coefficient, per_share)));
  }
}

/// The law of delta tracking, whatever is looked up.
struct DeltaLaw : MethodTraits {
  static constexpr bool kNeedsBound = true;

  template <class Bounds>
  HWY_INLINE VecF rate(const Bounds& bounds) const {
    return bounds.majorant[0];
  }

  template <int N, class Coefficients>
  HWY_INLINE void collide(const WalkModes& modes, const Coefficients& sigma,
                          Collision<N>& c) const {
    collide_by_delta<N>(modes, sigma, c);
  }
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_ANALOG_COLLISION_INL_H_
