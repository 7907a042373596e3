// Hero wavelength tracking, unbiased.

#if defined(FREEPATH_TRACKING_HERO_WAVELENGTH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_HERO_WAVELENGTH_INL_H_
#undef FREEPATH_TRACKING_HERO_WAVELENGTH_INL_H_
#else
#define FREEPATH_TRACKING_HERO_WAVELENGTH_INL_H_
#endif

#include <type_traits>

#include "freepath/tracking/collision-inl.h"
#include "freepath/tracking/method.h"
#include "freepath/tracking/random-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

inline constexpr std::string_view kHeroSelections[] = {"uniform", "throughput-albedo"};

/// One channel, the hero, is delta-tracked with its own majorant; the others ride along by
/// single-sample multiple importance sampling over the densities that the same path of null and
/// real collisions has when another channel is the hero [Wilkie14; Miller19, Sec. 5]. With p_λ that
/// density and f_λ what the path contributes, the weight is f_λ / mean_λ' p_λ', at most N times the
/// albedos.
///
/// The densities of the path so far come with the ray and go on with the flight (relative to their
/// mean), and the hero is drawn in proportion to them: the same law as one hero for the whole path.
/// With `throughput-albedo` each flight draws its hero anew, in proportion to throughput times
/// albedo [Chiang16], a tenth of it uniformly so that no channel is left out, and the balance
/// heuristic uses the probabilities that the hero was drawn with, which makes it unbiased.
struct HeroWavelength : MethodTraits {
  static constexpr MethodOption kOptions[] = {
      {"selection", 0.0F, 0.0F, 1.0F, "how the hero is drawn", kHeroSelections}};
  static constexpr MethodInfo kInfo = {
      "hero-wavelength",
      "delta tracking of one channel; the others by multiple importance sampling",
      "",
      "if the rate bounds the extinction of every channel, as super-voxels do",
      "[Wilkie14; Miller19]",
      kOptions,
      /*chromatic=*/true};
  static constexpr bool kAdvances = true;
  static constexpr bool kDrawsHero = true;
  /// Relative path density, optical depth by the channel's own majorant since the last collision,
  /// that majorant, each a row a channel; the hero.
  template <int N>
  static constexpr int kRows = 3 * N + 1;

  explicit HeroWavelength(std::span<const float> options) : by_throughput(options[0] != 0) {}

  template <int N>
  float row_start(int row) const {
    return row < N ? 1.0F : 0.0F;
  }

  /// Draws the hero of a flight; rows[0, N) hold the relative densities of the path so far.
  template <int N>
  HWY_INLINE void begin(const RandomCounter& random, MaskF lanes, const VecF (&weight)[N],
                        const float* albedo, VecF* rows) const {
    if (by_throughput) {
      VecF wanted[N];
      VecF sum = hn::Zero(kFloat);
      for (int channel = 0; channel < N; ++channel) {
        wanted[channel] = hn::Mul(hn::Abs(weight[channel]), set(albedo[channel]));
        sum = hn::Add(sum, wanted[channel]);
      }
      for (int channel = 0; channel < N; ++channel) {
        const VecF share = divide_or_zero(wanted[channel], sum);
        const MaskF some = hn::Gt(sum, hn::Zero(kFloat));
        rows[channel] = hn::IfThenElse(some, mul_add(share, set(0.9F * N), set(0.1F)), set(1.0F));
      }
    }
    // One channel after the other, against those after it.
    VecF after[N];
    after[N - 1] = hn::Zero(kFloat);
    for (int channel = N - 1; channel > 0; --channel) {
      after[channel - 1] = hn::Add(after[channel], rows[channel]);
    }
    VecF uniform = random.uniform(0, hn::Zero(kUint));
    VecF hero = hn::Zero(kFloat);
    MaskF open = lanes;
    for (int channel = 0; channel < N; ++channel) {
      const MaskF here =
          random.split(rows[channel], after[channel], open, uint32_t(channel), uniform);
      assign(hero, hn::And(open, here), set(static_cast<float>(channel)));
      open = hn::AndNot(here, open);
    }
    rows[3 * N] = hero;
  }

  template <class Bounds>
  HWY_INLINE VecF rate(const Bounds& bounds, const float (*rows)[kLanes]) const {
    constexpr int kChannelCount = std::extent_v<decltype(Bounds::majorant)>;
    const VecF hero = hn::Load(kFloat, rows[3 * kChannelCount]);
    return of_hero<kChannelCount>(bounds.majorant, hero);
  }

  template <int N, class Bounds>
  HWY_INLINE void advance(const Bounds& bounds, VecF length, VecF* rows) const {
    for (int channel = 0; channel < N; ++channel) {
      rows[N + channel] = mul_add(bounds.majorant[channel], length, rows[N + channel]);
      rows[2 * N + channel] = bounds.majorant[channel];
    }
  }

  template <int N, class Coefficients>
  HWY_INLINE void collide(const WalkModes& modes, const Coefficients& sigma,
                          Collision<N>& c) const {
    pass_depth<N>(c.rows, c.weight);
    VecF* const density = c.rows;
    const VecF* const majorant = c.rows + 2 * N;
    const bool weighted = modes.absorption == Absorption::kWeighted;
    VecF sigma_t[N];
    VecF absorb[N];   // what each channel would take for absorption, if it were the hero,
    VecF scatter[N];  // and for scattering
    for (int channel = 0; channel < N; ++channel) {
      sigma_t[channel] = hn::Add(sigma.sigma_a[channel], sigma.sigma_s[channel]);
      absorb[channel] = weighted ? hn::Zero(kFloat) : sigma.sigma_a[channel];
      scatter[channel] = weighted ? sigma_t[channel] : sigma.sigma_s[channel];
    }
    if (modes.emits && modes.emission == EmissionTally::kCollision) {
      VecF sum = hn::Zero(kFloat);
      for (int channel = 0; channel < N; ++channel) {
        sum = mul_add(density[channel], majorant[channel], sum);
      }
      tally_emission<N>(sigma.emission, divide_or_zero(set(float{N}), sum), c);
    }
    const VecF hero = c.rows[3 * N];
    const VecF chosen = hn::Mul(c.uniform, c.rate);
    const MaskF collided =
        set_events(chosen, of_hero<N>(absorb, hero), of_hero<N>(scatter, hero), c);
    VecF event[N];
    VecF sum = hn::Zero(kFloat);
    for (int channel = 0; channel < N; ++channel) {
      // rate_λ P_e,λ: the density of this event if λ were the hero
      const VecF real = hn::IfThenElse(c.absorb, absorb[channel], scatter[channel]);
      const VecF null = hn::Sub(majorant[channel], sigma_t[channel]);
      event[channel] = hn::IfThenElse(collided, real, null);
      density[channel] = hn::Mul(density[channel], event[channel]);
      sum = hn::Add(sum, density[channel]);
    }
    const VecF per_mean = divide_or_zero(set(float{N}), sum);
    if (modes.emits && modes.emission == EmissionTally::kAnalog) {
      const MaskF counted = emission_event(modes, c, collided);
      tally_emission<N>(sigma.emission, hn::IfThenElseZero(counted, per_mean), c);
    }
    for (int channel = 0; channel < N; ++channel) {
      const VecF coefficient = hn::IfThenElse(c.scatter, sigma.sigma_s[channel], event[channel]);
      c.weight[channel] = hn::Mul(c.weight[channel], hn::Mul(coefficient, per_mean));
      density[channel] = hn::Mul(density[channel], per_mean);
    }
  }

  template <int N>
  HWY_INLINE void finish(VecF* rows, VecF /*depth*/, VecF (&weight)[N]) const {
    pass_depth<N>(rows, weight);
    VecF sum = rows[0];
    for (int channel = 1; channel < N; ++channel) sum = hn::Add(sum, rows[channel]);
    const VecF per_mean = divide_or_zero(set(float{N}), sum);
    for (int channel = 0; channel < N; ++channel) {
      weight[channel] = hn::Mul(weight[channel], per_mean);
      rows[channel] = hn::Mul(rows[channel], per_mean);
    }
  }

  bool by_throughput;

 private:
  template <int N>
  static HWY_INLINE VecF of_hero(const VecF (&values)[N], VecF hero) {
    VecF value = values[0];
    for (int channel = 1; channel < N; ++channel) {
      assign(value, hn::Eq(hero, set(static_cast<float>(channel))), values[channel]);
    }
    return value;
  }

  /// The exponentials of the stretch behind, relative to the largest: a common factor of weights
  /// and densities cancels.
  template <int N>
  static HWY_INLINE void pass_depth(VecF* rows, VecF (&weight)[N]) {
    VecF least = rows[N];
    for (int channel = 1; channel < N; ++channel) least = hn::Min(least, rows[N + channel]);
    for (int channel = 0; channel < N; ++channel) {
      const VecF factor = exp_of_negative(hn::Sub(least, rows[N + channel]));
      weight[channel] = hn::Mul(weight[channel], factor);
      rows[channel] = hn::Mul(rows[channel], factor);
      rows[N + channel] = hn::Zero(kFloat);
    }
  }
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_HERO_WAVELENGTH_INL_H_
