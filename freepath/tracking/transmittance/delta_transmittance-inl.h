// Transmittance by delta tracking.

#if defined(FREEPATH_TRACKING_DELTA_TRANSMITTANCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_DELTA_TRANSMITTANCE_INL_H_
#undef FREEPATH_TRACKING_DELTA_TRANSMITTANCE_INL_H_
#else
#define FREEPATH_TRACKING_DELTA_TRANSMITTANCE_INL_H_
#endif

#include "freepath/tracking/collision-inl.h"
#include "freepath/tracking/method.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// 1 if no real collision happens, else 0 [Woodcock65; Novak18, Sec. 5]. Channels share positions
/// and random numbers, and drop out one by one.
struct DeltaTransmittance : MethodTraits {
  static constexpr MethodInfo kInfo = {"delta",
                                       "1 if the ray passes without a real collision, else 0",
                                       "",
                                       "if the rate bounds the extinction, as super-voxels do",
                                       "[Novak18, Sec. 5]",
                                       {},
                                       /*chromatic=*/true};

  explicit DeltaTransmittance(std::span<const float> /*options*/) {}

  template <class Bounds>
  HWY_INLINE VecF rate(const Bounds& bounds) const {
    return channel_max(bounds.majorant);
  }

  template <int N, class Coefficients>
  HWY_INLINE void collide(const WalkModes& /*modes*/, const Coefficients& sigma,
                          Collision<N>& c) const {
    const VecF chosen = hn::Mul(c.uniform, c.rate);
    VecF left = hn::Zero(kFloat);
    for (int channel = 0; channel < N; ++channel) {
      const VecF sigma_t = hn::Add(sigma.sigma_a[channel], sigma.sigma_s[channel]);
      c.weight[channel] = hn::IfThenZeroElse(hn::Lt(chosen, sigma_t), c.weight[channel]);
      left = hn::Max(left, hn::Abs(c.weight[channel]));
    }
    c.absorb = hn::Eq(left, hn::Zero(kFloat));
  }

  static constexpr bool kNeedsBound = true;
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_DELTA_TRANSMITTANCE_INL_H_
