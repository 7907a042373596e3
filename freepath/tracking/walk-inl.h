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

#include <bit>

#include "freepath/base/lanes-inl.h"
#include "freepath/tracking/collision-inl.h"
#include "freepath/tracking/random-inl.h"
#include "freepath/tracking/statistics.h"
#include "freepath/tracking/streams.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Groups in flight: enough to hide a miss of the last cache behind the arithmetic of the others
/// (bench/README.md has the figures).
inline constexpr int kGroups = 8;

/// A group steps through super-voxels until no more than one in kSearchingShare of its lanes
/// still looks for its tentative collision; the others go on, and those resume in the next round.
inline constexpr int kSearchingShare = 4;

/// The Philox block of a flight that draws its hero; tentative collisions count up from 0.
inline constexpr uint32_t kHeroBlock = 0xFFFFFFFF;

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
        rays_(rays),
        entry_(entry),
        flights_(flights),
        statistics_(statistics),
        largest_weight_(hn::Zero(kFloat)) {}

  void run() {
    HWY_ALIGN_MAX Team teams[2] = {};
    statistics_.rays += rays_.size();
    for (Team& team : teams) {
      for (Group& group : team) refill(group);
    }
    // While one team computes, the memory that the other has asked for arrives.
    bool alive = true;
    while (alive) {
      alive = advance(teams[0], teams[1]);
      alive |= advance(teams[1], teams[0]);
    }
    statistics_.largest_weight =
        std::max(statistics_.largest_weight, hn::GetLane(hn::MaxOfLanes(kFloat, largest_weight_)));
  }

 private:
  static constexpr int kRows = Tracker::template kRows<N>;

  /// Lanes in flight together, one ray a lane.
  struct Group {
    typename Segments::State segments;
    typename Medium::State lookup;
    typename Medium::Control control;
    HWY_ALIGN_MAX float rows[kRows == 0 ? 1 : kRows][kLanes];  ///< The method's own.
    HWY_ALIGN_MAX float tau[kLanes];    ///< Optical depth still to go to the tentative collision.
    HWY_ALIGN_MAX float drawn[kLanes];  ///< Optical depth from the last one to it.
    HWY_ALIGN_MAX float rate[kLanes];   ///< Where it happened [1/m].
    HWY_ALIGN_MAX float rest_rate[kLanes];  ///< Of what a control has left to decide [1/m].
    HWY_ALIGN_MAX float uniform[kLanes];    ///< For the choice of the event.
    HWY_ALIGN_MAX float exit[kLanes];       ///< Of the segment it happened in [world].
    HWY_ALIGN_MAX float weight[N][kLanes];
    HWY_ALIGN_MAX float emitted[N][kLanes];
    HWY_ALIGN_MAX uint32_t words[3][kLanes];  ///< Random words for the collision to come.
    HWY_ALIGN_MAX uint32_t pixel[kLanes];
    HWY_ALIGN_MAX uint32_t sample[kLanes];
    HWY_ALIGN_MAX uint32_t stream[kLanes];
    HWY_ALIGN_MAX uint32_t block[kLanes];  ///< Philox blocks drawn, one per tentative collision.
    HWY_ALIGN_MAX uint32_t control_decided[kLanes];  ///< How many of those were.
    HWY_ALIGN_MAX int32_t component[kLanes];
    HWY_ALIGN_MAX uint32_t ray[kLanes];  ///< Slot in the streams.
    HWY_ALIGN_MAX float begin[kLanes];   ///< Where the ray entered the medium [world].
    uint32_t alive;                      ///< Lanes that hold a ray.
    uint32_t drawing;                    ///< Lanes that need a new optical depth.
    uint32_t searching;                  ///< Lanes on their way to a tentative collision.
    uint32_t colliding;                  ///< Lanes at a tentative collision.
    uint32_t looking;                    ///< Those of them whose density is looked up.
    uint32_t escaped;
    uint32_t scattered;
    uint32_t absorbed;
  };

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
      retire(group);
      if (group.alive == 0) continue;
      alive = true;
      draw(group);
    }
    if (!alive) return false;
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
    assign(tau, drawing, exponential_lanes(random.words[0]));
    hn::Store(tau, kFloat, group.tau);
    if constexpr (Tracker::kNeedsDepth) {
      hn::Store(hn::IfThenElse(drawing, tau, hn::Load(kFloat, group.drawn)), kFloat, group.drawn);
    }
    for (int i = 0; i < 3; ++i) {
      const VecU old = hn::Load(kUint, group.words[i]);
      hn::Store(hn::IfThenElse(fresh, random.words[i + 1], old), kUint, group.words[i]);
    }
    hn::Store(hn::Add(block, hn::IfThenElseZero(fresh, hn::Set(kUint, 1))), kUint, group.block);
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
    statistics_.super_voxel_steps += static_cast<uint64_t>(std::popcount(group.searching));
    const auto segment = segments_.segment(cursor, searching);
    const auto bounds = medium_.template bounds<Tracker::kRateNeedsControl>(segment);
    const VecF rate_here = rate_of(bounds, group);
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
    segments_.prefetch(group.segments);
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
    VecF rows[kRows == 0 ? 1 : kRows];
    load_rows(group, rows);
    tracker_.template advance<N>(bounds, length, rows);
    store_rows(rows, lanes, group);
  }
  static HWY_INLINE void load_rows(const Group& group, VecF* rows) {
    for (int row = 0; row < kRows; ++row) rows[row] = hn::Load(kFloat, group.rows[row]);
  }
  static HWY_INLINE void store_rows(const VecF* rows, MaskF lanes, Group& group) {
    for (int row = 0; row < kRows; ++row) {
      VecF kept = hn::Load(kFloat, group.rows[row]);
      assign(kept, lanes, rows[row]);
      hn::Store(kept, kFloat, group.rows[row]);
    }
  }

  /// Begins the look-ups of the lanes that have found their tentative collision; the control, if
  /// the method has one, decides first.
  HWY_INLINE void aim(Group& group) {
    group.drawing = group.scattered = group.absorbed = 0;
    group.looking = group.colliding;
    auto cursor = segments_.load(group.segments);
    const MaskF colliding = mask_of(group.colliding);
    const VecF step = hn::Div(hn::Load(kFloat, group.tau), hn::Load(kFloat, group.rate));
    const VecF place = hn::Min(hn::Add(cursor.t, step), hn::Load(kFloat, group.exit));
    if constexpr (Tracker::kAdvances) {
      const auto record = segments_.record(cursor, colliding);
      const auto bounds = medium_.template bounds<Tracker::kRateNeedsControl>(record);
      advance_rows(bounds, hn::Sub(place, cursor.t), colliding, group);
    }
    if constexpr (Tracker::kControl) {
      const auto record = segments_.record(cursor, colliding);
      medium_.set_control(record.record, tracker_.control_scale(), group.control);
      if constexpr (Tracker::kDecides) decide(group);
    }
    assign(cursor.t, colliding, place);
    hn::Store(cursor.t, kFloat, group.segments.t);
    VecF point[3];
    segments_.position(cursor, point);
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
    VecF uniform = uniform_lanes(hn::Load(kUint, group.words[0]));
    VecF rate = hn::Load(kFloat, group.rate);
    const VecI component = medium_.draw_component(record, uniform, rate);
    hn::Store(component, kInt, group.component);
    hn::Store(uniform, kFloat, group.uniform);
    hn::Store(rate, kFloat, group.rest_rate);
  }

  HWY_INLINE Collision<N> begin_collision(const Group& group, uint32_t lanes) const {
    Collision<N> c;
    c.lanes = mask_of(lanes);
    c.full_rate = c.rate = hn::IfThenElse(c.lanes, hn::Load(kFloat, group.rate), set(1.0F));
    c.uniform = uniform_lanes(hn::Load(kUint, group.words[0]));
    for (int channel = 0; channel < N; ++channel) {
      c.weight[channel] = hn::Load(kFloat, group.weight[channel]);
      c.emitted[channel] = hn::Load(kFloat, group.emitted[channel]);
    }
    c.scatter = c.absorb = no_lanes();
    c.scatter_uniform = hn::Zero(kFloat);
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
  HWY_INLINE void decide(Group& group) {
    Collision<N> c = begin_collision(group, group.colliding);
    const auto control = medium_.coefficients(group.control);
    const MaskF decided = tracker_.template decide<N>(modes_, control, c);
    const VecI component =
        medium_.choose_component(group.control, control, c.scatter_uniform, c.scatter, c.weight);
    hn::Store(component, kInt, group.component);
    hn::Store(c.rate, kFloat, group.rest_rate);
    hn::Store(c.uniform, kFloat, group.uniform);
    end_collision(c, group);
    const uint32_t bits = bits_of(decided);
    group.looking &= ~bits;
    const VecU count = hn::Load(kUint, group.control_decided);
    const VecU one = hn::IfThenElseZero(uint_mask(decided), hn::Set(kUint, 1));
    hn::Store(hn::Add(count, one), kUint, group.control_decided);
    const auto decisions = static_cast<uint64_t>(std::popcount(bits));
    statistics_.tentative_collisions += decisions;
    statistics_.real_collisions += decisions;
    statistics_.control_collisions += decisions;
    c.lanes = decided;
    count_weights(c);
  }

  /// Reads the coefficients, lets the tracker decide, and counts.
  HWY_INLINE void collide(Group& group) {
    Collision<N> c = begin_collision(group, group.looking);
    if constexpr ((Tracker::kControl && Tracker::kDecides) || Tracker::kOneComponent) {
      c.uniform = hn::Load(kFloat, group.uniform);
      c.rate = hn::IfThenElse(c.lanes, hn::Load(kFloat, group.rest_rate), set(1.0F));
    }
    VecF rows[kRows == 0 ? 1 : kRows];
    load_rows(group, rows);
    c.rows = rows;
    if constexpr (Tracker::kNeedsDepth) c.depth = hn::Load(kFloat, group.drawn);
    VecI component;
    VecF sigma_t;
    if constexpr (Tracker::kOneComponent) {
      component = hn::Load(kInt, group.component);
      const auto sigma = medium_.coefficients_of(component, group.lookup);
      tracker_.template collide<N>(modes_, sigma, c);
      sigma_t = hn::Add(sigma.sigma_a[0], sigma.sigma_s[0]);
    } else if constexpr (Tracker::kControl) {
      const auto sigma = medium_.residual(group.lookup, group.control);
      tracker_.template collide<N>(modes_, sigma, c);
      component = medium_.choose_component(group.lookup, group.control, sigma, c.scatter_uniform,
                                           hn::And(c.scatter, c.lanes), c.weight);
      sigma_t = hn::Sub(sigma.sigma_t[0], hn::Sub(c.full_rate, c.rate));
    } else {
      const auto sigma = medium_.coefficients(group.lookup);
      tracker_.template collide<N>(modes_, sigma, c);
      component = medium_.choose_component(group.lookup, sigma, c.scatter_uniform,
                                           hn::And(c.scatter, c.lanes), c.weight);
      sigma_t = hn::Add(sigma.sigma_a[0], sigma.sigma_s[0]);
    }
    c.scatter = hn::And(c.scatter, c.lanes);
    c.absorb = hn::And(c.absorb, c.lanes);
    const VecI before = hn::Load(kInt, group.component);
    hn::Store(hn::IfThenElse(int_mask(c.lanes), component, before), kInt, group.component);
    store_rows(rows, c.lanes, group);
    end_collision(c, group);
    group.drawing = group.colliding & ~(group.scattered | group.absorbed);
    count(group, sigma_t, c);
  }

  HWY_INLINE void count(const Group& group, VecF sigma_t, const Collision<N>& c) {
    const auto collisions = static_cast<uint64_t>(std::popcount(group.looking));
    const auto real =
        static_cast<uint64_t>(std::popcount((group.scattered | group.absorbed) & group.looking));
    statistics_.tentative_collisions += collisions;
    statistics_.real_collisions += real;
    statistics_.null_collisions += collisions - real;
    statistics_.lookups += collisions * lookups_per_collision();
    count_weights(c);
    if constexpr (Tracker::kNeedsBound) {
      // Rounding of an interpolated maximum is no violation.
      const MaskF above = hn::Gt(sigma_t, hn::MulAdd(c.full_rate, set(0.00001F), c.rate));
      statistics_.bound_violations += hn::CountTrue(kFloat, hn::And(above, c.lanes));
    }
  }

  HWY_INLINE void count_weights(const Collision<N>& c) {
    MaskF negative = no_lanes();
    for (int channel = 0; channel < N; ++channel) {
      const VecF now = hn::IfThenElseZero(c.lanes, c.weight[channel]);
      largest_weight_ = hn::Max(largest_weight_, hn::Abs(now));
      // Where the density reaches its bound, rounding may leave a trifle below 0.
      negative = hn::Or(negative, hn::Lt(now, set(-1e-6F)));
    }
    statistics_.negative_weights += hn::CountTrue(kFloat, negative);
  }

  HWY_INLINE uint32_t lookups_per_collision() const {
    return Tracker::kOneComponent ? 1U : static_cast<uint32_t>(medium_.component_count());
  }

  /// Writes out the rays that have ended and refills their lanes.
  HWY_INLINE void retire(Group& group) {
    const uint32_t done = group.escaped | group.scattered | group.absorbed;
    if (done == 0) return;
    if constexpr (kRows > 0) finish(group, done);
    for (uint32_t rest = done; rest != 0; rest &= rest - 1) {
      const int lane = std::countr_zero(rest);
      const uint32_t bit = 1U << lane;
      const uint32_t ray = group.ray[lane];
      flights_.t[ray] = group.segments.t[lane] + group.begin[lane];
      flights_.event[ray] = (group.scattered & bit) != 0  ? Event::kScatter
                            : (group.absorbed & bit) != 0 ? Event::kAbsorb
                                                          : Event::kEscape;
      flights_.component[ray] = static_cast<uint8_t>(group.component[lane]);
      for (int channel = 0; channel < N; ++channel) {
        flights_.weight[channel][ray] = group.weight[channel][lane];
        flights_.emitted[channel][ray] = group.emitted[channel][lane];
        if constexpr (Tracker::kDrawsHero) {
          flights_.density[channel][ray] = group.rows[channel][lane];
        }
      }
      // Every block but one that found no collision belongs to a tentative collision.
      const uint32_t unspent = (group.escaped & bit) != 0 ? 1 : 0;
      uint32_t looked_up = group.block[lane] - unspent;
      if constexpr (Tracker::kControl) looked_up -= group.control_decided[lane];
      flights_.lookups[ray] = looked_up * lookups_per_collision();
    }
    group.escaped = group.scattered = group.absorbed = group.colliding = group.looking = 0;
    group.alive &= ~done;
    group.drawing &= ~done;
    refill(group);
  }

  /// The final weights of rays that have ended, for methods that keep more than a weight.
  HWY_INLINE void finish(Group& group, uint32_t done) const {
    VecF rows[kRows == 0 ? 1 : kRows];
    load_rows(group, rows);
    VecF weight[N];
    for (int channel = 0; channel < N; ++channel) {
      weight[channel] = hn::Load(kFloat, group.weight[channel]);
    }
    VecF depth = hn::Zero(kFloat);  // since the last tentative collision
    if constexpr (Tracker::kNeedsDepth) {
      depth = hn::IfThenElseZero(mask_of(group.escaped), hn::Sub(hn::Load(kFloat, group.drawn),
                                                                 hn::Load(kFloat, group.tau)));
    }
    tracker_.template finish<N>(rows, depth, weight);
    const MaskF lanes = mask_of(done);
    store_rows(rows, lanes, group);
    for (int channel = 0; channel < N; ++channel) {
      VecF kept = hn::Load(kFloat, group.weight[channel]);
      assign(kept, lanes, weight[channel]);
      hn::Store(kept, kFloat, group.weight[channel]);
    }
  }

  /// Gives each empty lane the next ray of the stream, as far as the chunk reaches.
  HWY_INLINE void refill(Group& group) {
    if (next_ray_ == chunk_end_) {
      if (next_ray_ == rays_.size()) return;
      chunk_begin_ = next_ray_;
      chunk_ = &entry_.enter(next_ray_);
      chunk_end_ = std::min(next_ray_ + Entry::kChunk, rays_.size());
    }
    uint32_t lanes = ~group.alive & ((1U << kLanes) - 1);
    const std::size_t left = chunk_end_ - next_ray_;
    while (static_cast<std::size_t>(std::popcount(lanes)) > left) lanes &= lanes - 1;
    const Dealer dealer(lanes);
    segments_.refill(*chunk_, next_ray_ - chunk_begin_, dealer, group.segments);
    dealer.deal(chunk_->begin + (next_ray_ - chunk_begin_), group.begin);
    for (int channel = 0; channel < N; ++channel) {
      if (rays_.weighted()) {
        dealer.deal(rays_.weight[channel].data() + next_ray_, group.weight[channel]);
      } else {
        dealer.fill(1.0F, group.weight[channel]);
      }
      dealer.fill(0.0F, group.emitted[channel]);
    }
    if constexpr (kRows > 0) {
      for (int row = 0; row < kRows; ++row) {
        dealer.fill(tracker_.template row_start<N>(row), group.rows[row]);
      }
    }
    dealer.deal(rays_.pixel.data() + next_ray_, group.pixel);
    dealer.deal(rays_.sample.data() + next_ray_, group.sample);
    dealer.deal(rays_.stream.data() + next_ray_, group.stream);
    dealer.clear(group.block);
    if constexpr (Tracker::kControl) dealer.clear(group.control_decided);
    dealer.count_from(static_cast<uint32_t>(next_ray_), group.ray);
    if constexpr (Tracker::kDrawsHero) draw_hero(dealer, mask_of(lanes), group);
    next_ray_ += static_cast<std::size_t>(std::popcount(lanes));
    group.alive |= lanes;
    group.drawing |= lanes;
  }

  /// The channel that leads each new flight, by random numbers that no collision uses.
  HWY_INLINE void draw_hero(const Dealer& dealer, MaskF lanes, Group& group) const {
    VecF rows[kRows];
    VecF weight[N];
    for (int channel = 0; channel < N; ++channel) {
      if (rays_.weighted()) {
        dealer.deal(rays_.density[channel].data() + next_ray_, group.rows[channel]);
      }
      weight[channel] = hn::Load(kFloat, group.weight[channel]);
    }
    load_rows(group, rows);
    const RandomWords random =
        philox_lanes(hn::Set(kUint, kHeroBlock), hn::Load(kUint, group.stream),
                     hn::Load(kUint, group.sample), hn::Load(kUint, group.pixel), seed_);
    tracker_.template begin<N>(uniform_lanes(random.words[0]), weight, medium_.albedo(), rows);
    store_rows(rows, lanes, group);
  }

  const Tracker& tracker_;
  const Segments& segments_;
  const Medium& medium_;
  const WalkModes& modes_;
  uint64_t seed_;
  const RayStream& rays_;
  Entry& entry_;
  FlightStream& flights_;
  WalkStatistics& statistics_;
  VecF largest_weight_;
  const typename Entry::Rows* chunk_ = nullptr;  ///< Rays that have entered, from chunk_begin_ on.
  std::size_t chunk_begin_ = 0;
  std::size_t chunk_end_ = 0;
  std::size_t next_ray_ = 0;
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_WALK_INL_H_
