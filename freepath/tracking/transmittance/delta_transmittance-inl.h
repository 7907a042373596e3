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

/// 1 if no real collision happens, else 0 [Woodcock65; Novak18, Sec. 5]. One extinction for all
/// channels of the path.
struct DeltaTransmittance {
  static constexpr MethodInfo kInfo = {"delta",
                                       "1 if the ray passes without a real collision, else 0",
                                       "",
                                       "if the rate bounds the extinction, as super-voxels do",
                                       "[Novak18, Sec. 5]",
                                       {}};

  explicit DeltaTransmittance(std::span<const float> /*options*/) {}

  template <class Bounds>
  HWY_INLINE VecF rate(const Bounds& bounds) const {
    return bounds.majorant[0];
  }

  template <int N, class Coefficients>
  HWY_INLINE void collide(const WalkModes& /*modes*/, const Coefficients& sigma,
                          Collision<N>& c) const {
    const VecF sigma_t = hn::Add(sigma.sigma_a[0], sigma.sigma_s[0]);
    c.absorb = hn::Lt(hn::Mul(c.uniform, c.rate), sigma_t);
    for (int channel = 0; channel < N; ++channel) {
      c.weight[channel] = hn::IfThenZeroElse(c.absorb, c.weight[channel]);
    }
  }

  static constexpr bool kNeedsBound = true;
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_DELTA_TRANSMITTANCE_INL_H_
