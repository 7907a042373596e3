// The sum of a medium's components, in lanes: bounds of a super-voxel and coefficients at a point.
// A look-up has three stages, so that a walk can keep several groups of lanes in flight and hide
// the latency of memory: aim (which voxel?), fetch (which brick?), coefficients (its value).

#if defined(FREEPATH_MEDIA_FIELD_SUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_MEDIA_FIELD_SUM_INL_H_
#undef FREEPATH_MEDIA_FIELD_SUM_INL_H_
#else
#define FREEPATH_MEDIA_FIELD_SUM_INL_H_
#endif

#include "freepath/base/lanes-inl.h"
#include "freepath/media/medium_view.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Collision coefficients of N channels [1/m], and emission = sigma_a · L_e.
template <int N>
struct Coefficients {
  VecF sigma_a[N];
  VecF sigma_s[N];
  VecF emission[N];
};

/// Bounds of the extinction over a segment [1/m].
template <int N>
struct SegmentBounds {
  VecF majorant[N];
};

template <int N>
class FieldSum {
 public:
  using Coefficients = HWY_NAMESPACE::Coefficients<N>;
  using Bounds = SegmentBounds<N>;

  /// A look-up on its way, one row a lane.
  struct State {
    HWY_ALIGN_MAX int32_t voxel[3][kLanes];   ///< Base voxel, from the first of the index.
    HWY_ALIGN_MAX float fraction[3][kLanes];  ///< Place between it and the next (trilinear).
    HWY_ALIGN_MAX int32_t entry[kLanes];      ///< Index entry of its brick.
    HWY_ALIGN_MAX int32_t address[Medium::kMaxComponents][kLanes];  ///< Voxel in the array.
  };

  explicit FieldSum(const MediumView& medium)
      : medium_(medium), size_(static_cast<float>(medium.cell_size)) {
    for (int axis = 0; axis < 3; ++axis) {
      last_voxel_[axis] = static_cast<float>(medium.brick_counts[axis] * BrickMap::kBrickSize - 2);
    }
  }

  /// @param segment with the place of the super-voxel's record in Medium::walk_cells(), and its
  ///   first number, which is negative in an empty cell
  template <class Segment>
  HWY_INLINE Bounds bounds(const Segment& segment) const {
    Bounds bounds;
    for (int channel = 0; channel < N; ++channel) bounds.majorant[channel] = hn::Zero(kFloat);
    for (int k = 0; k < medium_.component_count; ++k) {
      const VecF density = k == 0 ? hn::Max(segment.head, hn::Zero(kFloat))
                                  : hn::GatherIndex(kFloat, medium_.cells + k, segment.record);
      const ComponentView& component = medium_.components[k];
      for (int channel = 0; channel < N; ++channel) {
        const float sigma_t = component.sigma_a[channel] + component.sigma_s[channel];
        bounds.majorant[channel] = hn::MulAdd(density, set(sigma_t), bounds.majorant[channel]);
      }
    }
    return bounds;
  }

  /// Stage 1: the voxel to read at a point [walk space]; the random words choose among the eight
  /// neighbours under stochastic interpolation. One tap serves all components.
  HWY_INLINE void aim(const VecF (&point)[3], MaskF lanes, VecU bits0, VecU bits1,
                      State& state) const {
    VecU random[3];
    random[0] = hn::ShiftRight<11>(bits0);
    random[1] = hn::ShiftRight<11>(bits1);
    random[2] = hn::Or(hn::ShiftLeft<10>(hn::And(bits0, hn::Set(kUint, 0x7FF))),
                       hn::And(bits1, hn::Set(kUint, 0x3FF)));
    VecI voxel[3];
    for (int axis = 0; axis < 3; ++axis) {
      VecF place = hn::Mul(point[axis], set(size_));
      if (medium_.interpolation != Interpolation::kNearest) place = hn::Sub(place, set(0.5F));
      place = hn::Min(hn::Max(place, hn::Zero(kFloat)), set(last_voxel_[axis]));
      const VecF base = hn::Floor(place);
      voxel[axis] = small_to_int(base);
      const VecF fraction = hn::Sub(place, base);
      if (medium_.interpolation == Interpolation::kStochastic) {
        // 21 bits an axis, in the middle of their interval so that rounding favours no side.
        const VecF u =
            hn::Mul(hn::Add(hn::ConvertTo(kFloat, hn::BitCast(kInt, random[axis])), set(0.5F)),
                    set(0x1p-21F));
        const VecI next = hn::VecFromMask(kInt, int_mask(hn::Lt(u, fraction)));
        voxel[axis] = hn::Sub(voxel[axis], next);  // a true lane is -1
      } else if (medium_.interpolation == Interpolation::kTrilinear) {
        hn::Store(fraction, kFloat, state.fraction[axis]);
      }
      voxel[axis] = hn::IfThenElseZero(int_mask(lanes), voxel[axis]);
      hn::Store(voxel[axis], kInt, state.voxel[axis]);
    }
    const VecI entry = brick_entry(voxel);
    hn::Store(entry, kInt, state.entry);
    for (int k = 0; k < medium_.component_count; ++k) {
      prefetch_lanes(medium_.components[k].index, state.entry);
    }
  }

  /// Stage 2: the brick of that voxel.
  HWY_INLINE void fetch(State& state) const {
    VecI voxel[3];
    for (int axis = 0; axis < 3; ++axis) voxel[axis] = hn::Load(kInt, state.voxel[axis]);
    const VecI within = voxel_in_brick(voxel);
    const VecI entry = hn::Load(kInt, state.entry);
    for (int k = 0; k < medium_.component_count; ++k) {
      const VecI address = voxel_address(k, entry, within);
      hn::Store(address, kInt, state.address[k]);
      prefetch_lanes(medium_.components[k].voxels, state.address[k]);
    }
  }

  /// Stage 3: the density of one component.
  HWY_INLINE VecF density(int k, const State& state) const {
    if (medium_.interpolation == Interpolation::kTrilinear) return trilinear(k, state);
    return hn::GatherIndex(kFloat, medium_.components[k].voxels, hn::Load(kInt, state.address[k]));
  }

  HWY_INLINE Coefficients coefficients(const State& state) const {
    Coefficients sum;
    for (int channel = 0; channel < N; ++channel) {
      sum.sigma_a[channel] = sum.sigma_s[channel] = sum.emission[channel] = hn::Zero(kFloat);
    }
    for (int k = 0; k < medium_.component_count; ++k) {
      const VecF density = this->density(k, state);
      const ComponentView& component = medium_.components[k];
      for (int channel = 0; channel < N; ++channel) {
        add(sum.sigma_a[channel], density, component.sigma_a[channel]);
        add(sum.sigma_s[channel], density, component.sigma_s[channel]);
        add(sum.emission[channel], density, component.emission[channel]);
      }
    }
    return sum;
  }

  /// Chooses the component that a scattering belongs to, with probability proportional to the mean
  /// over channels of its sigma_s, and corrects the weights by sigma_s,k(λ)/(sigma_s(λ) P_k).
  HWY_INLINE VecI choose_component(const State& state, const Coefficients& total, VecF uniform,
                                   MaskF lanes, VecF (&weight)[N]) const {
    VecI chosen = hn::Zero(kInt);
    if (medium_.component_count == 1) return chosen;
    VecF sum = hn::Zero(kFloat);
    for (int channel = 0; channel < N; ++channel) sum = hn::Add(sum, total.sigma_s[channel]);
    VecF rest = hn::Mul(uniform, sum);
    MaskF open = lanes;
    for (int k = 0; k < medium_.component_count; ++k) {
      const VecF density = this->density(k, state);
      const ComponentView& component = medium_.components[k];
      VecF part = hn::Zero(kFloat);
      for (int channel = 0; channel < N; ++channel) {
        add(part, density, component.sigma_s[channel]);
      }
      // The last component that can scatter takes what rounding leaves over.
      MaskF here = hn::And(open, hn::Gt(part, hn::Zero(kFloat)));
      const MaskF takes = hn::And(here, hn::Lt(rest, part));
      chosen = hn::IfThenElse(int_mask(here), hn::Set(kInt, k), chosen);
      open = hn::AndNot(takes, open);
      rest = hn::Sub(rest, part);
    }
    if constexpr (N > 1) correct_weights(total, sum, chosen, lanes, weight);
    return chosen;
  }

  int component_count() const { return medium_.component_count; }

 private:
  static HWY_INLINE void add(VecF& sum, VecF density, float cross_section) {
    sum = hn::MulAdd(density, set(cross_section), sum);
  }

  HWY_INLINE void correct_weights(const Coefficients& total, VecF sum, VecI chosen, MaskF lanes,
                                  VecF (&weight)[N]) const {
    for (int k = 0; k < medium_.component_count; ++k) {
      const MaskF mine = hn::And(lanes, float_mask(hn::Eq(chosen, hn::Set(kInt, k))));
      if (hn::AllFalse(kFloat, mine)) continue;
      const ComponentView& component = medium_.components[k];
      float part = 0;
      for (int channel = 0; channel < N; ++channel) part += component.sigma_s[channel];
      if (part <= 0) continue;
      for (int channel = 0; channel < N; ++channel) {
        // density cancels: (density σ_s,k(λ) / σ_s(λ)) · (Σ σ_s / (density Σ_λ σ_s,k))
        const VecF factor =
            hn::Div(hn::Mul(set(component.sigma_s[channel] / part), sum), total.sigma_s[channel]);
        const MaskF scatters = hn::And(mine, hn::Gt(total.sigma_s[channel], hn::Zero(kFloat)));
        assign(weight[channel], scatters, hn::Mul(weight[channel], factor));
      }
    }
  }

  HWY_INLINE VecI brick_entry(const VecI (&voxel)[3]) const {
    const VecI row =
        hn::Add(hn::Mul(hn::ShiftRight<3>(voxel[0]), hn::Set(kInt, medium_.brick_counts[1])),
                hn::ShiftRight<3>(voxel[1]));
    return hn::Add(hn::Mul(row, hn::Set(kInt, medium_.brick_counts[2])),
                   hn::ShiftRight<3>(voxel[2]));
  }

  static HWY_INLINE VecI voxel_in_brick(const VecI (&voxel)[3]) {
    const VecI low = hn::Set(kInt, 7);
    return hn::Or(
        hn::Or(hn::ShiftLeft<6>(hn::And(voxel[0], low)), hn::ShiftLeft<3>(hn::And(voxel[1], low))),
        hn::And(voxel[2], low));
  }

  HWY_INLINE VecI voxel_address(int k, VecI entry, VecI within) const {
    const auto* index = reinterpret_cast<const int32_t*>(medium_.components[k].index);
    return hn::Or(hn::ShiftLeft<9>(hn::GatherIndex(kInt, index, entry)), within);
  }

  HWY_INLINE VecF trilinear(int k, const State& state) const {
    VecI voxel[2][3];
    VecF weight[2][3];
    for (int axis = 0; axis < 3; ++axis) {
      voxel[0][axis] = hn::Load(kInt, state.voxel[axis]);
      voxel[1][axis] = hn::Add(voxel[0][axis], hn::Set(kInt, 1));
      weight[1][axis] = hn::Load(kFloat, state.fraction[axis]);
      weight[0][axis] = hn::Sub(set(1.0F), weight[1][axis]);
    }
    VecF sum = hn::Zero(kFloat);
    for (int x = 0; x < 2; ++x) {
      for (int y = 0; y < 2; ++y) {
        const VecF weight_xy = hn::Mul(weight[x][0], weight[y][1]);
        for (int z = 0; z < 2; ++z) {
          const VecI corner[3] = {voxel[x][0], voxel[y][1], voxel[z][2]};
          const VecI address = voxel_address(k, brick_entry(corner), voxel_in_brick(corner));
          const VecF value = hn::GatherIndex(kFloat, medium_.components[k].voxels, address);
          sum = hn::MulAdd(hn::Mul(weight_xy, weight[z][2]), value, sum);
        }
      }
    }
    return sum;
  }

  MediumView medium_;
  float size_;
  float last_voxel_[3];
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_MEDIA_FIELD_SUM_INL_H_
