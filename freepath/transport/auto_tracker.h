#pragma once
/// @file The tracker that `auto` stands for.

#include <string>
#include <string_view>

#include "freepath/media/medium.h"
#include "freepath/media/medium_channels.h"

namespace freepath {

inline constexpr std::string_view kAutoTracker = "auto";

struct TrackerChoice {
  std::string tracker;
  std::string reason;  ///< One line for users.
};

/// Chooses a tracker for a medium from whether its extinction differs between channels, from the
/// share of tentative collisions that a control of super-voxel minima would decide without a
/// look-up, and from the number of components that a look-up reads.
TrackerChoice choose_tracker(const Medium& medium);
/// The same for given cross sections of its components.
TrackerChoice choose_tracker(const Medium& medium, const MediumChannels& channels);

}  // namespace freepath
