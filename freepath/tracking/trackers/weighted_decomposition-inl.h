// Weighted decomposition tracking.

#if defined(FREEPATH_TRACKING_WEIGHTED_DECOMPOSITION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_WEIGHTED_DECOMPOSITION_INL_H_
#undef FREEPATH_TRACKING_WEIGHTED_DECOMPOSITION_INL_H_
#else
#define FREEPATH_TRACKING_WEIGHTED_DECOMPOSITION_INL_H_
#endif

#include "freepath/tracking/control-inl.h"
#include "freepath/tracking/method.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Decomposition by weights [Kutz17, Sec. 5.2]: the control is a multiple of the super-voxel's
/// minimum and may exceed the extinction; then residual coefficients are negative and so may
/// weights be.
struct WeightedDecomposition : MethodTraits {
  static constexpr MethodOption kOptions[] = {
      {"control", 1.0F, 0.0F, 100.0F, "control, as a multiple of the super-voxel's minimum"},
      {"rate-scale", 1.0F, 1e-3F, 1e3F,
       "rate of tentative collisions, as a multiple of the majorant; always above the control"}};
  static constexpr MethodInfo kInfo = {
      "weighted-decomposition",
      "decomposition whose control may exceed the minimum and whose rate need not be a bound",
      "",
      "always; weights may be negative where the control exceeds the minimum",
      "[Kutz17, Sec. 5.2]",
      kOptions};
  static constexpr bool kControl = true;
  static constexpr bool kRateNeedsControl = true;

  explicit WeightedDecomposition(std::span<const float> options)
      : control(options[0]),
        rate_scale(options[1]),
        rate_floor(control_rate_floor(control, rate_scale)) {}

  float control_scale() const { return control; }

  template <class Bounds>
  HWY_INLINE VecF rate(const Bounds& bounds) const {
    return hn::Max(hn::Mul(bounds.majorant[0], set(rate_scale)),
                   hn::Mul(bounds.minorant[0], set(rate_floor)));
  }

  template <int N, class Coefficients>
  HWY_INLINE MaskF decide(const WalkModes& modes, const Coefficients& c_sigma,
                          Collision<N>& c) const {
    return decide_by_minimum<N>(modes, c_sigma, c);
  }

  template <int N, class Coefficients>
  HWY_INLINE void collide(const WalkModes& modes, const Coefficients& residual,
                          Collision<N>& c) const {
    VecF sigma_n[N];
    null_coefficients<N>(residual, c, sigma_n);
    VecF absorb = hn::Zero(kFloat);
    for (int channel = 0; channel < N; ++channel) {
      absorb = hn::Add(absorb, hn::Abs(residual.sigma_a[channel]));
    }
    VecF probability[3] = {hn::Mul(absorb, set(1.0F / N)), channel_mean<N>(residual.scatter_size),
                           hn::Abs(sigma_n[0])};
    choose_event<N>(modes, residual, sigma_n, probability, c);
  }

  float control;
  float rate_scale;
  float rate_floor;  ///< Least rate, as a multiple of the minorant.
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_WEIGHTED_DECOMPOSITION_INL_H_
