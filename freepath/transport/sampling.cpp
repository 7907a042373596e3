#include "freepath/transport/sampling.h"

#include "freepath/transport/auto_tracker.h"

namespace freepath {
namespace {

using WalkMember = void (Walker::*)(const RayStream&, FlightStream&, WalkStatistics&) const;

FlightStream walk_once(WalkMember walk, const Walker& walker, const RayStream& rays,
                       WalkStatistics* statistics) {
  FlightStream flights;
  WalkStatistics counts;
  (walker.*walk)(rays, flights, counts);
  if (statistics != nullptr) statistics->merge(counts);
  return flights;
}

Walker make_walker(const Medium& medium, WalkSettings settings, int channel) {
  settings.tracker = settle_tracker(settings.tracker, medium).tracker;
  return {medium, settings, channel};
}

Walker make_walker(const Medium& medium, const MediumChannels& channels, WalkSettings settings) {
  settings.tracker = settle_tracker(settings.tracker, medium, channels).tracker;
  return {medium, channels, settings};
}

}  // namespace

FlightStream sample_free_paths(const Medium& medium, const RayStream& rays,
                               const WalkSettings& settings, int channel,
                               WalkStatistics* statistics) {
  return walk_once(&Walker::free_paths, make_walker(medium, settings, channel), rays, statistics);
}

FlightStream sample_free_paths(const Medium& medium, const MediumChannels& channels,
                               const RayStream& rays, const WalkSettings& settings,
                               WalkStatistics* statistics) {
  return walk_once(&Walker::free_paths, make_walker(medium, channels, settings), rays, statistics);
}

FlightStream estimate_transmittance(const Medium& medium, const RayStream& rays,
                                    const WalkSettings& settings, int channel,
                                    WalkStatistics* statistics) {
  return walk_once(&Walker::transmittance, make_walker(medium, settings, channel), rays,
                   statistics);
}

FlightStream estimate_transmittance(const Medium& medium, const MediumChannels& channels,
                                    const RayStream& rays, const WalkSettings& settings,
                                    WalkStatistics* statistics) {
  return walk_once(&Walker::transmittance, make_walker(medium, channels, settings), rays,
                   statistics);
}

}  // namespace freepath
