// The algebra of one tentative collision, shared by all null-collision trackers: choose an event
// with probability P_e, multiply the weight by mu_e/(rate P_e) [Kutz17, Eq. 9; Galtier13].

#if defined(FREEPATH_TRACKING_COLLISION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_COLLISION_INL_H_
#undef FREEPATH_TRACKING_COLLISION_INL_H_
#else
#define FREEPATH_TRACKING_COLLISION_INL_H_
#endif

#include "freepath/base/lanes-inl.h"
#include "freepath/tracking/random-inl.h"
#include "freepath/tracking/walk_modes.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// A tentative collision in each lane of `lanes`. A tracker sets the events and changes the weight
/// and the emission tally of those lanes; what it leaves in the others is ignored.
template <int N>
struct Collision {
  MaskF lanes;
  VecF rate;       ///< Density of tentative collisions here [1/m], of what is still to be decided.
  VecF full_rate;  ///< The same before a control has decided its part.
  VecF uniform;    ///< (0,1), for the choice of the event.
  RandomCounter random;  ///< Of further numbers.
  VecF weight[N];
  VecF emitted[N];  ///< Tally of emitted radiance so far.
  MaskF scatter;
  MaskF absorb;
  VecF* rows = nullptr;  ///< The method's own rows.
  VecF depth;            ///< Optical depth since the last tentative collision, if asked for.
};

/// What the walk asks of a method; one that needs more says so in its own constants.
struct MethodTraits {
  /// Biased where sigma_t exceeds the rate; such collisions are counted.
  static constexpr bool kNeedsBound = false;
  /// Decides on a control before any look-up: decide(), control_scale(); collide() then gets
  /// residual coefficients.
  static constexpr bool kControl = false;
  /// Whether it does decide, or wants the residual coefficients alone.
  static constexpr bool kDecides = true;
  /// Whether rate() wants the minorant too.
  static constexpr bool kRateNeedsControl = false;
  /// Draws one component at a collision and looks up no other.
  static constexpr bool kOneComponent = false;
  /// Rows of its own for each lane, set by begin() and turned into the final weight by finish().
  template <int N>
  static constexpr int kRows = 0;
  /// Has advance(): what a stretch of the ray does to its rows without any collision.
  static constexpr bool kAdvances = false;
  /// Has begin(): draws the channel that leads a flight; carries path densities from ray to flight.
  static constexpr bool kDrawsHero = false;
  /// Its collide() wants the optical depth, by its rate, since the last tentative collision.
  static constexpr bool kNeedsDepth = false;
};

/// Mean over channels.
template <int N>
HWY_INLINE VecF channel_mean(const VecF (&values)[N]) {
  VecF sum = values[0];
  for (int channel = 1; channel < N; ++channel) sum = hn::Add(sum, values[channel]);
  if constexpr (N > 1) sum = hn::Mul(sum, set(1.0F / N));
  return sum;
}

template <int N>
HWY_INLINE VecF channel_max(const VecF (&values)[N]) {
  VecF largest = values[0];
  for (int channel = 1; channel < N; ++channel) largest = hn::Max(largest, values[channel]);
  return largest;
}

/// a/b, and 0 where b is 0 (only reached by lanes for which the event is impossible).
HWY_INLINE VecF divide_or_zero(VecF a, VecF b) {
  const MaskF possible = hn::Ne(b, hn::Zero(kFloat));
  return hn::IfThenElseZero(possible, hn::Div(a, hn::IfThenElse(possible, b, set(1.0F))));
}

/// Adds w · emission · share to the tally.
template <int N>
HWY_INLINE void tally_emission(const VecF (&emission)[N], VecF share, Collision<N>& c) {
  for (int channel = 0; channel < N; ++channel) {
    c.emitted[channel] =
        mul_add(hn::Mul(c.weight[channel], emission[channel]), share, c.emitted[channel]);
  }
}

/// The events at which analog emission is counted: absorptions, or every real collision where
/// absorption is weighted.
template <int N>
HWY_INLINE MaskF emission_event(const WalkModes& modes, const Collision<N>& c, MaskF collided) {
  return modes.absorption == Absorption::kWeighted ? collided : c.absorb;
}

/// Under weighted absorption the absorbed part scatters too, and the weight takes the albedo.
HWY_INLINE void merge_absorption(const WalkModes& modes, VecF& absorb, VecF& scatter) {
  if (modes.absorption != Absorption::kWeighted) return;
  scatter = hn::Add(absorb, scatter);
  absorb = hn::Zero(kFloat);
}

/// Where among [0, absorb + scatter) a number stands: sets the events. The smaller of the two
/// begins at 0, where a uniform number has all its digits, so that what is rare happens as often as
/// it should; what the null events beyond lose by rounding is a trifle of the collisions before.
template <int N>
HWY_INLINE MaskF set_events(VecF chosen, VecF absorb, VecF scatter, Collision<N>& c) {
  const MaskF collided = hn::Lt(chosen, hn::Add(absorb, scatter));
  const MaskF first = hn::Lt(chosen, hn::Min(absorb, scatter));
  const MaskF other = hn::Xor(first, hn::Lt(scatter, absorb));  // absorption, if anything
  c.absorb = hn::And(collided, other);
  c.scatter = hn::AndNot(other, collided);
  return collided;
}

/// Chooses absorption, scattering or null with probabilities in proportion to `probability` (each
/// ≥ 0) and weights the event. Emission is tallied at every tentative collision, or at the real
/// ones alone.
///
/// @param probability unnormalised probabilities of absorption, scattering, null
/// @param sigma_n null coefficient of each channel [1/m]
template <int N, class Coefficients>
HWY_INLINE void choose_event(const WalkModes& modes, const Coefficients& sigma,
                             const VecF (&sigma_n)[N], VecF (&probability)[3], Collision<N>& c) {
  merge_absorption(modes, probability[0], probability[1]);
  const VecF real = hn::Add(probability[0], probability[1]);
  const VecF total = hn::Add(real, probability[2]);
  const MaskF collided = set_events(hn::Mul(c.uniform, total), probability[0], probability[1], c);

  const VecF event_probability = hn::IfThenElse(
      c.absorb, probability[0], hn::IfThenElse(c.scatter, probability[1], probability[2]));
  // 1/(rate P_e), and without P_e for the tally that needs no event
  const VecF per_rate = hn::Div(set(1.0F), c.rate);
  const VecF scale = hn::Mul(divide_or_zero(total, event_probability), per_rate);
  if (modes.emits) {
    const VecF share = modes.emission == EmissionTally::kCollision
                           ? per_rate
                           : hn::IfThenElseZero(emission_event(modes, c, collided), scale);
    tally_emission<N>(sigma.emission, share, c);
  }
  for (int channel = 0; channel < N; ++channel) {
    const VecF coefficient =
        hn::IfThenElse(c.absorb, sigma.sigma_a[channel],
                       hn::IfThenElse(c.scatter, sigma.sigma_s[channel], sigma_n[channel]));
    c.weight[channel] = hn::Mul(c.weight[channel], hn::Mul(coefficient, scale));
  }
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_COLLISION_INL_H_
