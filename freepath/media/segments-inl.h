// Segments of rays through the super-voxels, in lanes: a digital differential analyser
// [Amanatides87] over integer cells that leaves a whole empty cube in one step.

#if defined(FREEPATH_MEDIA_SEGMENTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_MEDIA_SEGMENTS_INL_H_
#undef FREEPATH_MEDIA_SEGMENTS_INL_H_
#else
#define FREEPATH_MEDIA_SEGMENTS_INL_H_
#endif

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
  VecF cell[3];       ///< Super-voxel that holds the point at t; whole numbers.
  VecI record;        ///< Position of its record in Medium::walk_cells().
  VecF head;          ///< First number of that record.
};

/// The same in memory, one row a lane.
struct SegmentState {
  HWY_ALIGN_MAX float origin[3][kLanes];
  HWY_ALIGN_MAX float direction[3][kLanes];
  HWY_ALIGN_MAX float inverse[3][kLanes];
  HWY_ALIGN_MAX float t[kLanes];
  HWY_ALIGN_MAX float end[kLanes];
  HWY_ALIGN_MAX float cell[3][kLanes];
  HWY_ALIGN_MAX int32_t record[kLanes];
  HWY_ALIGN_MAX float head[kLanes];
};

/// A segment: the part of a ray in one super-voxel, or in one empty cube of them.
struct Segment {
  VecI record;        ///< Position of the super-voxel's record in Medium::walk_cells().
  VecF head;          ///< First number of that record.
  VecF exit;          ///< Where it ends [world].
  VecF plane[3];      ///< Where each axis leaves it [walk space].
  MaskF forward[3];   ///< Whether the ray climbs that axis.
  MaskF exits_by[3];  ///< The axis whose plane is crossed first; exactly one.
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
      cursor.cell[axis] = hn::Load(kFloat, state.cell[axis]);
    }
    cursor.t = hn::Load(kFloat, state.t);
    cursor.end = hn::Load(kFloat, state.end);
    cursor.record = hn::Load(kInt, state.record);
    cursor.head = hn::Load(kFloat, state.head);
    return cursor;
  }

  /// Writes back what a walk changes.
  HWY_INLINE void store(const Cursor& cursor, State& state) const {
    for (int axis = 0; axis < 3; ++axis) hn::Store(cursor.cell[axis], kFloat, state.cell[axis]);
    hn::Store(cursor.t, kFloat, state.t);
    hn::Store(cursor.record, kInt, state.record);
    hn::Store(cursor.head, kFloat, state.head);
  }

  /// Puts rows of entered rays, from `first` on, into the refill's lanes.
  template <class Rows>
  HWY_INLINE void refill(const Rows& rays, std::size_t first, const Refill& refill,
                         State& state) const {
    for (int axis = 0; axis < 3; ++axis) {
      refill.deal(rays.origin[axis] + first, state.origin[axis]);
      refill.deal(rays.direction[axis] + first, state.direction[axis]);
      refill.deal(rays.inverse[axis] + first, state.inverse[axis]);
      refill.deal(rays.cell[axis] + first, state.cell[axis]);
    }
    refill.deal(rays.length + first, state.end);
    refill.fill(0.0F, state.t);
    refill.deal(rays.record + first, state.record);
    refill.deal(rays.head + first, state.head);
  }

  /// The segment at the cursor. Lanes outside the mask get entry 0 and no meaning.
  HWY_INLINE Segment segment(const Cursor& cursor, MaskF lanes) const {
    Segment s;
    s.record = hn::IfThenElseZero(int_mask(lanes), cursor.record);
    s.head = cursor.head;
    const VecF radius = hn::Max(hn::Neg(s.head), set(1.0F));
    const VecF radius_back = hn::Sub(set(1.0F), radius);
    VecF exits[3];
    for (int axis = 0; axis < 3; ++axis) {
      s.forward[axis] = hn::Ge(cursor.direction[axis], hn::Zero(kFloat));
      s.plane[axis] =
          hn::Add(cursor.cell[axis], hn::IfThenElse(s.forward[axis], radius, radius_back));
      exits[axis] = hn::Mul(hn::Sub(s.plane[axis], cursor.origin[axis]), cursor.inverse[axis]);
    }
    const VecF nearest = hn::Min(hn::Min(exits[0], exits[1]), exits[2]);
    s.exits_by[0] = hn::Le(exits[0], nearest);
    s.exits_by[1] = hn::AndNot(s.exits_by[0], hn::Le(exits[1], nearest));
    s.exits_by[2] = hn::Not(hn::Or(s.exits_by[0], s.exits_by[1]));
    s.exit = hn::Max(hn::Min(nearest, cursor.end), cursor.t);
    return s;
  }

  /// The record at the cursor alone, without the segment's end.
  HWY_INLINE Segment record(const Cursor& cursor, MaskF lanes) const {
    Segment s;
    s.record = hn::IfThenElseZero(int_mask(lanes), cursor.record);
    s.head = cursor.head;
    return s;
  }

  /// Moves the lanes of the mask, whose t is the segment's exit, into the next cell. Cells only
  /// ever advance in the ray's direction, whatever rounding does, so every walk ends.
  /// @return the lanes that are still inside the super-voxels
  HWY_INLINE MaskF leave(Cursor& cursor, const Segment& s, MaskF lanes) const {
    MaskF inside = lanes;
    for (int axis = 0; axis < 3; ++axis) {
      const VecF plane = s.plane[axis];
      const VecF before = hn::Sub(plane, set(1.0F));
      // The crossed plane decides its own axis; along the others the point stays in the segment.
      const VecF last = hn::IfThenElse(s.forward[axis], before, plane);
      const VecF crossed = hn::IfThenElse(s.forward[axis], plane, before);
      const VecF found = hn::Floor(mul_add(cursor.t, cursor.direction[axis], cursor.origin[axis]));
      const VecF stays = hn::Min(hn::Max(found, hn::Min(cursor.cell[axis], last)),
                                 hn::Max(cursor.cell[axis], last));
      const VecF next = hn::IfThenElse(s.exits_by[axis], crossed, stays);
      assign(cursor.cell[axis], lanes, next);
      inside = hn::AndNot(hn::Lt(next, hn::Zero(kFloat)), inside);
      inside = hn::And(inside, hn::Lt(next, set(static_cast<float>(medium_.cell_counts[axis]))));
    }
    const VecI record = hn::IfThenElseZero(int_mask(inside), record_of(cursor));
    assign(cursor.record, lanes, record);
    // Read now and used in the next step, which other groups' steps come before: none waits for it.
    assign(cursor.head, lanes, hn::GatherIndex(kFloat, medium_.cells, record));
    return inside;
  }

  HWY_INLINE void position(const Cursor& cursor, VecF (&point)[3]) const {
    for (int axis = 0; axis < 3; ++axis) {
      point[axis] = mul_add(cursor.t, cursor.direction[axis], cursor.origin[axis]);
    }
  }

 private:
  /// Also computed where a ray enters (transport/entry-inl.h).
  HWY_INLINE VecI record_of(const Cursor& cursor) const {
    const VecI row =
        hn::Add(hn::Mul(small_to_int(cursor.cell[0]), hn::Set(kInt, medium_.cell_counts[1])),
                small_to_int(cursor.cell[1]));
    const VecI cell =
        hn::Add(hn::Mul(row, hn::Set(kInt, medium_.cell_counts[2])), small_to_int(cursor.cell[2]));
    return medium_.component_count == 1 ? cell
                                        : hn::Mul(cell, hn::Set(kInt, medium_.component_count));
  }

  MediumView medium_;
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_MEDIA_SEGMENTS_INL_H_
