// The state of a group of lanes on a walk.

#if defined(FREEPATH_TRACKING_WALK_GROUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_WALK_GROUP_INL_H_
#undef FREEPATH_TRACKING_WALK_GROUP_INL_H_
#else
#define FREEPATH_TRACKING_WALK_GROUP_INL_H_
#endif

#include <cstddef>
#include <cstring>
#include <type_traits>

#include "freepath/base/lanes-inl.h"
#include "freepath/tracking/random-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// A control that a method does not have.
struct NoControl {};

/// Lanes in flight together, one ray a lane.
template <int N, class Tracker, class Segments, class Medium>
struct WalkGroup {
  static constexpr int kRows = Tracker::template kRows<N>;
  /// Rows in arrays, which can't be empty.
  static constexpr int kStoredRows = kRows == 0 ? 1 : kRows;
  using Control = std::conditional_t<Tracker::kControl, typename Medium::Control, NoControl>;

  typename Segments::State segments;
  HWY_ALIGN_MAX float rows[kStoredRows][kLanes];  ///< The method's own.
  HWY_ALIGN_MAX float tau[kLanes];        ///< Optical depth still to go to the tentative collision.
  HWY_ALIGN_MAX float fresh[kLanes];      ///< The same where its digits were drawn.
  HWY_ALIGN_MAX float drawn[kLanes];      ///< Optical depth from the last one to it.
  HWY_ALIGN_MAX float rate[kLanes];       ///< Where it happened [1/m].
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
  // Last, since most media use but the first of their many components: all else stands together.
  typename Medium::State lookup;
  Control control;

  /// Empties all lanes. What no lane of this medium reads is left as it is: look-ups of all the
  /// components that a medium may have would take a part of the nearest cache.
  HWY_INLINE void clear(const Medium& medium) {
    std::memset(static_cast<void*>(this), 0, offsetof(WalkGroup, lookup));
    medium.clear(lookup);
    if constexpr (Tracker::kControl) medium.clear(control);
  }

  HWY_INLINE void load_rows(VecF (&values)[kStoredRows]) const {
    for (int row = 0; row < kRows; ++row) values[row] = hn::Load(kFloat, rows[row]);
  }
  HWY_INLINE void store_rows(const VecF (&values)[kStoredRows], MaskF lanes) {
    for (int row = 0; row < kRows; ++row) {
      VecF kept = hn::Load(kFloat, rows[row]);
      assign(kept, lanes, values[row]);
      hn::Store(kept, kFloat, rows[row]);
    }
  }

  HWY_INLINE RandomCounter random(uint64_t seed) const {
    return {block, stream, sample, pixel, seed};
  }

  HWY_INLINE RandomWords second_words(VecU of_block, uint64_t seed) const {
    return HWY_NAMESPACE::second_words(of_block, hn::Load(kUint, stream), hn::Load(kUint, sample),
                                       hn::Load(kUint, pixel), seed);
  }

  /// The number that chooses the event at a tentative collision.
  HWY_INLINE VecF event_uniform(MaskF lanes, uint64_t seed) const {
    const auto second = [&] {
      return second_words(hn::Sub(hn::Load(kUint, block), hn::Set(kUint, 1)), seed).words[1];
    };
    return uniform_lanes(hn::Load(kUint, words[0]), lanes, second);
  }

  /// Component densities that a tentative collision reads.
  static HWY_INLINE uint32_t lookups_per_collision(const Medium& medium) {
    return Tracker::kOneComponent ? 1U : static_cast<uint32_t>(medium.component_count());
  }
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_WALK_GROUP_INL_H_
