// Spectral and decomposition tracking in one.

#if defined(FREEPATH_TRACKING_SPECTRAL_DECOMPOSITION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_SPECTRAL_DECOMPOSITION_INL_H_
#undef FREEPATH_TRACKING_SPECTRAL_DECOMPOSITION_INL_H_
#else
#define FREEPATH_TRACKING_SPECTRAL_DECOMPOSITION_INL_H_
#endif

#include "freepath/tracking/channel_reduction-inl.h"
#include "freepath/tracking/control-inl.h"
#include "freepath/tracking/method.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Spectral decomposition tracking [Kutz17, Sec. 5.3]: the control decides for all channels without
/// a look-up. P^c_e is in proportion to reduce |h mu^c_e| against reduce |h (rate - mu^c)|, so that
/// it never exceeds 1; the rest is spectral tracking of the residual.
struct SpectralDecomposition : MethodTraits {
  static constexpr MethodOption kOptions[] = {
      kCollisionProbability,
      {"control", 1.0F, 0.0F, 100.0F, "control, as a multiple of the super-voxel's minimum"},
      {"rate-scale", 1.0F, 1e-3F, 1e3F,
       "rate of tentative collisions, as a multiple of the largest majorant; always above the "
       "control"}};
  static constexpr MethodInfo kInfo = {
      "spectral-decomposition",
      "spectral tracking that looks no density up where the control decides",
      "",
      "always; with max and average the weights may grow without bound",
      "[Kutz17, Sec. 5.3]",
      kOptions,
      /*chromatic=*/true};
  static constexpr bool kControl = true;
  static constexpr bool kRateNeedsControl = true;

  explicit SpectralDecomposition(std::span<const float> options)
      : reduce(options[0]),
        control(options[1]),
        rate_scale(options[2]),
        rate_floor(control_rate_floor(control, rate_scale)) {}

  float control_scale() const { return control; }

  template <class Bounds>
  HWY_INLINE VecF rate(const Bounds& bounds) const {
    return hn::Max(hn::Mul(channel_max(bounds.majorant), set(rate_scale)),
                   hn::Mul(channel_max(bounds.minorant), set(rate_floor)));
  }

  template <int N, class Coefficients>
  HWY_INLINE MaskF decide(const WalkModes& modes, const Coefficients& sigma,
                          Collision<N>& c) const {
    VecF rest[N];
    for (int channel = 0; channel < N; ++channel) {
      rest[channel] = hn::Sub(c.rate, hn::Add(sigma.sigma_a[channel], sigma.sigma_s[channel]));
    }
    VecF probability[3] = {reduce.over<N>(sigma.sigma_a, c.weight),
                           reduce.over<N>(sigma.sigma_s, c.weight), reduce.over<N>(rest, c.weight)};
    return choose_control<N>(modes, sigma, probability, c);
  }

  template <int N, class Coefficients>
  HWY_INLINE void collide(const WalkModes& modes, const Coefficients& residual,
                          Collision<N>& c) const {
    VecF sigma_n[N];
    null_coefficients<N>(residual, c, sigma_n);
    collide_spectrally<N>(reduce, modes, residual, residual.scatter_size, sigma_n, c);
  }

  ChannelReduction reduce;
  float control;
  float rate_scale;
  float rate_floor;  ///< Least rate, as a multiple of the minorant.
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_SPECTRAL_DECOMPOSITION_INL_H_
