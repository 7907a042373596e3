// What a walk counts, for its statistics.

#if defined(FREEPATH_TRACKING_WALK_TALLY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_WALK_TALLY_INL_H_
#undef FREEPATH_TRACKING_WALK_TALLY_INL_H_
#else
#define FREEPATH_TRACKING_WALK_TALLY_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "freepath/base/lanes-inl.h"
#include "freepath/tracking/collision-inl.h"
#include "freepath/tracking/statistics.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Counts what the lanes of a walk do; lanes are given as bits, one for each.
template <int N>
class WalkTally {
 public:
  explicit WalkTally(WalkStatistics& statistics)
      : statistics_(statistics), largest_weight_(hn::Zero(kFloat)) {}

  HWY_INLINE void steps(uint32_t lanes) { statistics_.super_voxel_steps += count(lanes); }

  /// Collisions that a control has decided without a look-up.
  HWY_INLINE void decisions(uint32_t lanes, const Collision<N>& c) {
    statistics_.tentative_collisions += count(lanes);
    statistics_.real_collisions += count(lanes);
    statistics_.control_collisions += count(lanes);
    weights(c);
  }

  /// Tentative collisions that looked up coefficients.
  /// @param real those of the lanes that scattered or absorbed
  HWY_INLINE void collisions(uint32_t lanes, uint32_t real, uint64_t lookups_each,
                             const Collision<N>& c) {
    statistics_.tentative_collisions += count(lanes);
    statistics_.real_collisions += count(real);
    statistics_.null_collisions += count(lanes) - count(real);
    statistics_.lookups += count(lanes) * lookups_each;
    weights(c);
  }

  /// Densities above what was said to bound them.
  HWY_INLINE void violations(VecF sigma_t, const Collision<N>& c) {
    // Rounding of an interpolated maximum is no violation.
    const MaskF above = hn::Gt(sigma_t, mul_add(c.full_rate, set(0.00001F), c.rate));
    statistics_.bound_violations += hn::CountTrue(kFloat, hn::And(above, c.lanes));
  }

  /// To be called at the end.
  void finish(std::size_t rays) {
    statistics_.rays += rays;
    statistics_.largest_weight =
        std::max(statistics_.largest_weight, hn::GetLane(hn::MaxOfLanes(kFloat, largest_weight_)));
  }

 private:
  static HWY_INLINE uint64_t count(uint32_t lanes) {
    return static_cast<uint64_t>(std::popcount(lanes));
  }

  HWY_INLINE void weights(const Collision<N>& c) {
    MaskF negative = no_lanes();
    for (int channel = 0; channel < N; ++channel) {
      const VecF now = hn::IfThenElseZero(c.lanes, c.weight[channel]);
      largest_weight_ = hn::Max(largest_weight_, hn::Abs(now));
      // Where the density reaches its bound, rounding may leave a trifle below 0.
      negative = hn::Or(negative, hn::Lt(now, set(-1e-6F)));
    }
    statistics_.negative_weights += hn::CountTrue(kFloat, negative);
  }

  WalkStatistics& statistics_;
  VecF largest_weight_;
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_WALK_TALLY_INL_H_
