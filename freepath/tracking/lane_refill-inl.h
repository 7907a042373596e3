// How the rays of a stream come into the lanes of a walk, and their flights out of them.

#if defined(FREEPATH_TRACKING_RAY_DEALER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_RAY_DEALER_INL_H_
#undef FREEPATH_TRACKING_RAY_DEALER_INL_H_
#else
#define FREEPATH_TRACKING_RAY_DEALER_INL_H_
#endif

#include <algorithm>
#include <bit>

#include "freepath/tracking/random-inl.h"
#include "freepath/tracking/streams.h"
#include "freepath/tracking/walk_group-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// The Philox block of a flight that draws its hero; tentative collisions count up from 0.
inline constexpr uint32_t kHeroBlock = 0x1FFFFFFF;

/// Gives rays to the lanes of groups, and takes back what became of them.
template <int N, class Tracker, class Segments, class Medium, class Entry>
class LaneRefill {
 public:
  using Group = WalkGroup<N, Tracker, Segments, Medium>;

  LaneRefill(const Tracker& tracker, const Segments& segments, const Medium& medium, uint64_t seed,
             const RayStream& rays, Entry& entry, FlightStream& flights)
      : tracker_(tracker),
        segments_(segments),
        medium_(medium),
        seed_(seed),
        rays_(rays),
        entry_(entry),
        flights_(flights) {}

  /// Writes out the rays that have ended and refills their lanes.
  HWY_INLINE void retire(Group& group) {
    const uint32_t done = group.escaped | group.scattered | group.absorbed;
    if (done == 0) return;
    if constexpr (Group::kRows > 0) finish(group, done);
    write_out(group, done);
    group.escaped = group.scattered = group.absorbed = group.colliding = group.looking = 0;
    group.alive &= ~done;
    group.drawing &= ~done;
    refill(group);
  }

  /// Gives each empty lane the next ray of the stream, as far as the chunk reaches.
  HWY_INLINE void refill(Group& group) {
    if (next_ray_ == chunk_end_) {
      if (next_ray_ == rays_.size()) return;
      begin_chunk();
    }
    uint32_t lanes = ~group.alive & ((1U << kLanes) - 1);
    const std::size_t left = chunk_end_ - next_ray_;
    while (static_cast<std::size_t>(std::popcount(lanes)) > left) lanes &= lanes - 1;
    const Refill refill(lanes);
    segments_.refill(*chunk_, next_ray_ - chunk_begin_, refill, group.segments);
    refill.deal(chunk_->begin + (next_ray_ - chunk_begin_), group.begin);
    for (int channel = 0; channel < N; ++channel) {
      if (rays_.weighted()) {
        refill.deal(rays_.weight[medium_.source(channel)].data() + next_ray_,
                    group.weight[channel]);
      } else {
        refill.fill(1.0F, group.weight[channel]);
      }
      refill.fill(0.0F, group.emitted[channel]);
    }
    if constexpr (Group::kRows > 0) {
      for (int row = 0; row < Group::kRows; ++row) {
        refill.fill(tracker_.template row_start<N>(row), group.rows[row]);
      }
    }
    refill.deal(rays_.pixel.data() + next_ray_, group.pixel);
    refill.deal(rays_.sample.data() + next_ray_, group.sample);
    refill.deal(rays_.stream.data() + next_ray_, group.stream);
    refill.clear(group.block);
    if constexpr (Tracker::kControl) refill.clear(group.control_decided);
    refill.count_from(static_cast<uint32_t>(next_ray_), group.ray);
    if constexpr (Tracker::kDrawsHero) draw_hero(refill, mask_of(lanes), group);
    next_ray_ += static_cast<std::size_t>(std::popcount(lanes));
    group.alive |= lanes;
    group.drawing |= lanes;
  }

 private:
  /// Enters the next rays, and asks for what their lanes will read and write besides.
  HWY_INLINE void begin_chunk() {
    chunk_begin_ = next_ray_;
    chunk_ = &entry_.enter(chunk_begin_);
    const std::size_t count = std::min(Entry::kChunk, rays_.size() - chunk_begin_);
    chunk_end_ = chunk_begin_ + count;
    prefetch_row(rays_.pixel.data() + chunk_begin_, count);
    prefetch_row(rays_.sample.data() + chunk_begin_, count);
    prefetch_row(rays_.stream.data() + chunk_begin_, count);
    prefetch_row(flights_.t.data() + chunk_begin_, count);
    prefetch_row(flights_.event.data() + chunk_begin_, count);
    prefetch_row(flights_.component.data() + chunk_begin_, count);
    prefetch_row(flights_.lookups.data() + chunk_begin_, count);
    for (int channel = 0; channel < N; ++channel) {
      prefetch_row(flights_.weight[channel].data() + chunk_begin_, count);
      prefetch_row(flights_.emitted[channel].data() + chunk_begin_, count);
    }
  }

  /// What became of the rays in the lanes `done`, into their slots.
  HWY_INLINE void write_out(const Group& group, uint32_t done) const {
    HWY_ALIGN_MAX float t[kLanes];
    HWY_ALIGN_MAX uint32_t event[kLanes];
    HWY_ALIGN_MAX uint32_t lookups[kLanes];
    hn::Store(hn::Add(hn::Load(kFloat, group.segments.t), hn::Load(kFloat, group.begin)), kFloat,
              t);
    hn::Store(events(group), kUint, event);
    hn::Store(lookups_of(group), kUint, lookups);
    // In locals, since a store of bytes could change what the vectors of `flights_` point at.
    float* const out_t = flights_.t.data();
    Event* const out_event = flights_.event.data();
    uint8_t* const out_component = flights_.component.data();
    uint32_t* const out_lookups = flights_.lookups.data();
    float* out_weight[N];
    float* out_emitted[N];
    float* out_density[N];
    for (int channel = 0; channel < N; ++channel) {
      out_weight[channel] = flights_.weight[channel].data();
      out_emitted[channel] = flights_.emitted[channel].data();
      out_density[channel] = flights_.density[channel].data();
    }
    for (uint32_t rest = done; rest != 0; rest &= rest - 1) {
      const int lane = std::countr_zero(rest);
      const uint32_t ray = group.ray[lane];
      out_t[ray] = t[lane];
      out_event[ray] = static_cast<Event>(event[lane]);
      out_component[ray] = static_cast<uint8_t>(group.component[lane]);
      out_lookups[ray] = lookups[lane];
      for (int channel = 0; channel < N; ++channel) {
        out_weight[channel][ray] = group.weight[channel][lane];
        out_emitted[channel][ray] = group.emitted[channel][lane];
        if constexpr (Tracker::kDrawsHero) {
          out_density[channel][ray] = group.rows[channel][lane];
        }
      }
    }
  }

  static HWY_INLINE VecU events(const Group& group) {
    const auto code = [](Event event) { return hn::Set(kUint, static_cast<uint32_t>(event)); };
    const VecU unscattered = hn::IfThenElse(uint_mask(mask_of(group.absorbed)),
                                            code(Event::kAbsorb), code(Event::kEscape));
    return hn::IfThenElse(uint_mask(mask_of(group.scattered)), code(Event::kScatter), unscattered);
  }

  /// Look-ups of flights that have ended.
  HWY_INLINE VecU lookups_of(const Group& group) const {
    // Every block but one that found no collision belongs to a tentative collision.
    const MaskU escaped = uint_mask(mask_of(group.escaped));
    VecU collisions = hn::Load(kUint, group.block);
    collisions = hn::Sub(collisions, hn::IfThenElseZero(escaped, hn::Set(kUint, 1)));
    if constexpr (Tracker::kControl) {
      collisions = hn::Sub(collisions, hn::Load(kUint, group.control_decided));
    }
    return hn::Mul(collisions, hn::Set(kUint, Group::lookups_per_collision(medium_)));
  }

  /// The final weights of rays that have ended, for methods that keep more than a weight.
  HWY_INLINE void finish(Group& group, uint32_t done) const {
    VecF rows[Group::kStoredRows];
    group.load_rows(rows);
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
    group.store_rows(rows, lanes);
    for (int channel = 0; channel < N; ++channel) {
      VecF kept = hn::Load(kFloat, group.weight[channel]);
      assign(kept, lanes, weight[channel]);
      hn::Store(kept, kFloat, group.weight[channel]);
    }
  }

  /// The channel that leads each new flight, by random numbers that no collision uses.
  HWY_INLINE void draw_hero(const Refill& refill, MaskF lanes, Group& group) const {
    VecF rows[Group::kStoredRows];
    VecF weight[N];
    for (int channel = 0; channel < N; ++channel) {
      if (rays_.weighted()) {
        refill.deal(rays_.density[medium_.source(channel)].data() + next_ray_, group.rows[channel]);
      }
      weight[channel] = hn::Load(kFloat, group.weight[channel]);
    }
    group.load_rows(rows);
    HWY_ALIGN_MAX uint32_t block[kLanes];
    hn::Store(hn::Set(kUint, kHeroBlock), kUint, block);
    const RandomCounter random = {block, group.stream, group.sample, group.pixel, seed_};
    tracker_.template begin<N>(random, lanes, weight, medium_.albedo(), rows);
    group.store_rows(rows, lanes);
  }

  const Tracker& tracker_;
  const Segments& segments_;
  const Medium& medium_;
  uint64_t seed_;
  const RayStream& rays_;
  Entry& entry_;
  FlightStream& flights_;
  const typename Entry::Rows* chunk_ = nullptr;  ///< Rays that have entered, from chunk_begin_ on.
  std::size_t chunk_begin_ = 0;
  std::size_t chunk_end_ = 0;
  std::size_t next_ray_ = 0;
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_RAY_DEALER_INL_H_
