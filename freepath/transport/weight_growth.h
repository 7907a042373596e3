#pragma once
/// @file How far the weights of paths can grow from scattering to scattering.

#include <cstdint>
#include <string>

#include "freepath/media/medium_channels.h"
#include "freepath/transport/walker.h"

namespace freepath {

/// Growth of a path's weight. A flight of any tracker has the right mean; a path multiplies the
/// weights of its flights, and where their mean square grows the variance of a picture becomes
/// infinite (docs/equations.md, section 4).
struct WeightGrowth {
  /// Mean square of the weight that a flight leaves with, relative to what it began with, at most.
  /// 1: weights of paths are bounded, whatever the number of scatterings. Infinite: nothing bounds
  /// it.
  double per_flight = 1;
  /// Mean square that scatters in a mean free path, relative to what flies; its quotient with
  /// per_flight is what the mean square loses in that length.
  double per_mean_free_path = 1;
  /// What makes it grow, and what to take instead, for users; empty where nothing does.
  std::string reason;

  bool bounded() const { return reason.empty(); }
};

/// Growth of weights by a tracker in a medium of given channels.
/// @throws Error for a tracker that does not exist
WeightGrowth weight_growth(const MediumChannels& channels, const WalkSettings& settings);

/// Growth of the weight of a shadow ray, in as many mean free paths as it is long: the mean square
/// of an estimate is at most 1 where its rate is at least half of the bound.
/// @throws Error for an estimator that does not exist
WeightGrowth shadow_weight_growth(const WalkSettings& settings);

/// Refuses weights of paths whose mean square may grow more than a thousandfold.
/// @param max_scatterings of a path
/// @throws Error that says what grows and what to take instead
void require_bounded_weights(const WeightGrowth& growth, uint32_t max_scatterings);

/// What `freepath trackers` says of a method's weights in paths of many scatterings; empty where
/// they are bounded with all options.
std::string weights_in_paths(const MethodInfo& info);

}  // namespace freepath
