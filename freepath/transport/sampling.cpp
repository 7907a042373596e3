#include "freepath/transport/sampling.h"

#include "freepath/transport/auto_tracker.h"

namespace freepath {
namespace {

using WalkMember = void (Walker::*)(const RayStream&, FlightStream&, WalkStatistics&) const;

FlightStream walk_once(WalkMember walk, const Medium& medium, const RayStream& rays,
                       WalkSettings settings, int channel, WalkStatistics* statistics) {
  if (settings.tracker == kAutoTracker) settings.tracker = choose_tracker(medium).tracker;
  FlightStream flights;
  WalkStatistics counts;
  (Walker(medium, settings, channel).*walk)(rays, flights, counts);
  if (statistics != nullptr) statistics->merge(counts);
  return flights;
}

}  // namespace

FlightStream sample_free_paths(const Medium& medium, const RayStream& rays,
                               const WalkSettings& settings, int channel,
                               WalkStatistics* statistics) {
  return walk_once(&Walker::free_paths, medium, rays, settings, channel, statistics);
}

FlightStream estimate_transmittance(const Medium& medium, const RayStream& rays,
                                    const WalkSettings& settings, int channel,
                                    WalkStatistics* statistics) {
  return walk_once(&Walker::transmittance, medium, rays, settings, channel, statistics);
}

}  // namespace freepath
