// The choice between a control and the rest, shared by the decomposition trackers.

#if defined(FREEPATH_TRACKING_CONTROL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_CONTROL_INL_H_
#undef FREEPATH_TRACKING_CONTROL_INL_H_
#else
#define FREEPATH_TRACKING_CONTROL_INL_H_
#endif

#include <algorithm>

#include "freepath/tracking/collision-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Decides between the control and the rest, before any look-up [Kutz17, Sec. 5]. A control
/// collision is absorbed or scattered at once; otherwise the uniform number and the rate are left
/// as the choice among residual and null events needs them.
///
/// @param probability unnormalised probabilities of control absorption, control scattering, rest
/// @return the lanes that the control has decided
template <int N, class Coefficients>
HWY_INLINE MaskF choose_control(const WalkModes& modes, const Coefficients& control,
                                VecF (&probability)[3], Collision<N>& c) {
  merge_absorption(modes, probability[0], probability[1]);
  const VecF decided = hn::Add(probability[0], probability[1]);
  const VecF total = hn::Add(decided, probability[2]);
  // Leaves a number for the choice among the control's events, or among those of the rest.
  const MaskF by_control =
      hn::And(c.lanes, c.random.split(decided, probability[2], c.lanes, 0, c.uniform));
  set_events(hn::Mul(c.uniform, decided), probability[0], probability[1], c);
  c.absorb = hn::And(c.absorb, by_control);
  c.scatter = hn::And(c.scatter, by_control);

  const VecF rate_share = hn::Div(total, c.rate);
  const VecF scale =
      divide_or_zero(rate_share, hn::IfThenElse(c.absorb, probability[0], probability[1]));
  if (modes.emits) {
    const VecF share = modes.emission == EmissionTally::kCollision
                           ? hn::IfThenElseZero(by_control, divide_or_zero(rate_share, decided))
                           : hn::IfThenElseZero(emission_event(modes, c, by_control), scale);
    tally_emission<N>(control.emission, share, c);
  }
  for (int channel = 0; channel < N; ++channel) {
    const VecF coefficient =
        hn::IfThenElse(c.absorb, control.sigma_a[channel], control.sigma_s[channel]);
    assign(c.weight[channel], by_control, hn::Mul(c.weight[channel], hn::Mul(coefficient, scale)));
  }
  c.rate = hn::Mul(c.rate, divide_or_zero(probability[2], total));  // rate · P(rest)
  return by_control;
}

/// The same where channels share one extinction: P^c_e = mu^c_e/rate.
template <int N, class Coefficients>
HWY_INLINE MaskF decide_by_minimum(const WalkModes& modes, const Coefficients& control,
                                   Collision<N>& c) {
  VecF probability[3] = {channel_mean<N>(control.sigma_a), channel_mean<N>(control.sigma_s),
                         hn::Zero(kFloat)};
  probability[2] =
      hn::Max(hn::Sub(c.rate, hn::Add(probability[0], probability[1])), hn::Zero(kFloat));
  return choose_control<N>(modes, control, probability, c);
}

/// mu_n = rate - mu_t of each channel, where a control has decided first.
template <int N, class Residual>
HWY_INLINE void null_coefficients(const Residual& residual, const Collision<N>& c,
                                  VecF (&sigma_n)[N]) {
  for (int channel = 0; channel < N; ++channel) {
    sigma_n[channel] = hn::Sub(c.full_rate, residual.sigma_t[channel]);
  }
}

/// The least rate that leaves room for a residual next to the control, as a multiple of the
/// minorant. A rate that bounds the extinction does so by itself while the control is at most the
/// minorant; otherwise weights of the residual, which are at most (|mu^r| + |mu_n|)/(rate - mu^c),
/// stay below 3 where the control is in excess.
inline float control_rate_floor(float control, float rate_scale) {
  const float excess = control > 1 ? 2 * control - 1 : 0.0F;
  return rate_scale < 1 ? std::max(excess, 1.5F * control) : excess;
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_CONTROL_INL_H_
