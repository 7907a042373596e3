// Decomposition tracking, analog.

#if defined(FREEPATH_TRACKING_DECOMPOSITION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_DECOMPOSITION_INL_H_
#undef FREEPATH_TRACKING_DECOMPOSITION_INL_H_
#else
#define FREEPATH_TRACKING_DECOMPOSITION_INL_H_
#endif

#include "freepath/tracking/control-inl.h"
#include "freepath/tracking/method.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Control and residual parts race for the first collision [Kutz17, Sec. 5.1]: a tentative
/// collision belongs to the control with probability mu^c/rate, and is then decided without a
/// look-up; this is the law of sampling the control in closed form first and cutting the residual
/// short. The control is the minimum of the super-voxel, so nothing is ever negative.
struct Decomposition : MethodTraits {
  static constexpr MethodInfo kInfo = {
      "decomposition",
      "delta tracking that looks no density up where the local minimum decides",
      "",
      "if the rate bounds the extinction, as super-voxels do",
      "[Kutz17, Sec. 5.1]",
      {}};
  static constexpr bool kNeedsBound = true;
  static constexpr bool kControl = true;

  explicit Decomposition(std::span<const float> /*options*/) {}

  float control_scale() const { return 1.0F; }

  template <class Bounds>
  HWY_INLINE VecF rate(const Bounds& bounds) const {
    return bounds.majorant[0];
  }

  template <int N, class Coefficients>
  HWY_INLINE MaskF decide(const WalkModes& modes, const Coefficients& control,
                          Collision<N>& c) const {
    return decide_by_minimum<N>(modes, control, c);
  }

  template <int N, class Coefficients>
  HWY_INLINE void collide(const WalkModes& modes, const Coefficients& residual,
                          Collision<N>& c) const {
    VecF sigma_n[N];
    null_coefficients<N>(residual, c, sigma_n);
    // Rounding may leave a trifle below 0.
    const VecF zero = hn::Zero(kFloat);
    VecF probability[3] = {hn::Max(channel_mean<N>(residual.sigma_a), zero),
                           hn::Max(channel_mean<N>(residual.sigma_s), zero),
                           hn::Max(sigma_n[0], zero)};
    choose_event<N>(modes, residual, sigma_n, probability, c);
  }
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_DECOMPOSITION_INL_H_
