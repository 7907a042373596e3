#pragma once
/// @file What a walk counts.

#include <algorithm>
#include <cstdint>

namespace freepath {

/// How a flight ended.
enum class Event : uint8_t {
  kEscape = 0,  ///< It left the medium or reached the ray's end.
  kScatter = 1,
  kAbsorb = 2,  ///< Absorbed, or (transmittance) nothing is left of it.
};

/// Counts over all rays of one or more walks. Sums and maxima alone, so that the order in which
/// they are merged does not matter.
struct WalkStatistics {
  uint64_t rays = 0;
  uint64_t tentative_collisions = 0;
  uint64_t null_collisions = 0;
  uint64_t real_collisions = 0;
  uint64_t control_collisions = 0;  ///< Decided without a look-up.
  uint64_t lookups = 0;             ///< Component densities read.
  uint64_t super_voxel_steps = 0;
  uint64_t bound_violations = 0;  ///< sigma_t above the rate where a tracker needs a bound.
  uint64_t negative_weights = 0;  ///< Collisions after which a weight was negative.
  float largest_weight = 0;       ///< Largest |weight| after a collision.

  void merge(const WalkStatistics& other) {
    rays += other.rays;
    tentative_collisions += other.tentative_collisions;
    null_collisions += other.null_collisions;
    real_collisions += other.real_collisions;
    control_collisions += other.control_collisions;
    lookups += other.lookups;
    super_voxel_steps += other.super_voxel_steps;
    bound_violations += other.bound_violations;
    negative_weights += other.negative_weights;
    largest_weight = std::max(largest_weight, other.largest_weight);
  }
};

}  // namespace freepath
