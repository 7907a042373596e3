// Segments of rays through the super-voxels, in lanes: a digital differential analyser
// [Amanatides87] over integer cells that leaves a whole empty cube in one step.

#if defined(FREEPATH_MEDIA_SEGMENTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_MEDIA_SEGMENTS_INL_H_
#undef FREEPATH_MEDIA_SEGMENTS_INL_H_
#else
#define FREEPATH_MEDIA_SEGMENTS_INL_H_
#endif

#include <hwy/cache_control.h>

#include "freepath/base/lanes-inl.h"
#include "freepath/media/medium_view.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Where the rays of a group stand, in registers.
struct SegmentCursor {
  VecF origin[3];     ///< [walk space]
  VecF direction[3];  ///< [walk space per world unit], so that t is a world length
  VecF inverse[3];    ///< 1/direction, huge where that is 0
  VecF t;             ///< Distance from the origin [world].
  VecF end;           ///< Where the ray leaves the medium or ends [world].
  VecI cell[3];       ///< Super-voxel that holds the point at t.
  VecI record;        ///< Place of its record in Medium::walk_cells().
};

/// The same in memory, one row a lane.
struct SegmentState {
  HWY_ALIGN_MAX float origin[3][kLanes];
  HWY_ALIGN_MAX float direction[3][kLanes];
  HWY_ALIGN_MAX float inverse[3][kLanes];
  HWY_ALIGN_MAX float t[kLanes];
  HWY_ALIGN_MAX float end[kLanes];
  HWY_ALIGN_MAX int32_t cell[3][kLanes];
  HWY_ALIGN_MAX int32_t record[kLanes];
};

/// A segment: the part of a ray in one super-voxel, or in one empty cube of them.
struct Segment {
  VecI record;        ///< Place of the super-voxel's record in Medium::walk_cells().
  VecF exit;          ///< Where it ends [world].
  VecI low[3];        ///< First cell along each axis.
  VecI high[3];       ///< One past the last cell.
  MaskF exits_by[3];  ///< The axis whose plane is crossed there; exactly one.
};

class SuperVoxelSegments {
 public:
  using State = SegmentState;
  using Cursor = SegmentCursor;

  explicit SuperVoxelSegments(const MediumView& medium) : medium_(medium) {}

  HWY_INLINE Cursor load(const State& state) const {
    Cursor cursor;
    for (int axis = 0; axis < 3; ++axis) {
      cursor.origin[axis] = hn::Load(kFloat, state.origin[axis]);
      cursor.direction[axis] = hn::Load(kFloat, state.direction[axis]);
      cursor.inverse[axis] = hn::Load(kFloat, state.inverse[axis]);
      cursor.cell[axis] = hn::Load(kInt, state.cell[axis]);
    }
    cursor.t = hn::Load(kFloat, state.t);
    cursor.end = hn::Load(kFloat, state.end);
    cursor.record = hn::Load(kInt, state.record);
    return cursor;
  }

  /// Writes back what a walk changes.
  HWY_INLINE void store(const Cursor& cursor, State& state) const {
    for (int axis = 0; axis < 3; ++axis) hn::Store(cursor.cell[axis], kInt, state.cell[axis]);
    hn::Store(cursor.t, kFloat, state.t);
    hn::Store(cursor.record, kInt, state.record);
  }

  /// Puts the rays from slot `first` on into the dealer's lanes.
  template <class Entry>
  HWY_INLINE void refill(const Entry& entry, std::size_t first, const Dealer& dealer,
                         State& state) const {
    for (int axis = 0; axis < 3; ++axis) {
      dealer.deal(entry.origin[axis].data() + first, state.origin[axis]);
      dealer.deal(entry.direction[axis].data() + first, state.direction[axis]);
      dealer.deal(entry.inverse[axis].data() + first, state.inverse[axis]);
      dealer.deal(entry.cell[axis].data() + first, state.cell[axis]);
    }
    dealer.deal(entry.length.data() + first, state.end);
    dealer.fill(0.0F, state.t);
    dealer.deal(entry.record.data() + first, state.record);
  }

  /// The segment at the cursor. Lanes outside the mask get entry 0 and no meaning.
  HWY_INLINE Segment segment(const Cursor& cursor, MaskF lanes) const {
    Segment s;
    s.record = hn::IfThenElseZero(int_mask(lanes), cursor.record);
    const VecI one = hn::Set(kInt, 1);
    const VecI radius = hn::Max(
        hn::ConvertTo(kInt,
                      hn::GatherIndex(kFloat, medium_.cells + medium_.component_count, s.record)),
        one);
    VecF exits[3];
    for (int axis = 0; axis < 3; ++axis) {
      s.low[axis] = hn::Sub(hn::Add(cursor.cell[axis], one), radius);
      s.high[axis] = hn::Add(cursor.cell[axis], radius);
      const MaskF forward = hn::Ge(cursor.direction[axis], hn::Zero(kFloat));
      const VecF plane =
          hn::ConvertTo(kFloat, hn::IfThenElse(int_mask(forward), s.high[axis], s.low[axis]));
      exits[axis] = hn::Mul(hn::Sub(plane, cursor.origin[axis]), cursor.inverse[axis]);
    }
    const VecF nearest = hn::Min(hn::Min(exits[0], exits[1]), exits[2]);
    s.exits_by[0] = hn::Le(exits[0], nearest);
    s.exits_by[1] = hn::AndNot(s.exits_by[0], hn::Le(exits[1], nearest));
    s.exits_by[2] = hn::Not(hn::Or(s.exits_by[0], s.exits_by[1]));
    s.exit = hn::Max(hn::Min(nearest, cursor.end), cursor.t);
    return s;
  }

  /// Moves the lanes of the mask, whose t is the segment's exit, into the next cell. Cells only
  /// ever advance in the ray's direction, whatever rounding does, so every walk ends.
  /// @return the lanes that are still inside the super-voxels
  HWY_INLINE MaskF leave(Cursor& cursor, const Segment& s, MaskF lanes) const {
    VecI outside = hn::Zero(kInt);
    const VecI one = hn::Set(kInt, 1);
    for (int axis = 0; axis < 3; ++axis) {
      const MaskI forward = int_mask(hn::Ge(cursor.direction[axis], hn::Zero(kFloat)));
      const VecF position = hn::MulAdd(cursor.t, cursor.direction[axis], cursor.origin[axis]);
      const VecI found = floor_to_int(position);
      // The crossed plane decides its own axis; along the others the point stays in the segment.
      const VecI first = hn::IfThenElse(forward, cursor.cell[axis], s.low[axis]);
      const VecI last = hn::IfThenElse(forward, hn::Sub(s.high[axis], one), cursor.cell[axis]);
      const VecI inside = hn::Min(hn::Max(found, first), last);
      const VecI crossed = hn::IfThenElse(forward, s.high[axis], hn::Sub(s.low[axis], one));
      const VecI next = hn::IfThenElse(int_mask(s.exits_by[axis]), crossed, inside);
      assign(cursor.cell[axis], lanes, next);
      const VecI last_cell = hn::Set(kInt, medium_.cell_counts[axis] - 1);
      outside = hn::Or(outside, hn::Or(cursor.cell[axis], hn::Sub(last_cell, cursor.cell[axis])));
    }
    const MaskF inside = hn::AndNot(float_mask(hn::Lt(outside, hn::Zero(kInt))), lanes);
    assign(cursor.record, lanes, hn::IfThenElseZero(int_mask(inside), record_of(cursor)));
    return inside;
  }

  /// Asks for the records of the cells that a group has come to.
  HWY_INLINE void prefetch(const State& state) const {
    for (size_t lane = 0; lane < kLanes; ++lane) {
      hwy::Prefetch(medium_.cells + state.record[lane]);
    }
  }

  HWY_INLINE void position(const Cursor& cursor, VecF (&point)[3]) const {
    for (int axis = 0; axis < 3; ++axis) {
      point[axis] = hn::MulAdd(cursor.t, cursor.direction[axis], cursor.origin[axis]);
    }
  }

 private:
  /// Also computed where a ray enters (transport/entry-inl.h).
  HWY_INLINE VecI record_of(const Cursor& cursor) const {
    const VecI row =
        hn::Add(hn::Mul(cursor.cell[0], hn::Set(kInt, medium_.cell_counts[1])), cursor.cell[1]);
    const VecI cell = hn::Add(hn::Mul(row, hn::Set(kInt, medium_.cell_counts[2])), cursor.cell[2]);
    return hn::Mul(cell, hn::Set(kInt, medium_.component_count + 1));
  }

  static HWY_INLINE VecI floor_to_int(VecF value) { return hn::ConvertTo(kInt, hn::Floor(value)); }

  MediumView medium_;
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_MEDIA_SEGMENTS_INL_H_
