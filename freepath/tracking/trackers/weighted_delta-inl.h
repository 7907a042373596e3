// Weighted delta tracking.

#if defined(FREEPATH_TRACKING_WEIGHTED_DELTA_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_WEIGHTED_DELTA_INL_H_
#undef FREEPATH_TRACKING_WEIGHTED_DELTA_INL_H_
#else
#define FREEPATH_TRACKING_WEIGHTED_DELTA_INL_H_
#endif

#include "freepath/tracking/collision-inl.h"
#include "freepath/tracking/method.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// P_e = |mu_e| / (mu_a + mu_s + |mu_n|) [Kutz17, Sec. 4.2; Galtier13]. The rate need not bound the
/// extinction: mu_n may be negative, and weights are ±(mu_t + |mu_n|)/rate.
struct WeightedDelta : MethodTraits {
  static constexpr MethodOption kOptions[] = {
      {"rate-scale", 1.0F, 1e-3F, 1e3F,
       "rate of tentative collisions, as a multiple of the majorant"},
      {"energy-partitioning", 0.0F, 0.0F, 1.0F,
       "no: absorption is an event; yes: every collision leaves its absorbed part behind [Eymet13]",
       kNoYes}};
  static constexpr MethodInfo kInfo = {
      "weighted-delta",
      "delta tracking by weights, whose rate need not be a bound",
      "",
      "always; below a rate scale of 1 weights may be negative and grow",
      "[Kutz17, Sec. 4.2]",
      kOptions};

  explicit WeightedDelta(std::span<const float> options)
      : rate_scale(options[0]), partitions_energy(options[1] != 0) {}

  template <class Bounds>
  HWY_INLINE VecF rate(const Bounds& bounds) const {
    return hn::Mul(bounds.majorant[0], set(rate_scale));
  }

  template <int N, class Coefficients>
  HWY_INLINE void collide(const WalkModes& modes, const Coefficients& sigma,
                          Collision<N>& c) const {
    VecF sigma_n[N];
    for (int channel = 0; channel < N; ++channel) {
      sigma_n[channel] = hn::Sub(c.rate, hn::Add(sigma.sigma_a[channel], sigma.sigma_s[channel]));
    }
    VecF probability[3] = {channel_mean<N>(sigma.sigma_a), channel_mean<N>(sigma.sigma_s),
                           hn::Abs(sigma_n[0])};
    if (partitions_energy) probability[0] = hn::Zero(kFloat);
    choose_event<N>(partitions_energy ? partitioned(modes) : modes, sigma, sigma_n, probability, c);
  }

  float rate_scale;
  bool partitions_energy;

 private:
  /// There are no absorption events to count emission at: every collision counts it.
  static HWY_INLINE WalkModes partitioned(WalkModes modes) {
    modes.absorption = Absorption::kAnalog;
    modes.emission = EmissionTally::kCollision;
    return modes;
  }
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_WEIGHTED_DELTA_INL_H_
