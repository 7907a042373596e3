#include "freepath/transport/sampling.h"

#include "freepath/transport/auto_tracker.h"

namespace freepath {
namespace {

Walker make_walker(const Medium& medium, WalkSettings settings, int channel) {
  if (settings.tracker == kAutoTracker) settings.tracker = choose_tracker(medium).tracker;
  return Walker(medium, settings, channel);
}

}  // namespace

FlightStream sample_free_paths(const Medium& medium, const RayStream& rays,
                               const WalkSettings& settings, int channel,
                               WalkStatistics* statistics) {
  FlightStream flights;
  WalkStatistics counts;
  make_walker(medium, settings, channel).free_paths(rays, flights, counts);
  if (statistics != nullptr) statistics->merge(counts);
  return flights;
}

FlightStream estimate_transmittance(const Medium& medium, const RayStream& rays,
                                    const WalkSettings& settings, int channel,
                                    WalkStatistics* statistics) {
  FlightStream flights;
  WalkStatistics counts;
  make_walker(medium, settings, channel).transmittance(rays, flights, counts);
  if (statistics != nullptr) statistics->merge(counts);
  return flights;
}

}  // namespace freepath
