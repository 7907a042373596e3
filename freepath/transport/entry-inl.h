// Where rays enter a medium: from the world to walk space, clipped to the medium's bounds.

#if defined(FREEPATH_TRANSPORT_ENTRY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRANSPORT_ENTRY_INL_H_
#undef FREEPATH_TRANSPORT_ENTRY_INL_H_
#else
#define FREEPATH_TRANSPORT_ENTRY_INL_H_
#endif

#include "freepath/base/lanes-inl.h"
#include "freepath/media/medium_view.h"
#include "freepath/tracking/streams.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Lengths and inverse directions stay below this, so that no product of theirs is infinite.
inline constexpr float kHuge = 1e30F;

/// A component of a direction, or 0 where it is so small that its inverse would overflow: of
/// another sign than that inverse it would send rays out of the grid sideways, step by step of no
/// length.
HWY_INLINE VecF entry_component(VecF component) {
  return hn::IfThenZeroElse(hn::Lt(hn::Abs(component), set(1.0F / kHuge)), component);  // NaN stays
}

HWY_INLINE VecF entry_inverse(VecF component) {
  const MaskF none = hn::Eq(component, hn::Zero(kFloat));
  return hn::Div(set(1.0F), hn::IfThenElse(none, set(1.0F / kHuge), component));
}

/// The entry of a stream of rays into a medium, a chunk at a time, so that what a walk reads of
/// rays to come stays in the nearest cache.
class MediumEntry {
 public:
  /// Rays in a chunk.
  static constexpr std::size_t kChunk = 256;

  /// Rays of a chunk. Rows are padded, so that lanes may read past the last ray.
  struct Rows {
    static constexpr std::size_t kSize = kChunk + kStreamPadding;
    HWY_ALIGN_MAX float origin[3][kSize];     ///< [walk space]
    HWY_ALIGN_MAX float direction[3][kSize];  ///< [walk space per world unit]
    HWY_ALIGN_MAX float inverse[3][kSize];
    HWY_ALIGN_MAX float cell[3][kSize];   ///< Whole numbers.
    HWY_ALIGN_MAX int32_t record[kSize];  ///< Where the bounds of that cell stand.
    HWY_ALIGN_MAX float head[kSize];      ///< The first number there.
    HWY_ALIGN_MAX float begin[kSize];     ///< Where the ray enters the medium [world].
    HWY_ALIGN_MAX float length[kSize];    ///< How far from there to its end [world].
  };

  MediumEntry(const MediumView& medium, const RayStream& rays) : medium_(medium), rays_(rays) {}

  /// Enters the chunk of rays that begins with slot `first`, and asks for the next one.
  HWY_NOINLINE const Rows& enter(std::size_t first) {
    const std::size_t count = std::min(kChunk, rays_.size() - first);
    for (std::size_t i = 0; i < count; i += kLanes) enter_lanes(first + i, i);
    prefetch(first + count);
    return rows_;
  }

 private:
  HWY_INLINE void prefetch(std::size_t first) const {
    const std::size_t count = std::min(kChunk, rays_.size() - first);
    for (int axis = 0; axis < 3; ++axis) {
      prefetch_row(rays_.origin[axis].data() + first, count);
      prefetch_row(rays_.direction[axis].data() + first, count);
    }
    prefetch_row(rays_.t_max.data() + first, count);
  }
  HWY_INLINE void enter_lanes(std::size_t first, std::size_t row);

  const MediumView& medium_;
  const RayStream& rays_;
  Rows rows_;
};

/// Enters kLanes rays from slot `first` on. The origin moves to where a ray meets the bounds, so
/// that a distant camera costs no precision inside. A ray that misses, that has no direction, or
/// whose numbers are not finite (but t_max may be infinite) gets length 0.
HWY_INLINE void MediumEntry::enter_lanes(std::size_t first, std::size_t row) {
  VecF world_origin[3];
  VecF world_direction[3];
  for (int axis = 0; axis < 3; ++axis) {
    world_origin[axis] = hn::LoadU(kFloat, rays_.origin[axis].data() + first);
    world_direction[axis] = hn::LoadU(kFloat, rays_.direction[axis].data() + first);
  }
  const AffineMap& map = medium_.world_to_walk;
  VecF origin[3];
  VecF direction[3];
  VecF inverse[3];
  VecF begin = hn::Zero(kFloat);
  const VecF t_max = hn::LoadU(kFloat, rays_.t_max.data() + first);
  const MaskF ends = hn::Eq(t_max, t_max);  // no NaN
  VecF end = hn::Min(t_max, set(kHuge));
  for (int axis = 0; axis < 3; ++axis) {
    origin[axis] = set(map.offset[axis]);
    direction[axis] = hn::Zero(kFloat);
    for (int from = 0; from < 3; ++from) {
      const VecF factor = set(map.linear[from][axis]);
      origin[axis] = mul_add(world_origin[from], factor, origin[axis]);
      direction[axis] = mul_add(world_direction[from], factor, direction[axis]);
    }
    direction[axis] = entry_component(direction[axis]);
    inverse[axis] = entry_inverse(direction[axis]);
    const VecF to_low =
        hn::Mul(hn::Sub(set(medium_.bounds_min[axis]), origin[axis]), inverse[axis]);
    const VecF to_high =
        hn::Mul(hn::Sub(set(medium_.bounds_max[axis]), origin[axis]), inverse[axis]);
    begin = hn::Max(begin, hn::Min(to_low, to_high));
    end = hn::Min(end, hn::Max(to_low, to_high));
  }
  // Minimum and maximum may drop a NaN, a sum keeps it; 0 times what is not finite is NaN.
  const VecF zero = hn::Zero(kFloat);
  VecF sum = zero;
  VecF reach = zero;
  for (int axis = 0; axis < 3; ++axis) {
    sum = hn::Add(sum, hn::Add(origin[axis], direction[axis]));
    reach = hn::Max(reach, hn::Abs(direction[axis]));
  }
  const MaskF finite = hn::Eq(hn::Mul(sum, zero), zero);
  const MaskF moves = hn::Gt(reach, set(1.0F / kHuge));  // else t would not move the point
  const MaskF meets = hn::And(hn::And(finite, moves), hn::And(ends, hn::Lt(begin, end)));
  const VecF length = hn::IfThenElseZero(meets, hn::Sub(end, begin));
  // A ray that misses has flown to its end.
  const VecF start = hn::IfThenElse(meets, begin, hn::IfThenElseZero(ends, t_max));
  hn::Store(start, kFloat, rows_.begin + row);
  hn::Store(length, kFloat, rows_.length + row);
  VecI record = hn::Zero(kInt);
  for (int axis = 0; axis < 3; ++axis) {
    const VecF entry = mul_add(begin, direction[axis], origin[axis]);
    const VecF last = set(static_cast<float>(medium_.cell_counts[axis] - 1));
    const VecF cell = hn::Min(hn::Max(hn::Floor(entry), hn::Zero(kFloat)), last);
    const VecF safe_cell = hn::IfThenElseZero(meets, cell);
    hn::Store(entry, kFloat, rows_.origin[axis] + row);
    hn::Store(direction[axis], kFloat, rows_.direction[axis] + row);
    hn::Store(inverse[axis], kFloat, rows_.inverse[axis] + row);
    hn::Store(safe_cell, kFloat, rows_.cell[axis] + row);
    record =
        hn::Add(hn::Mul(record, hn::Set(kInt, medium_.cell_counts[axis])), small_to_int(safe_cell));
  }
  record = hn::Mul(record, hn::Set(kInt, medium_.component_count));
  hn::Store(record, kInt, rows_.record + row);
  hn::Store(hn::GatherIndex(kFloat, medium_.cells, record), kFloat, rows_.head + row);
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRANSPORT_ENTRY_INL_H_
