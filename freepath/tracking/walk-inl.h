// The walk: the one loop of every null-collision tracker and transmittance estimator. A stream of
// rays in, a stream of events out. Several groups of lanes are in flight at once; a lane whose ray
// has ended takes the next ray of the stream.
//
// The loop is written over three concepts, and knows neither media nor files:
//   Segments   the pieces of a ray over which the bounds are constant: load, store, segment, leave,
//              position (media/segments-inl.h)
//   Medium     bounds of a segment, and the coefficients at a point in three stages: aim, fetch,
//              coefficients (media/field_sum-inl.h)
//   Tracker    rate(bounds): density of tentative collisions [1/m], bound or not;
//              collide(modes, coefficients, collision): the event, and the new weight;
//              and what else its MethodTraits promise (tracking/collision-inl.h)
//
// Unspent optical depth is carried from segment to segment [SzirmayKalos11], so that a flight draws
// one exponential per tentative collision and not one per super-voxel.

#if defined(FREEPATH_TRACKING_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_WALK_INL_H_
#undef FREEPATH_TRACKING_WALK_INL_H_
#else
#define FREEPATH_TRACKING_WALK_INL_H_
#endif

#include "freepath/base/lanes-inl.h"
#include "freepath/tracking/collision-inl.h"
#include "freepath/tracking/lane_refill-inl.h"
#include "freepath/tracking/random-inl.h"
#include "freepath/tracking/streams.h"
#include "freepath/tracking/walk_group-inl.h"
#include "freepath/tracking/walk_tally-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Groups in flight: enough to hide a miss of the last cache behind the arithmetic of the others,
/// and few enough to stay in the nearest cache, of which groups of sixteen lanes take twice as much
/// (docs/performance.md and bench/README.md have the figures).
inline constexpr int kGroups = kLanes >= 16 ? 4 : 6;

/// A group steps through super-voxels until no more than one in kSearchingShare of its lanes
/// still looks for its tentative collision; the others go on, and those resume in the next round.
inline constexpr int kSearchingShare = 4;

/// Optical depth is drawn anew where the rate is so many times below the mean rate on the way: what
/// is left of a depth has 24 bits of the whole, of which 13 then tell how far a flight goes here.
inline constexpr float kFaint = 0x1p11F;

template <int N, class Tracker, class Segments, class Medium, class Entry>
class Walk {
 public:
  Walk(const Tracker& tracker, const Segments& segments, const Medium& medium,
       const WalkModes& modes, uint64_t seed, const RayStream& rays, Entry& entry,
       FlightStream& flights, WalkStatistics& statistics)
      : tracker_(tracker),
        segments_(segments),
        medium_(medium),
        modes_(modes),
        seed_(seed),
        ray_count_(rays.size()),
        tally_(statistics),
        refill_(tracker, segments, medium, seed, rays, entry, flights) {}

  void run() {
    HWY_ALIGN_MAX Team teams[2];
    for (Team& team : teams) {
      for (Group& group : team) {
        group.clear(medium_);
        refill_.refill(group);
      }
    }
    // While one team computes, the memory that the other has asked for arrives.
    bool alive = true;
    while (alive) {
      alive = advance(teams[0], teams[1]);
      alive |= advance(teams[1], teams[0]);
    }
    tally_.finish(ray_count_);
  }

 private:
  using Group = WalkGroup<N, Tracker, Segments, Medium>;
  using Team = Group[kGroups / 2];

  /// A round of one team: ends its collisions, then finds its next ones and aims at them; asks for
  /// the voxels of the other team meanwhile.
  /// @return whether a ray of the team is left
  HWY_NOINLINE bool advance(Team& team, Team& other) {
    bool alive = false;
    for (int i = 0; i < kGroups / 2; ++i) {
      if (other[i].looking != 0) fetch(other[i]);
      Group& group = team[i];
      if (group.looking != 0) collide(group);
    }
    for (Group& group : team) {
      refill_.retire(group);
      alive |= group.alive != 0;
    }
    if (!alive) return false;
    // Side by side, so that the chains of multiplications of one group fill the gaps of another.
    for (Group& group : team) draw(group);
    step_through_segments(team);
    for (Group& group : team) {
      if (group.alive != 0) aim(group);
    }
    return true;
  }

  /// One block of random words for each lane that begins a new flight between collisions, and its
  /// optical depth.
  HWY_INLINE void draw(Group& group) {
    group.searching = group.alive;
    group.colliding = group.looking = group.escaped = 0;
    const VecU block = hn::Load(kUint, group.block);
    const RandomWords random =
        philox_lanes(block, hn::Load(kUint, group.stream), hn::Load(kUint, group.sample),
                     hn::Load(kUint, group.pixel), seed_);
    const MaskF drawing = mask_of(group.drawing);
    const MaskU fresh = uint_mask(drawing);
    VecF tau = hn::Load(kFloat, group.tau);
    const auto second = [&] { return group.second_words(block, seed_).words[0]; };
    assign(tau, drawing, exponential_lanes(random.words[0], drawing, second));
    hn::Store(tau, kFloat, group.tau);
    hn::Store(hn::IfThenElse(drawing, tau, hn::Load(kFloat, group.fresh)), kFloat, group.fresh);
    if constexpr (Tracker::kNeedsDepth) {
      hn::Store(hn::IfThenElse(drawing, tau, hn::Load(kFloat, group.drawn)), kFloat, group.drawn);
    }
    for (int i = 0; i < 3; ++i) {
      const VecU old = hn::Load(kUint, group.words[i]);
      hn::Store(hn::IfThenElse(fresh, random.words[i + 1], old), kUint, group.words[i]);
    }
    hn::Store(hn::Add(block, hn::IfThenElseZero(fresh, hn::Set(kUint, 1))), kUint, group.block);
  }

  /// Draws the optical depth anew in lanes that go on at `t`: what is left of it is exponential
  /// again, whatever has been passed.
  HWY_NOINLINE void renew(MaskF lanes, VecF t, VecF& tau, Group& group) const {
    const VecF renewed = group.random(seed_).exponential(hn::BitCast(kUint, t));
    if constexpr (Tracker::kNeedsDepth) {
      VecF drawn = hn::Load(kFloat, group.drawn);
      assign(drawn, lanes, hn::Add(drawn, hn::Sub(renewed, tau)));
      hn::Store(drawn, kFloat, group.drawn);
    }
    assign(tau, lanes, renewed);
    VecF fresh = hn::Load(kFloat, group.fresh);
    assign(fresh, lanes, renewed);
    hn::Store(fresh, kFloat, group.fresh);
  }

  /// Every group takes a step before any takes its next: their gathers miss the caches together.
  HWY_INLINE void step_through_segments(Team& groups) {
    bool first = true;
    for (bool stepping = true; stepping; first = false) {
      stepping = false;
      for (Group& group : groups) {
        const int searching = std::popcount(group.searching);
        const int few = first ? 0 : std::popcount(group.alive) / kSearchingShare;
        if (searching <= few) continue;
        take_step(group);
        stepping = true;
      }
    }
  }

  /// To the tentative collision if it lies in this segment, else into the next segment.
  HWY_INLINE void take_step(Group& group) {
    auto cursor = segments_.load(group.segments);
    const MaskF searching = mask_of(group.searching);
    VecF tau = hn::Load(kFloat, group.tau);
    VecF rate = hn::Load(kFloat, group.rate);
    VecF exit = hn::Load(kFloat, group.exit);
    tally_.steps(group.searching);
    const auto segment = segments_.segment(cursor, searching);
    const auto bounds = medium_.template bounds<Tracker::kRateNeedsControl>(segment);
    const VecF rate_here = rate_of(bounds, group);
    // What is left of a depth has the digits of what was drawn: too few where the rate is that
    // small.
    const VecF passed = hn::Sub(hn::Load(kFloat, group.fresh), tau);
    const VecF faint = hn::Mul(hn::Mul(rate_here, cursor.t), set(kFaint));
    const MaskF coarse =
        hn::And(hn::And(searching, hn::Lt(faint, passed)), hn::Gt(rate_here, hn::Zero(kFloat)));
    if (HWY_UNLIKELY(!hn::AllFalse(kFloat, coarse))) renew(coarse, cursor.t, tau, group);
    const VecF depth = hn::Mul(rate_here, hn::Sub(segment.exit, cursor.t));
    const MaskF hits = hn::And(searching, hn::Lt(tau, depth));
    const MaskF leaves = hn::AndNot(hits, searching);
    // Where exactly, aim() finds out for all lanes at once.
    assign(rate, hits, rate_here);
    assign(exit, hits, segment.exit);
    assign(tau, leaves, hn::Sub(tau, depth));
    if constexpr (Tracker::kAdvances) {
      advance_rows(bounds, hn::Sub(segment.exit, cursor.t), leaves, group);
    }
    assign(cursor.t, leaves, segment.exit);
    const MaskF inside =
        segments_.leave(cursor, segment, hn::And(leaves, hn::Lt(segment.exit, cursor.end)));
    segments_.store(cursor, group.segments);
    hn::Store(tau, kFloat, group.tau);
    hn::Store(rate, kFloat, group.rate);
    hn::Store(exit, kFloat, group.exit);
    group.searching = bits_of(inside);
    group.colliding |= bits_of(hits);
    group.escaped |= bits_of(hn::AndNot(inside, leaves));
  }

  /// The rate of a method whose lanes differ in it, or not.
  template <class Bounds>
  HWY_INLINE VecF rate_of(const Bounds& bounds, const Group& group) const {
    if constexpr (requires { tracker_.rate(bounds, group.rows); }) {
      return tracker_.rate(bounds, group.rows);
    } else {
      return tracker_.rate(bounds);
    }
  }

  /// A stretch of `length` without a collision, as far as the method's rows are concerned.
  template <class Bounds>
  HWY_INLINE void advance_rows(const Bounds& bounds, VecF length, MaskF lanes, Group& group) const {
    VecF rows[Group::kStoredRows];
    group.load_rows(rows);
    tracker_.template advance<N>(bounds, length, rows);
    group.store_rows(rows, lanes);
  }

  /// Begins the look-ups of the lanes that have found their tentative collision; the control, if
  /// the method has one, decides first.
  HWY_INLINE void aim(Group& group) {
    group.drawing = group.scattered = group.absorbed = 0;
    group.looking = group.colliding;
    auto cursor = segments_.load(group.segments);
    const MaskF colliding = mask_of(group.colliding);
    const VecF step = hn::Div(hn::Load(kFloat, group.tau), hn::Load(kFloat, group.rate));
    const VecF position = hn::Min(hn::Add(cursor.t, step), hn::Load(kFloat, group.exit));
    if constexpr (Tracker::kAdvances) {
      const auto record = segments_.record(cursor, colliding);
      const auto bounds = medium_.template bounds<Tracker::kRateNeedsControl>(record);
      advance_rows(bounds, hn::Sub(position, cursor.t), colliding, group);
    }
    assign(cursor.t, colliding, position);
    hn::Store(cursor.t, kFloat, group.segments.t);
    VecF point[3];
    segments_.position(cursor, point);
    if constexpr (Tracker::kControl) {
      const auto record = segments_.record(cursor, colliding);
      medium_.set_control(record.record, tracker_.control_scale(), group.control);
      if constexpr (Tracker::kDecides) decide(point, group);
    }
    medium_.lookup().aim(point, mask_of(group.looking), hn::Load(kUint, group.words[1]),
                         hn::Load(kUint, group.words[2]), group.lookup);
    if constexpr (Tracker::kOneComponent) {
      draw_component(segments_.record(cursor, colliding), group);
      medium_.lookup().prefetch_index(group.lookup, group.component);
    } else {
      medium_.lookup().prefetch_index(group.lookup);
    }
  }

  HWY_INLINE void fetch(Group& group) const {
    if constexpr (Tracker::kOneComponent) {
      medium_.lookup().fetch(group.lookup, group.component);
    } else {
      medium_.lookup().fetch(group.lookup);
    }
  }

  template <class Record>
  HWY_INLINE void draw_component(const Record& record, Group& group) const {
    const MaskF lanes = mask_of(group.colliding);
    VecF uniform = group.event_uniform(lanes, seed_);
    VecF rate = hn::Load(kFloat, group.rate);
    const VecI component =
        medium_.draw_component(record, group.random(seed_), lanes, uniform, rate);
    hn::Store(component, kInt, group.component);
    hn::Store(uniform, kFloat, group.uniform);
    hn::Store(rate, kFloat, group.rest_rate);
  }

  /// All but the number that chooses.
  HWY_INLINE Collision<N> begin_collision(const Group& group, uint32_t lanes) const {
    Collision<N> c;
    c.lanes = mask_of(lanes);
    c.full_rate = c.rate = hn::IfThenElse(c.lanes, hn::Load(kFloat, group.rate), set(1.0F));
    c.random = group.random(seed_);
    for (int channel = 0; channel < N; ++channel) {
      c.weight[channel] = hn::Load(kFloat, group.weight[channel]);
      c.emitted[channel] = hn::Load(kFloat, group.emitted[channel]);
    }
    c.scatter = c.absorb = no_lanes();
    return c;
  }

  /// Writes back what a tracker has done to the lanes of a collision.
  HWY_INLINE void end_collision(const Collision<N>& c, Group& group) const {
    for (int channel = 0; channel < N; ++channel) {
      VecF weight = hn::Load(kFloat, group.weight[channel]);
      assign(weight, c.lanes, c.weight[channel]);
      hn::Store(weight, kFloat, group.weight[channel]);
      if (!modes_.emits) continue;
      VecF emitted = hn::Load(kFloat, group.emitted[channel]);
      assign(emitted, c.lanes, c.emitted[channel]);
      hn::Store(emitted, kFloat, group.emitted[channel]);
    }
    group.scattered |= bits_of(c.scatter);
    group.absorbed |= bits_of(c.absorb);
  }

  /// Lets the control decide what it can without a look-up.
  HWY_INLINE void decide(const VecF (&point)[3], Group& group) {
    Collision<N> c = begin_collision(group, group.colliding);
    c.uniform = group.event_uniform(c.lanes, seed_);
    auto control = medium_.coefficients(group.control);
    if (varies_emission()) medium_.add_emission(group.control, point, c.lanes, control);
    const MaskF decided = tracker_.template decide<N>(modes_, control, c);
    const VecI component =
        medium_.choose_component(group.control, control, c.random, c.scatter, c.weight);
    hn::Store(component, kInt, group.component);
    hn::Store(c.rate, kFloat, group.rest_rate);
    hn::Store(c.uniform, kFloat, group.uniform);
    end_collision(c, group);
    const uint32_t bits = bits_of(decided);
    group.looking &= ~bits;
    const VecU count = hn::Load(kUint, group.control_decided);
    const VecU one = hn::IfThenElseZero(uint_mask(decided), hn::Set(kUint, 1));
    hn::Store(hn::Add(count, one), kUint, group.control_decided);
    c.lanes = decided;
    tally_.decisions(bits, c);
  }

  /// Reads the coefficients, lets the tracker decide, and counts.
  HWY_INLINE void collide(Group& group) {
    Collision<N> c = begin_collision(group, group.looking);
    if constexpr ((Tracker::kControl && Tracker::kDecides) || Tracker::kOneComponent) {
      c.uniform = hn::Load(kFloat, group.uniform);
      c.rate = hn::IfThenElse(c.lanes, hn::Load(kFloat, group.rest_rate), set(1.0F));
    } else {
      c.uniform = group.event_uniform(c.lanes, seed_);
    }
    VecF rows[Group::kStoredRows];
    group.load_rows(rows);
    c.rows = rows;
    if constexpr (Tracker::kNeedsDepth) c.depth = hn::Load(kFloat, group.drawn);
    VecF point[3] = {c.rate, c.rate, c.rate};  // of no use but to emission that varies
    if (varies_emission()) segments_.position(segments_.load(group.segments), point);
    VecI component;
    VecF sigma_t;
    if constexpr (Tracker::kOneComponent) {
      component = hn::Load(kInt, group.component);
      auto sigma = medium_.coefficients_of(component, group.lookup);
      if (varies_emission()) {
        medium_.add_emission(component, group.lookup, point, c.lanes, sigma);
      }
      tracker_.template collide<N>(modes_, sigma, c);
      sigma_t = hn::Add(sigma.sigma_a[0], sigma.sigma_s[0]);
    } else if constexpr (Tracker::kControl) {
      auto sigma = medium_.residual(group.lookup, group.control);
      if (varies_emission()) {
        medium_.add_emission(group.lookup, group.control, point, c.lanes, sigma);
      }
      tracker_.template collide<N>(modes_, sigma, c);
      component = medium_.choose_component(group.lookup, group.control, sigma, c.random,
                                           hn::And(c.scatter, c.lanes), c.weight);
      sigma_t = hn::Sub(sigma.sigma_t[0], hn::Sub(c.full_rate, c.rate));
    } else {
      auto sigma = medium_.coefficients(group.lookup);
      if (varies_emission()) {
        medium_.add_emission(group.lookup, point, c.lanes, sigma);
      }
      tracker_.template collide<N>(modes_, sigma, c);
      component = medium_.choose_component(group.lookup, sigma, c.random,
                                           hn::And(c.scatter, c.lanes), c.weight);
      sigma_t = hn::Add(sigma.sigma_a[0], sigma.sigma_s[0]);
    }
    c.scatter = hn::And(c.scatter, c.lanes);
    c.absorb = hn::And(c.absorb, c.lanes);
    const VecI before = hn::Load(kInt, group.component);
    hn::Store(hn::IfThenElse(int_mask(c.lanes), component, before), kInt, group.component);
    group.store_rows(rows, c.lanes);
    end_collision(c, group);
    group.drawing = group.colliding & ~(group.scattered | group.absorbed);
    tally_.collisions(group.looking, (group.scattered | group.absorbed) & group.looking,
                      Group::lookups_per_collision(medium_), c);
    if constexpr (Tracker::kNeedsBound) tally_.violations(sigma_t, c);
  }

  /// Whether emission is wanted and varies from place to place.
  HWY_INLINE bool varies_emission() const { return modes_.emits && medium_.has_radiance_fields(); }

  const Tracker& tracker_;
  const Segments& segments_;
  const Medium& medium_;
  const WalkModes& modes_;
  uint64_t seed_;
  std::size_t ray_count_;
  WalkTally<N> tally_;
  LaneRefill<N, Tracker, Segments, Medium, Entry> refill_;
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_WALK_INL_H_
