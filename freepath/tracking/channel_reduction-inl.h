// How spectral trackers make one collision probability out of those of all channels.

#if defined(FREEPATH_TRACKING_CHANNEL_REDUCTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_CHANNEL_REDUCTION_INL_H_
#undef FREEPATH_TRACKING_CHANNEL_REDUCTION_INL_H_
#else
#define FREEPATH_TRACKING_CHANNEL_REDUCTION_INL_H_
#endif

#include "freepath/tracking/collision-inl.h"
#include "freepath/tracking/method.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

inline constexpr std::string_view kReductions[] = {"max", "average", "history-max",
                                                   "history-average"};

/// The option of the spectral trackers; its standard is history-average.
inline constexpr MethodOption kCollisionProbability = {
    "collision-probability",
    3.0F,
    0.0F,
    3.0F,
    "how channels make one probability: their maximum or mean, of coefficients alone or times the "
    "path's throughput",
    kReductions};

/// Maximum or mean over channels of |h mu| [Kutz17, Sec. 4.2.2, 4.2.3].
struct ChannelReduction {
  explicit ChannelReduction(float option)
      : mean(option == 1 || option == 3), history(option >= 2) {}

  template <int N>
  HWY_INLINE VecF over(const VecF (&values)[N], const VecF (&weight)[N]) const {
    VecF magnitudes[N];
    for (int channel = 0; channel < N; ++channel) {
      magnitudes[channel] =
          hn::Abs(history ? hn::Mul(values[channel], weight[channel]) : values[channel]);
    }
    return mean ? channel_mean<N>(magnitudes) : channel_max<N>(magnitudes);
  }

  bool mean;
  bool history;
};

/// Lanes whose weights are all 0: nothing that they might still find would count.
template <int N>
HWY_INLINE MaskF nothing_left(const Collision<N>& c) {
  VecF largest = hn::Abs(c.weight[0]);
  for (int channel = 1; channel < N; ++channel) {
    largest = hn::Max(largest, hn::Abs(c.weight[channel]));
  }
  return hn::Eq(largest, hn::Zero(kFloat));
}

/// Chooses among absorption, scattering and null with the probabilities of all channels, and ends
/// paths of which nothing is left.
/// @param scatter_size what the choice takes for the scattering coefficient of each channel
template <int N, class Coefficients>
HWY_INLINE void collide_spectrally(const ChannelReduction& reduce, const WalkModes& modes,
                                   const Coefficients& sigma, const VecF (&scatter_size)[N],
                                   const VecF (&sigma_n)[N], Collision<N>& c) {
  VecF probability[3] = {reduce.over<N>(sigma.sigma_a, c.weight),
                         reduce.over<N>(scatter_size, c.weight), reduce.over<N>(sigma_n, c.weight)};
  choose_event<N>(modes, sigma, sigma_n, probability, c);
  c.absorb = hn::Or(c.absorb, nothing_left<N>(c));
  c.scatter = hn::AndNot(c.absorb, c.scatter);
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_CHANNEL_REDUCTION_INL_H_
