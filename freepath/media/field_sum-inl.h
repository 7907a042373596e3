// The sum of a medium's components, in lanes: bounds of a super-voxel, coefficients at a point, the
// control of minima and what is left beside it, and the choice of the component that scatters.

#if defined(FREEPATH_MEDIA_FIELD_SUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_MEDIA_FIELD_SUM_INL_H_
#undef FREEPATH_MEDIA_FIELD_SUM_INL_H_
#else
#define FREEPATH_MEDIA_FIELD_SUM_INL_H_
#endif

#include <span>

#include "freepath/media/field_lookup-inl.h"
#include "freepath/media/radiance_field-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Collision coefficients of N channels [1/m], and emission = sigma_a · L_e.
template <int N>
struct Coefficients {
  VecF sigma_a[N];
  VecF sigma_s[N];
  VecF emission[N];
};

/// What is left of the coefficients beside a control; may be negative.
template <int N>
struct ResidualCoefficients : Coefficients<N> {
  VecF sigma_t[N];       ///< Of the whole, control included.
  VecF scatter_size[N];  ///< Σ_k |ρ_k - control_k| σ_s,k: what a choice among scatterings needs.
};

/// Bounds of the extinction over a segment [1/m].
template <int N>
struct SegmentBounds {
  VecF majorant[N];
  VecF minorant[N];  ///< Only where it is asked for.
};

template <int N>
class FieldSum {
 public:
  using Coefficients = HWY_NAMESPACE::Coefficients<N>;
  using Residual = ResidualCoefficients<N>;
  using Bounds = SegmentBounds<N>;
  using State = FieldLookup::State;

  /// Control densities of a group, one row a lane; of components that matter.
  struct Control {
    HWY_ALIGN_MAX float density[Medium::kMaxComponents][kLanes];
  };

  explicit FieldSum(const MediumView& medium) : medium_(medium), lookup_(medium) {
    for (int channel = 0; channel < N; ++channel) {
      float scattered = 0;
      float total = 0;
      for (int k = 0; k < medium.component_count; ++k) {
        scattered += medium.components[k].sigma_s[channel];
        total += medium.components[k].sigma_s[channel] + medium.components[k].sigma_a[channel];
      }
      albedo_[channel] = total > 0 ? scattered / total : 0;
    }
  }

  /// Of each channel: the albedo where all densities are the same.
  const float* albedo() const { return albedo_; }

  /// Components that a collision looks up.
  int component_count() const { return static_cast<int>(medium_.matter().size()); }
  /// MediumView::source
  int source(int channel) const { return medium_.source(channel); }
  const FieldLookup& lookup() const { return lookup_; }

  /// Makes all that idle lanes read 0.
  HWY_INLINE void clear(State& state) const { lookup_.clear(state); }
  HWY_INLINE void clear(Control& control) const {
    std::memset(control.density, 0, medium_.component_count * sizeof(control.density[0]));
  }

  /// @param segment with the place of the super-voxel's record in Medium::walk_cells(), and its
  ///   first number, which is negative in an empty cell
  template <bool kMinorant, class Segment>
  HWY_INLINE Bounds bounds(const Segment& segment) const {
    Bounds bounds;
    for (int channel = 0; channel < N; ++channel) {
      bounds.majorant[channel] = bounds.minorant[channel] = hn::Zero(kFloat);
    }
    for (const int k : medium_.matter()) {
      const VecF most = maximum(k, segment);
      const VecF least = kMinorant ? hn::GatherIndex(kFloat, medium_.minima + k, segment.record)
                                   : hn::Zero(kFloat);
      const ComponentView& component = medium_.components[k];
      for (int channel = 0; channel < N; ++channel) {
        const float sigma_t = component.sigma_a[channel] + component.sigma_s[channel];
        add(bounds.majorant[channel], most, sigma_t);
        if (kMinorant) add(bounds.minorant[channel], least, sigma_t);
      }
    }
    return bounds;
  }

  HWY_INLINE Coefficients coefficients(const State& state) const {
    return sum([&](int k) { return lookup_.density(k, state); });
  }

  /// The control of a super-voxel: its minima times `scale`.
  HWY_INLINE void set_control(VecI record, float scale, Control& control) const {
    for (const int k : medium_.matter()) {
      const VecF least = hn::GatherIndex(kFloat, medium_.minima + k, record);
      hn::Store(hn::Mul(least, set(scale)), kFloat, control.density[k]);
    }
  }
  HWY_INLINE Coefficients coefficients(const Control& control) const {
    return sum([&](int k) { return hn::Load(kFloat, control.density[k]); });
  }
  HWY_INLINE Residual residual(const State& state, const Control& control) const {
    Residual left;
    static_cast<Coefficients&>(left) =
        sum([&](int k) { return residual_density(k, state, control); });
    for (int channel = 0; channel < N; ++channel) {
      left.sigma_t[channel] = left.scatter_size[channel] = hn::Zero(kFloat);
    }
    for (const int k : medium_.matter()) {
      const ComponentView& component = medium_.components[k];
      const VecF density = lookup_.density(k, state);
      const VecF size = hn::Abs(residual_density(k, state, control));
      for (int channel = 0; channel < N; ++channel) {
        add(left.sigma_t[channel], density,
            component.sigma_a[channel] + component.sigma_s[channel]);
        add(left.scatter_size[channel], size, component.sigma_s[channel]);
      }
    }
    return left;
  }

  /// Whether emission varies from place to place: then `coefficients` lack it, and it has to be
  /// added.
  HWY_INLINE bool has_radiance_fields() const { return medium_.radiance_views != nullptr; }
  /// Adds the emission at points [walk space] to the coefficients of the same densities.
  HWY_INLINE void add_emission(const State& state, const VecF (&point)[3], MaskF lanes,
                               Coefficients& sum) const {
    add_emission([&](int k) { return lookup_.density(k, state); }, point, lanes, sum);
  }
  HWY_INLINE void add_emission(const Control& control, const VecF (&point)[3], MaskF lanes,
                               Coefficients& sum) const {
    add_emission([&](int k) { return hn::Load(kFloat, control.density[k]); }, point, lanes, sum);
  }
  HWY_INLINE void add_emission(const State& state, const Control& control, const VecF (&point)[3],
                               MaskF lanes, Coefficients& sum) const {
    add_emission([&](int k) { return residual_density(k, state, control); }, point, lanes, sum);
  }
  HWY_INLINE void add_emission(VecI component, const State& state, const VecF (&point)[3],
                               MaskF lanes, Coefficients& sum) const {
    add_emission(
        [&](int k) { return lookup_.density(k, state, hn::Eq(component, hn::Set(kInt, k))); },
        point, lanes, sum);
  }

  /// Chooses the component that a scattering belongs to, with probability proportional to the sum
  /// over channels of |w(λ) sigma_s,k(λ)/sigma_s(λ)|, and corrects the weights by
  /// sigma_s,k(λ)/(sigma_s(λ) P_k): the sum of their magnitudes stays what it was.
  template <class Random>
  HWY_INLINE VecI choose_component(const State& state, const Coefficients& total,
                                   const Random& random, MaskF lanes, VecF (&weight)[N]) const {
    return choose([&](int k) { return lookup_.density(k, state); }, total, random, lanes, weight);
  }
  template <class Random>
  HWY_INLINE VecI choose_component(const Control& control, const Coefficients& total,
                                   const Random& random, MaskF lanes, VecF (&weight)[N]) const {
    return choose([&](int k) { return hn::Load(kFloat, control.density[k]); }, total, random, lanes,
                  weight);
  }
  template <class Random>
  HWY_INLINE VecI choose_component(const State& state, const Control& control,
                                   const Residual& total, const Random& random, MaskF lanes,
                                   VecF (&weight)[N]) const {
    return choose([&](int k) { return residual_density(k, state, control); }, total, random, lanes,
                  weight);
  }

  /// Draws the component that a tentative collision belongs to, with probability rate_k/rate, and
  /// leaves a fresh uniform number and that component's rate [Galtier16].
  template <class Segment, class Random>
  HWY_INLINE VecI draw_component(const Segment& segment, const Random& random, MaskF lanes,
                                 VecF& uniform, VecF& rate) const {
    VecF parts[Medium::kMaxComponents];  // in the order of those that matter
    VecF* part = parts;
    for (const int k : medium_.matter()) {
      const float sigma_t = medium_.components[k].sigma_a[0] + medium_.components[k].sigma_s[0];
      *part++ = hn::Mul(maximum(k, segment), set(sigma_t));
    }
    const VecI chosen = draw(parts, random, lanes, uniform);
    VecF chosen_rate = hn::Zero(kFloat);
    part = parts;
    for (const int k : medium_.matter()) {
      assign(chosen_rate, float_mask(hn::Eq(chosen, hn::Set(kInt, k))), *part++);
    }
    rate = hn::IfThenElse(hn::Gt(chosen_rate, hn::Zero(kFloat)), chosen_rate, set(1.0F));
    return chosen;
  }
  /// Coefficients of one component a lane.
  HWY_INLINE Coefficients coefficients_of(VecI component, const State& state) const {
    return sum(
        [&](int k) { return lookup_.density(k, state, hn::Eq(component, hn::Set(kInt, k))); });
  }

 private:
  template <class Density>
  HWY_INLINE void add_emission(const Density& density_of, const VecF (&point)[3], MaskF lanes,
                               Coefficients& sum) const {
    for (const int k : medium_.matter()) {
      const ComponentView& component = medium_.components[k];
      if (component.radiance == nullptr) continue;
      VecF radiance[N];
      radiance_at<N>(component.radiance, medium_.channels, point, lanes, radiance);
      const VecF density = density_of(k);
      for (int channel = 0; channel < N; ++channel) {
        const VecF scaled = hn::Mul(radiance[channel], set(component.radiance_scale[channel]));
        sum.emission[channel] = mul_add(density, scaled, sum.emission[channel]);
      }
    }
  }

  static HWY_INLINE void add(VecF& sum, VecF density, float cross_section) {
    sum = mul_add(density, set(cross_section), sum);
  }

  template <class Segment>
  HWY_INLINE VecF maximum(int k, const Segment& segment) const {
    return k == 0 ? hn::Max(segment.head, hn::Zero(kFloat))
                  : hn::GatherIndex(kFloat, medium_.cells + k, segment.record);
  }

  HWY_INLINE VecF residual_density(int k, const State& state, const Control& control) const {
    return hn::Sub(lookup_.density(k, state), hn::Load(kFloat, control.density[k]));
  }

  template <class Density>
  HWY_INLINE Coefficients sum(const Density& density_of) const {
    Coefficients sum;
    const std::span<const int32_t> matter = medium_.matter();
    const VecF first = density_of(matter[0]);
    for (int channel = 0; channel < N; ++channel) {
      const ComponentView& component = medium_.components[matter[0]];
      sum.sigma_a[channel] = hn::Mul(first, set(component.sigma_a[channel]));
      sum.sigma_s[channel] = hn::Mul(first, set(component.sigma_s[channel]));
      sum.emission[channel] = hn::Mul(first, set(component.emission[channel]));
    }
    for (const int k : matter.subspan(1)) {
      const VecF density = density_of(k);
      const ComponentView& component = medium_.components[k];
      for (int channel = 0; channel < N; ++channel) {
        add(sum.sigma_a[channel], density, component.sigma_a[channel]);
        add(sum.sigma_s[channel], density, component.sigma_s[channel]);
        add(sum.emission[channel], density, component.emission[channel]);
      }
    }
    return sum;
  }

  /// What each channel counts for in the choice of a component: |w(λ)/σ_s(λ)|, so that the parts
  /// of a scattering's weight are compared. One channel has nothing to compare.
  static HWY_INLINE void channel_shares(const Coefficients& total, const VecF (&weight)[N],
                                        VecF (&share)[N]) {
    for (int channel = 0; channel < N; ++channel) {
      const VecF sigma_s = total.sigma_s[channel];
      const MaskF scatters = hn::Ne(sigma_s, hn::Zero(kFloat));
      share[channel] =
          N == 1 ? set(1.0F)
                 : hn::IfThenElseZero(
                       scatters, hn::Abs(hn::Div(weight[channel],
                                                 hn::IfThenElse(scatters, sigma_s, set(1.0F)))));
    }
  }
  /// Σ_λ share(λ) σ_s,k(λ): times |ρ_k| the probability of component k, unnormalised.
  HWY_INLINE VecF shared_sum(int k, const VecF (&share)[N]) const {
    VecF sum = hn::Zero(kFloat);
    for (int channel = 0; channel < N; ++channel) {
      add(sum, share[channel], medium_.components[k].sigma_s[channel]);
    }
    return sum;
  }

  template <class Density, class Random>
  HWY_INLINE VecI choose(const Density& density_of, const Coefficients& total, const Random& random,
                         MaskF lanes, VecF (&weight)[N]) const {
    const VecI first = hn::Set(kInt, medium_.matter()[0]);
    if (medium_.matter().size() == 1 || hn::AllFalse(kFloat, lanes)) return first;
    VecF share[N];
    channel_shares(total, weight, share);
    VecF parts[Medium::kMaxComponents];  // in the order of those that matter
    VecF* part = parts;
    VecF sum = hn::Zero(kFloat);
    for (const int k : medium_.matter()) {
      *part = hn::Mul(hn::Abs(density_of(k)), shared_sum(k, share));
      sum = hn::Add(sum, *part++);
    }
    VecF uniform = random.component_uniform();
    const VecI chosen = draw(parts, random, lanes, uniform);
    correct_weights(density_of, total, share, sum, chosen, lanes, weight);
    return chosen;
  }

  /// Draws one of the components that matter with probabilities in proportion to their parts, one
  /// after the other against those after it, and leaves a number that is uniform whatever was
  /// drawn.
  template <class Random>
  HWY_NOINLINE VecI draw(const VecF (&parts)[Medium::kMaxComponents], const Random& random,
                         MaskF lanes, VecF& uniform) const {
    const std::span<const int32_t> matter = medium_.matter();
    const int last = static_cast<int>(matter.size()) - 1;
    VecF after[Medium::kMaxComponents];
    after[last] = hn::Zero(kFloat);
    for (int k = last; k > 0; --k) after[k - 1] = hn::Add(after[k], parts[k]);
    VecI chosen = hn::Set(kInt, matter[0]);
    MaskF open = lanes;
    for (int k = 0; k < last; ++k) {
      VecF rest = uniform;
      const MaskF here = random.split(parts[k], after[k], open, uint32_t(k) + 1, rest);
      assign(uniform, open, rest);
      open = hn::AndNot(here, open);
      chosen = hn::IfThenElse(int_mask(open), hn::Set(kInt, matter[k + 1]), chosen);
    }
    return chosen;
  }

  template <class Density>
  HWY_INLINE void correct_weights(const Density& density_of, const Coefficients& total,
                                  const VecF (&share)[N], VecF sum, VecI chosen, MaskF lanes,
                                  VecF (&weight)[N]) const {
    for (const int k : medium_.matter()) {
      const VecF part = hn::Mul(hn::Abs(density_of(k)), shared_sum(k, share));
      const MaskF mine = hn::And(hn::And(lanes, hn::Gt(part, hn::Zero(kFloat))),
                                 float_mask(hn::Eq(chosen, hn::Set(kInt, k))));
      if (hn::AllFalse(kFloat, mine)) continue;
      // |density| cancels: (density σ_s,k(λ)/σ_s(λ)) · (sum / (|density| Σ_λ share σ_s,k)); one
      // channel of positive densities keeps its weight to the bit.
      const VecF signed_sum = hn::CopySign(sum, density_of(k));
      const VecF shared = hn::IfThenElse(mine, shared_sum(k, share), set(1.0F));
      for (int channel = 0; channel < N; ++channel) {
        const MaskF scatters = hn::And(mine, hn::Ne(total.sigma_s[channel], hn::Zero(kFloat)));
        const VecF of_component =
            N == 1 ? set(1.0F) : hn::Div(set(medium_.components[k].sigma_s[channel]), shared);
        const VecF factor = hn::Div(hn::Mul(of_component, signed_sum),
                                    hn::IfThenElse(scatters, total.sigma_s[channel], set(1.0F)));
        assign(weight[channel], scatters, hn::Mul(weight[channel], factor));
      }
    }
  }

  MediumView medium_;
  FieldLookup lookup_;
  float albedo_[N];
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_MEDIA_FIELD_SUM_INL_H_
