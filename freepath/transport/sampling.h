#pragma once
/// @file The library in two functions, for programs that embed it. Those that walk again and again
/// keep a Walker and their streams instead.

#include "freepath/transport/walker.h"

namespace freepath {

/// Flies every ray to its next scattering, absorption or escape.
/// @param rays in the world; RayStream::t_max may be infinite
/// @param settings methods by name, as `freepath trackers` lists them; "auto" chooses a tracker
/// @param channel the one channel to carry, or Walker::kAllChannels where shares_paths() holds
/// @param statistics what was counted is added, unless null
/// @throws Error as Walker's constructor
FlightStream sample_free_paths(const Medium& medium, const RayStream& rays,
                               const WalkSettings& settings = {},
                               int channel = Walker::kAllChannels,
                               WalkStatistics* statistics = nullptr);
/// Samples free paths in any 1 to kMaxChannels channels, which one path carries.
/// @param channels cross sections of each component of the medium
FlightStream sample_free_paths(const Medium& medium, const MediumChannels& channels,
                               const RayStream& rays, const WalkSettings& settings = {},
                               WalkStatistics* statistics = nullptr);

/// Estimates the transmittance from each ray's origin to its t_max: the weights of the flights.
/// Arguments and errors as above.
FlightStream estimate_transmittance(const Medium& medium, const RayStream& rays,
                                    const WalkSettings& settings = {},
                                    int channel = Walker::kAllChannels,
                                    WalkStatistics* statistics = nullptr);
FlightStream estimate_transmittance(const Medium& medium, const MediumChannels& channels,
                                    const RayStream& rays, const WalkSettings& settings = {},
                                    WalkStatistics* statistics = nullptr);

}  // namespace freepath
