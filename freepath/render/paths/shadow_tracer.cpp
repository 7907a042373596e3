#include "freepath/render/paths/shadow_tracer.h"

#include <algorithm>

#include "freepath/base/random.h"

namespace freepath {
namespace {

/// Segments of one shadow ray draw from streams far apart; no path has so many flights.
constexpr int kSegmentShift = 26;
constexpr uint32_t kMostSegments = 31;  // of different streams

}  // namespace

void ShadowTracer::add_segment(uint32_t number, const Shadow& shadow, const ScenePath& path,
                               MediumId medium, float begin, float end, uint32_t segment) {
  if (medium == kVacuum || !(begin < end)) return;
  const auto& walkers = path.colors->media[medium]->walkers;
  const Walker& walker = walkers[path.channel < 0 ? 0 : path.channel];
  auto [batch, slot] = batches_.add(walker, number);
  set_ray(batch.rays, slot, shadow.origin + shadow.direction * begin, shadow.direction,
          end - begin);
  batch.rays.pixel[slot] = path.pixel;
  batch.rays.sample[slot] = path.sample_key;
  batch.rays.stream[slot] = stream_number(StreamPurpose::kShadowWalk, path.flights) +
                            (std::min(segment, kMostSegments) << kSegmentShift);
}

void ShadowTracer::trace_surfaces(uint32_t number, Shadow& shadow, const ScenePath& path) {
  if (!scene_.surfaces) {
    add_segment(number, shadow, path, shadow.medium, 0, shadow.distance, 0);
    return;
  }
  uint32_t segment = 0;
  float begin = 0;
  MediumId medium = shadow.medium;
  Vec3f origin = shadow.origin;
  float passed = 0;  // where `origin` is
  BoundaryCrossings crossings;
  while (true) {
    crossings.clear();
    if (scene_.surfaces->occluded(origin, shadow.direction, shadow.distance - passed, crossings)) {
      shadow.radiance = Channels();
      return;
    }
    for (const BoundaryCrossing& crossing : crossings.all()) {
      add_segment(number, shadow, path, medium, begin, passed + crossing.t, segment++);
      begin = passed + crossing.t;
      medium = medium_beyond(scene_.shapes[crossing.shape], crossing.enters, medium);
    }
    if (!crossings.overflowed()) break;
    // A little beyond the last one, so that it is not crossed again.
    passed = begin + std::max(1e-5F * begin, 1e-6F);
    origin = shadow.origin + shadow.direction * passed;
  }
  add_segment(number, shadow, path, medium, begin, shadow.distance, segment);
}

void ShadowTracer::trace(std::vector<ScenePath>& paths, WalkStatistics& statistics) {
  if (shadows_.empty()) return;
  batches_.clear();
  for (uint32_t i = 0; i < shadows_.size(); ++i) {
    trace_surfaces(i, shadows_[i], paths[shadows_[i].owner]);
  }
  for (WalkBatches::Batch* const batch : batches_.finish()) {
    batch->walker->transmittance(batch->rays, flights_, statistics);
    const int channels = batch->walker->transmittance_channels();
    for (std::size_t i = 0; i < batch->owners.size(); ++i) {
      Shadow& shadow = shadows_[batch->owners[i]];
      if (channels == 1) {
        shadow.radiance *= flights_.weight[0][i];
      } else {
        for (int c = 0; c < channels; ++c) shadow.radiance[c] *= flights_.weight[c][i];
      }
      paths[shadow.owner].lookups += flights_.lookups[i];
    }
  }
  for (const Shadow& shadow : shadows_) {
    ScenePath& path = paths[shadow.owner];
    (shadow.is_rgb ? path.rgb : path.radiance) += shadow.radiance;
  }
  shadows_.clear();
}

}  // namespace freepath
