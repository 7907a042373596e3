#pragma once
/// @file What scatters at the end of a ray.

#include <cstdint>
#include <span>

#include "freepath/media/medium_view.h"
#include "freepath/tracking/streams.h"
#include "freepath/tracking/walk_modes.h"

namespace freepath {

/// Walker::scattering_at_ends() in one part of a medium, as a WalkFunction.
void scattering_at_ends_of(const MediumView& view, std::span<const float> options,
                           const WalkModes& modes, uint64_t seed, const RayStream& rays,
                           FlightStream& flights, WalkStatistics& statistics);

}  // namespace freepath
