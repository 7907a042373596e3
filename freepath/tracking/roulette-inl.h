// Russian roulette on weights that have grown small.

#if defined(FREEPATH_TRACKING_ROULETTE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_ROULETTE_INL_H_
#undef FREEPATH_TRACKING_ROULETTE_INL_H_
#else
#define FREEPATH_TRACKING_ROULETTE_INL_H_
#endif

#include "freepath/tracking/collision-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Weights below it end: products of numbers with fewer digits round to themselves, and would never
/// become 0.
inline constexpr float kSmallestWeight = 0x1p-126F;

/// The factor on what survives, 0 for what does not: lanes whose `largest` lies below the threshold
/// go on with probability largest/threshold, the others always.
HWY_INLINE VecF roulette_gain(float threshold, VecF largest, VecF uniform) {
  const MaskF played = hn::Lt(largest, set(threshold));
  const VecF survival = hn::Mul(largest, set(threshold > 0 ? 1.0F / threshold : 0.0F));
  const MaskF ends =
      hn::Or(hn::AndNot(hn::Lt(uniform, survival), played), hn::Lt(largest, set(kSmallestWeight)));
  const VecF gain = hn::IfThenElse(played, divide_or_zero(set(1.0F), survival), set(1.0F));
  return hn::IfThenZeroElse(ends, gain);
}

/// Ends rays whose largest weight is 0 or has lost the roulette; weights of the others grow.
template <int N>
HWY_INLINE void play_roulette(float threshold, Collision<N>& c) {
  VecF largest = hn::Zero(kFloat);
  for (int channel = 0; channel < N; ++channel) {
    largest = hn::Max(largest, hn::Abs(c.weight[channel]));
  }
  const VecF gain = roulette_gain(threshold, largest, c.uniform);
  c.absorb = hn::Eq(gain, hn::Zero(kFloat));
  for (int channel = 0; channel < N; ++channel) {
    c.weight[channel] = hn::Mul(c.weight[channel], gain);
  }
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_ROULETTE_INL_H_
