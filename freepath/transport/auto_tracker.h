#pragma once
/// @file The tracker that `auto` stands for.

#include <span>
#include <string>
#include <string_view>

#include "freepath/media/medium.h"
#include "freepath/media/medium_channels.h"
#include "freepath/tracking/method.h"

namespace freepath {

/// What users may name: the trackers, and `auto`, which stands for one of them and is in no
/// registry.
std::span<const MethodInfo> tracker_choices();

/// Whether a name stands for the tracker that the medium decides on.
bool is_automatic(std::string_view tracker);

struct TrackerChoice {
  std::string tracker;
  std::string reason;  ///< One line for users.
};

/// The tracker that a name stands for in a medium: of `auto` by whether its extinction differs
/// between channels, by the share of tentative collisions that a control of super-voxel minima
/// would decide without a look-up, and by the number of components that a look-up reads; of any
/// other itself, without a reason.
TrackerChoice settle_tracker(std::string tracker, const Medium& medium);
/// Settles the tracker for given cross sections of the medium's components.
TrackerChoice settle_tracker(std::string tracker, const Medium& medium,
                             const MediumChannels& channels);

/// The tracker that a name stands for in pictures of a medium, where each channel may have a path
/// of its own: of `auto` such paths where the extinctions of channels differ much and paths scatter
/// often, since the weights of a common path spread with each scattering; else as settle_tracker().
TrackerChoice settle_picture_tracker(std::string tracker, const Medium& medium);

}  // namespace freepath
