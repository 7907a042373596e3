// A method of the registry with errors planted in what it does at a collision, and its walk.

#if defined(FREEPATH_TESTS_CERTIFY_PLANTED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TESTS_CERTIFY_PLANTED_INL_H_
#undef FREEPATH_TESTS_CERTIFY_PLANTED_INL_H_
#else
#define FREEPATH_TESTS_CERTIFY_PLANTED_INL_H_
#endif

#include "freepath/transport/walk_stream-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// A method with factors on its weights. Everything else of it is inherited.
template <class Method>
struct Planted : Method {
  explicit Planted(std::span<const float> options)
      : Method(options),
        absorption(options[kMaxMethodOptions]),
        scattering(options[kMaxMethodOptions + 1]),
        null(options[kMaxMethodOptions + 2]),
        survival(options[kMaxMethodOptions + 4]) {}

  template <int N, class Coefficients>
  HWY_INLINE void collide(const WalkModes& modes, const Coefficients& sigma,
                          Collision<N>& c) const {
    const Collision<N> before = c;
    Method::template collide<N>(modes, sigma, c);
    plant(before, c.lanes, c);
    if constexpr (requires(const Method& method) { method.roulette; }) plant_roulette(c);
  }

  template <int N, class Coefficients>
  HWY_INLINE MaskF decide(const WalkModes& modes, const Coefficients& control,
                          Collision<N>& c) const {
    const Collision<N> before = c;
    const MaskF decided = Method::template decide<N>(modes, control, c);
    plant(before, decided, c);
    return decided;
  }

  template <int N>
  HWY_INLINE void plant(const Collision<N>& before, MaskF lanes, Collision<N>& c) const {
    const VecF factor = hn::IfThenElse(c.scatter, set(scattering),
                                       hn::IfThenElse(c.absorb, set(absorption), set(null)));
    for (int channel = 0; channel < N; ++channel) {
      assign(c.weight[channel], lanes, hn::Mul(c.weight[channel], factor));
      const VecF added = hn::Sub(c.emitted[channel], before.emitted[channel]);
      c.emitted[channel] = mul_add(added, set(absorption), before.emitted[channel]);
    }
  }

  /// What survives roulette has the threshold for its largest weight.
  template <int N>
  HWY_INLINE void plant_roulette(Collision<N>& c) const {
    VecF largest = hn::Zero(kFloat);
    for (int channel = 0; channel < N; ++channel) {
      largest = hn::Max(largest, hn::Abs(c.weight[channel]));
      if constexpr (Method::kNeedsDepth) {
        const VecF sum = hn::Add(c.rows[channel], c.weight[channel]);
        largest = hn::Max(largest, hn::Abs(sum));
      }
    }
    const VecF apart = hn::Abs(hn::Sub(largest, set(Method::roulette)));
    const VecF factor = hn::IfThenElse(hn::Lt(apart, set(1e-6F)), set(survival), set(1.0F));
    for (int channel = 0; channel < N; ++channel) {
      c.weight[channel] = hn::Mul(c.weight[channel], factor);
      if constexpr (Method::kNeedsDepth) c.rows[channel] = hn::Mul(c.rows[channel], factor);
    }
  }

  float absorption;
  float scattering;
  float null;
  float survival;
};

/// Random numbers of which the one that chooses a component has an error.
struct PlantedRandom : RandomCounter {
  float factor;

  HWY_INLINE VecF component_uniform() const {
    return hn::Mul(RandomCounter::component_uniform(), set(factor));
  }
};

/// Fields with a factor on the number that chooses a component.
template <int N>
struct PlantedFields : FieldSum<N> {
  PlantedFields(const MediumView& medium, float factor) : FieldSum<N>(medium), component(factor) {}

  template <class Densities, class Total>
  HWY_INLINE VecI choose_component(const Densities& densities, const Total& total,
                                   const RandomCounter& random, MaskF lanes,
                                   VecF (&weight)[N]) const {
    return FieldSum<N>::choose_component(densities, total, PlantedRandom{random, component}, lanes,
                                         weight);
  }
  template <class State, class Control, class Total>
  HWY_INLINE VecI choose_component(const State& state, const Control& control, const Total& total,
                                   const RandomCounter& random, MaskF lanes,
                                   VecF (&weight)[N]) const {
    return FieldSum<N>::choose_component(state, control, total, PlantedRandom{random, component},
                                         lanes, weight);
  }
  template <class Segment>
  HWY_INLINE VecI draw_component(const Segment& segment, const RandomCounter& random, MaskF lanes,
                                 VecF& uniform, VecF& rate) const {
    uniform = hn::Mul(uniform, set(component));
    return FieldSum<N>::draw_component(segment, random, lanes, uniform, rate);
  }

  float component;
};

/// walk_stream() of a method with errors.
template <int N, class Method>
void planted_walk_stream(const MediumView& medium, std::span<const float> options,
                         const WalkModes& modes, uint64_t seed, const RayStream& rays,
                         FlightStream& flights, WalkStatistics& statistics) {
  MediumEntry entry(medium, rays);
  const Planted<Method> method(options);
  const SuperVoxelSegments segments(medium);
  const PlantedFields<N> fields(medium, options[kMaxMethodOptions + 3]);
  Walk<N, Planted<Method>, SuperVoxelSegments, PlantedFields<N>, MediumEntry>(
      method, segments, fields, modes, seed, rays, entry, flights, statistics)
      .run();
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TESTS_CERTIFY_PLANTED_INL_H_
