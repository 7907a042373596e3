// Spectral tracking.

#if defined(FREEPATH_TRACKING_SPECTRAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_SPECTRAL_INL_H_
#undef FREEPATH_TRACKING_SPECTRAL_INL_H_
#else
#define FREEPATH_TRACKING_SPECTRAL_INL_H_
#endif

#include "freepath/tracking/channel_reduction-inl.h"
#include "freepath/tracking/collision-inl.h"
#include "freepath/tracking/method.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Spectral tracking [Kutz17, Sec. 4.2]: one path carries all channels, whatever their extinctions.
/// P_e is in proportion to the maximum or the mean over channels of |h mu_e|, where h is 1, or for
/// the history-aware ones the throughput of the path so far, which keeps weights bounded.
struct Spectral : MethodTraits {
  static constexpr MethodOption kOptions[] = {
      kCollisionProbability,
      {"rate-scale", 1.0F, 1e-3F, 1e3F,
       "rate of tentative collisions, as a multiple of the largest majorant"}};
  static constexpr MethodInfo kInfo = {
      "spectral",
      "one path for all channels, with collision probabilities from all of them",
      "",
      "always; with max and average the weights may grow without bound",
      "[Kutz17, Sec. 4.2]",
      kOptions,
      /*chromatic=*/true};

  explicit Spectral(std::span<const float> options) : reduce(options[0]), rate_scale(options[1]) {}

  template <class Bounds>
  HWY_INLINE VecF rate(const Bounds& bounds) const {
    return hn::Mul(channel_max(bounds.majorant), set(rate_scale));
  }

  template <int N, class Coefficients>
  HWY_INLINE void collide(const WalkModes& modes, const Coefficients& sigma,
                          Collision<N>& c) const {
    VecF sigma_n[N];
    for (int channel = 0; channel < N; ++channel) {
      sigma_n[channel] = hn::Sub(c.rate, hn::Add(sigma.sigma_a[channel], sigma.sigma_s[channel]));
    }
    collide_spectrally<N>(reduce, modes, sigma, sigma.sigma_s, sigma_n, c);
  }

  ChannelReduction reduce;
  float rate_scale;
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_SPECTRAL_INL_H_
