#pragma once
/// @file The counts of walks by their names, for those who write and read them.

#include "freepath/tracking/statistics.h"

namespace freepath {

/// Calls visit(name, count) for each count of a walk, in the order of WalkStatistics.
/// @param statistics WalkStatistics, constant or not
template <class Statistics, class Visitor>
void visit_statistics(Statistics& statistics, const Visitor& visit) {
  visit("rays", statistics.rays);
  visit("tentative_collisions", statistics.tentative_collisions);
  visit("null_collisions", statistics.null_collisions);
  visit("real_collisions", statistics.real_collisions);
  visit("control_collisions", statistics.control_collisions);
  visit("lookups", statistics.lookups);
  visit("super_voxel_steps", statistics.super_voxel_steps);
  visit("bound_violations", statistics.bound_violations);
  visit("negative_weights", statistics.negative_weights);
  visit("largest_weight", statistics.largest_weight);
}

}  // namespace freepath
