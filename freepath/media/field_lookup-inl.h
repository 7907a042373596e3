// The densities of a medium at points, in lanes. A look-up has three stages, so that a walk can
// keep several groups of lanes in flight and hide the latency of memory: aim (which voxel?), fetch
// (which brick?), density (its value).

#if defined(FREEPATH_MEDIA_FIELD_LOOKUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_MEDIA_FIELD_LOOKUP_INL_H_
#undef FREEPATH_MEDIA_FIELD_LOOKUP_INL_H_
#else
#define FREEPATH_MEDIA_FIELD_LOOKUP_INL_H_
#endif

#include <cstring>

#include "freepath/base/lanes-inl.h"
#include "freepath/media/density_function.h"
#include "freepath/media/medium_view.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

class FieldLookup {
 public:
  /// The voxel that is read of a component, one row a lane.
  struct Tap {
    HWY_ALIGN_MAX int32_t voxel[3][kLanes];   ///< Base voxel, from the first of the index.
    HWY_ALIGN_MAX float fraction[3][kLanes];  ///< Position between it and the next (trilinear).
    HWY_ALIGN_MAX int32_t entry[kLanes];      ///< Index entry of its brick.
  };

  /// A look-up on its way.
  struct State {
    HWY_ALIGN_MAX int32_t address[Medium::kMaxComponents][kLanes];  ///< Voxel in the array.
    Tap taps[Medium::kMaxComponents];  ///< The first serves all components of an aligned medium.
  };

  explicit FieldLookup(const MediumView& medium)
      : medium_(medium), size_(static_cast<float>(medium.cell_size)) {
    for (int k = 0; k < medium.component_count; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        const int voxels = medium.components[k].brick_counts[axis] * BrickMap::kBrickSize;
        last_voxel_[k][axis] = static_cast<float>(voxels - 2);
      }
    }
  }

  /// Makes all that lanes which look nothing up read of a state 0.
  HWY_INLINE void clear(State& state) const {
    std::memset(state.address, 0, medium_.component_count * sizeof(state.address[0]));
    std::memset(state.taps, 0, medium_.component_count * sizeof(state.taps[0]));
  }

  /// Stage 1: the voxel to read at a point [walk space]; the random words choose among the eight
  /// neighbours under stochastic interpolation. One tap serves all components of an aligned medium;
  /// in others each component has its own, by the same random words: what is estimated is linear in
  /// the densities, so they need not be independent.
  HWY_INLINE void aim(const VecF (&point)[3], MaskF lanes, VecU bits0, VecU bits1,
                      State& state) const {
    if (medium_.components[0].function != nullptr) return aim_at_function(point, lanes, state);
    VecU random[3];
    random[0] = hn::ShiftRight<11>(bits0);
    random[1] = hn::ShiftRight<11>(bits1);
    random[2] = hn::Or(hn::ShiftLeft<10>(hn::And(bits0, hn::Set(kUint, 0x7FF))),
                       hn::And(bits1, hn::Set(kUint, 0x3FF)));
    if (!medium_.aligned) return aim_at_each(point, lanes, random, state);
    VecF position[3];
    for (int axis = 0; axis < 3; ++axis) position[axis] = hn::Mul(point[axis], set(size_));
    aim_at_voxel(0, position, lanes, random, state.taps[0]);
  }

  /// Asks for the index entries of the voxels aimed at.
  HWY_INLINE void prefetch_index(const State& state) const {
    if (medium_.components[0].function != nullptr) return;
    for (const int k : medium_.matter()) {
      prefetch_lanes(medium_.components[k].index, tap_of(k, state).entry);
    }
  }
  /// The same for one component a lane.
  HWY_INLINE void prefetch_index(const State& state, const int32_t (&component)[kLanes]) const {
    if (medium_.components[0].function != nullptr) return;
    for (size_t lane = 0; lane < kLanes; ++lane) {
      const int32_t k = component[lane];
      hwy::Prefetch(medium_.components[k].index + tap_of(k, state).entry[lane]);
    }
  }

  /// Stage 2: the brick of that voxel.
  HWY_INLINE void fetch(State& state) const {
    if (medium_.components[0].function != nullptr) return compute(state);
    VecI within = voxel_in_brick(state.taps[0]);
    VecI entry = hn::Load(kInt, state.taps[0].entry);
    for (const int k : medium_.matter()) {
      if (k > 0) take_next_tap(k, state, entry, within);
      hn::Store(voxel_address(k, entry, within), kInt, state.address[k]);
      prefetch_lanes(medium_.components[k].voxels, state.address[k]);
    }
  }
  /// The same for one component a lane; the other components' bricks stay untouched.
  HWY_INLINE void fetch(State& state, const int32_t (&component)[kLanes]) const {
    if (medium_.components[0].function != nullptr) return compute(state);
    VecI within = voxel_in_brick(state.taps[0]);
    VecI entry = hn::Load(kInt, state.taps[0].entry);
    const VecI wanted = hn::Load(kInt, component);
    for (const int k : medium_.matter()) {
      if (k > 0) take_next_tap(k, state, entry, within);
      const MaskI mine = hn::Eq(wanted, hn::Set(kInt, k));
      const VecI address = voxel_address(k, hn::IfThenElseZero(mine, entry), within);
      hn::Store(hn::IfThenElseZero(mine, address), kInt, state.address[k]);
    }
    for (size_t lane = 0; lane < kLanes; ++lane) {
      const int32_t k = component[lane];
      hwy::Prefetch(medium_.components[k].voxels + state.address[k][lane]);
    }
  }

  /// Stage 3: the density of one component.
  HWY_INLINE VecF density(int k, const State& state) const {
    if (medium_.components[0].function != nullptr) {
      return hn::BitCast(kFloat, hn::Load(kInt, state.address[k]));
    }
    if (medium_.interpolation == Interpolation::kTrilinear) {
      return trilinear(k, state, hn::Eq(hn::Zero(kInt), hn::Zero(kInt)));
    }
    return hn::GatherIndex(kFloat, medium_.components[k].voxels, hn::Load(kInt, state.address[k]));
  }
  /// The same in the lanes of a mask, 0 in the others.
  HWY_INLINE VecF density(int k, const State& state, MaskI lanes) const {
    const bool trilinear_taps = medium_.interpolation == Interpolation::kTrilinear &&
                                medium_.components[0].function == nullptr;
    return hn::IfThenElseZero(float_mask(lanes),
                              trilinear_taps ? trilinear(k, state, lanes) : density(k, state));
  }

 private:
  HWY_INLINE const Tap& tap_of(int k, const State& state) const {
    return state.taps[medium_.aligned ? 0 : k];
  }

  /// What the taps before the k-th have left becomes that of the k-th, where that is another.
  HWY_INLINE void take_next_tap(int k, const State& state, VecI& entry, VecI& within) const {
    if (medium_.aligned) return;
    entry = hn::Load(kInt, state.taps[k].entry);
    within = voxel_in_brick(state.taps[k]);
  }

  /// Aims in a medium whose components have voxels of their own.
  HWY_NOINLINE void aim_at_each(const VecF (&point)[3], MaskF lanes, const VecU (&random)[3],
                                State& state) const {
    for (const int k : medium_.matter()) {
      const AffineMap& map = medium_.components[k].walk_to_voxels;
      VecF position[3];
      for (int axis = 0; axis < 3; ++axis) {
        position[axis] = set(map.offset[axis]);
        for (int from = 0; from < 3; ++from) {
          position[axis] = mul_add(point[from], set(map.linear[from][axis]), position[axis]);
        }
      }
      aim_at_voxel(k, position, lanes, random, state.taps[k]);
    }
  }

  /// Aims at a position in the voxels of component k. Beyond the voxels it is held at the border of
  /// the index, which is 0.
  HWY_INLINE void aim_at_voxel(int k, const VecF (&point)[3], MaskF lanes, const VecU (&random)[3],
                               Tap& tap) const {
    VecI voxel[3];
    for (int axis = 0; axis < 3; ++axis) {
      VecF position = point[axis];
      if (medium_.interpolation != Interpolation::kNearest) position = hn::Sub(position, set(0.5F));
      position = hn::Min(hn::Max(position, hn::Zero(kFloat)), set(last_voxel_[k][axis]));
      const VecF base = hn::Floor(position);
      voxel[axis] = small_to_int(base);
      const VecF fraction = hn::Sub(position, base);
      if (medium_.interpolation == Interpolation::kStochastic) {
        // 21 bits an axis, in the middle of their interval so that rounding favours no side.
        const VecF u =
            hn::Mul(hn::Add(hn::ConvertTo(kFloat, hn::BitCast(kInt, random[axis])), set(0.5F)),
                    set(0x1p-21F));
        const VecI next = hn::VecFromMask(kInt, int_mask(hn::Lt(u, fraction)));
        voxel[axis] = hn::Sub(voxel[axis], next);  // a true lane is -1
      } else if (medium_.interpolation == Interpolation::kTrilinear) {
        hn::Store(fraction, kFloat, tap.fraction[axis]);
      }
      voxel[axis] = hn::IfThenElseZero(int_mask(lanes), voxel[axis]);
      hn::Store(voxel[axis], kInt, tap.voxel[axis]);
    }
    hn::Store(brick_entry(k, voxel), kInt, tap.entry);
  }

  /// Keeps the points where a density function is to be evaluated.
  HWY_INLINE void aim_at_function(const VecF (&point)[3], MaskF lanes, State& state) const {
    for (int axis = 0; axis < 3; ++axis) {
      const VecF position = mul_add(hn::IfThenElseZero(lanes, point[axis]),
                                    set(medium_.cell_edge[axis]), set(medium_.cell_origin[axis]));
      hn::Store(position, kFloat, state.taps[0].fraction[axis]);
    }
  }

  /// Evaluates density functions at those points, one call a component.
  HWY_NOINLINE void compute(State& state) const {
    const auto& [x, y, z] = state.taps[0].fraction;
    Vec3f positions[kLanes];
    for (size_t lane = 0; lane < kLanes; ++lane) positions[lane] = {x[lane], y[lane], z[lane]};
    for (const int k : medium_.matter()) {
      float densities[kLanes] = {};
      medium_.components[k].function->evaluate(positions, densities);
      // Their bits stand where the address of a voxel would.
      std::memcpy(state.address[k], densities, sizeof(densities));
    }
  }

  HWY_INLINE VecI brick_entry(int k, const VecI (&voxel)[3]) const {
    const auto& counts = medium_.components[k].brick_counts;
    const VecI row = hn::Add(hn::Mul(hn::ShiftRight<3>(voxel[0]), hn::Set(kInt, counts[1])),
                             hn::ShiftRight<3>(voxel[1]));
    return hn::Add(hn::Mul(row, hn::Set(kInt, counts[2])), hn::ShiftRight<3>(voxel[2]));
  }

  static HWY_INLINE VecI voxel_in_brick(const Tap& tap) {
    const VecI voxel[3] = {hn::Load(kInt, tap.voxel[0]), hn::Load(kInt, tap.voxel[1]),
                           hn::Load(kInt, tap.voxel[2])};
    return voxel_in_brick(voxel);
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

  HWY_INLINE VecF trilinear(int k, const State& state, MaskI lanes) const {
    const Tap& tap = tap_of(k, state);
    VecI voxel[2][3];
    VecF weight[2][3];
    for (int axis = 0; axis < 3; ++axis) {
      voxel[0][axis] = hn::IfThenElseZero(lanes, hn::Load(kInt, tap.voxel[axis]));
      voxel[1][axis] = hn::Add(voxel[0][axis], hn::Set(kInt, 1));
      weight[1][axis] = hn::Load(kFloat, tap.fraction[axis]);
      weight[0][axis] = hn::Sub(set(1.0F), weight[1][axis]);
    }
    VecF sum = hn::Zero(kFloat);
    for (int x = 0; x < 2; ++x) {
      for (int y = 0; y < 2; ++y) {
        const VecF weight_xy = hn::Mul(weight[x][0], weight[y][1]);
        for (int z = 0; z < 2; ++z) {
          const VecI corner[3] = {voxel[x][0], voxel[y][1], voxel[z][2]};
          const VecI address = voxel_address(k, brick_entry(k, corner), voxel_in_brick(corner));
          const VecF value = hn::GatherIndex(kFloat, medium_.components[k].voxels, address);
          sum = mul_add(hn::Mul(weight_xy, weight[z][2]), value, sum);
        }
      }
    }
    return sum;
  }

  MediumView medium_;
  float size_;
  float last_voxel_[Medium::kMaxComponents][3];
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_MEDIA_FIELD_LOOKUP_INL_H_
