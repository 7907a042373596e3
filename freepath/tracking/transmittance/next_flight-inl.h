// Transmittance by expected next flights.

#if defined(FREEPATH_TRACKING_NEXT_FLIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_NEXT_FLIGHT_INL_H_
#undef FREEPATH_TRACKING_NEXT_FLIGHT_INL_H_
#else
#define FREEPATH_TRACKING_NEXT_FLIGHT_INL_H_
#endif

#include "freepath/tracking/method.h"
#include "freepath/tracking/random-inl.h"
#include "freepath/tracking/roulette-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Σ_j W_j exp(-∫ from x_j to the end of the rate), W_j the product of mu_n/rate up to the j-th
/// tentative collision, W_0 what the ray brings along [Novak18, Sec. 5.2]: every collision adds its
/// expected flight to the end without another. Kept as the last W and the sum S of those before it:
/// a stretch of optical depth d makes (S + W) exp(-d) of S. Once W and S + W are small, Russian
/// roulette is played for both.
struct NextFlight : MethodTraits {
  static constexpr MethodOption kOptions[] = {
      {"rate-scale", 1.0F, 1e-3F, 1e3F,
       "rate of tentative collisions, as a multiple of the majorant"},
      {"roulette", 0.1F, 0.0F, 1.0F, "weight below which Russian roulette is played, 0 for never"}};
  static constexpr MethodInfo kInfo = {
      "next-flight",
      "every tentative collision adds its expected uncollided flight to the end",
      "",
      "always; below a rate scale of 1 estimates may be negative",
      "[Novak18, Sec. 5.2]",
      kOptions,
      /*chromatic=*/true};
  static constexpr bool kNeedsDepth = true;
  /// S of each channel.
  template <int N>
  static constexpr int kRows = N;

  explicit NextFlight(std::span<const float> options)
      : rate_scale(options[0]), roulette(options[1]) {}

  template <int N>
  float row_start(int /*row*/) const {
    return 0.0F;
  }

  template <class Bounds>
  HWY_INLINE VecF rate(const Bounds& bounds) const {
    return hn::Mul(channel_max(bounds.majorant), set(rate_scale));
  }

  template <int N, class Coefficients>
  HWY_INLINE void collide(const WalkModes& /*modes*/, const Coefficients& sigma,
                          Collision<N>& c) const {
    const VecF per_rate = hn::Div(set(1.0F), c.rate);
    const VecF passed = exp_of_negative(hn::Neg(c.depth));
    VecF largest = hn::Zero(kFloat);
    for (int channel = 0; channel < N; ++channel) {
      const VecF sigma_t = hn::Add(sigma.sigma_a[channel], sigma.sigma_s[channel]);
      c.rows[channel] = hn::Mul(hn::Add(c.rows[channel], c.weight[channel]), passed);
      c.weight[channel] = hn::Mul(c.weight[channel], hn::Mul(hn::Sub(c.rate, sigma_t), per_rate));
      const VecF sum = hn::Add(c.rows[channel], c.weight[channel]);
      largest = hn::Max(largest, hn::Max(hn::Abs(c.weight[channel]), hn::Abs(sum)));
    }
    const VecF gain = roulette_gain(roulette, largest, c.uniform);
    c.absorb = hn::Eq(gain, hn::Zero(kFloat));
    for (int channel = 0; channel < N; ++channel) {
      c.weight[channel] = hn::Mul(c.weight[channel], gain);
      c.rows[channel] = hn::Mul(c.rows[channel], gain);
    }
  }

  /// @param depth passed since the last collision
  template <int N>
  HWY_INLINE void finish(const VecF* rows, VecF depth, VecF (&weight)[N]) const {
    const VecF passed = exp_of_negative(hn::Neg(depth));
    for (int channel = 0; channel < N; ++channel) {
      weight[channel] = hn::Mul(hn::Add(rows[channel], weight[channel]), passed);
    }
  }

  float rate_scale;
  float roulette;
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_NEXT_FLIGHT_INL_H_
