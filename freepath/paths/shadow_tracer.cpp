#include "freepath/paths/shadow_tracer.h"

#include <algorithm>
#include <optional>

#include "freepath/base/random.h"
#include "freepath/paths/alpha_chance.h"

namespace freepath {
namespace {

/// Segments of one shadow ray draw from streams far apart; no path has so many flights.
constexpr int kSegmentShift = 26;
constexpr uint32_t kOrderedSegments = 31;
/// Those beyond draw from streams by hash, above all others.
constexpr uint32_t kHashedStreams = 0xE0000000U;

}  // namespace

uint32_t ShadowTracer::stream_of(uint32_t flight, uint32_t segment) const {
  const uint32_t stream = stream_number(StreamPurpose::kShadowWalk, flight);
  if (segment < kOrderedSegments && !is_second_) return stream + (segment << kSegmentShift);
  return kHashedStreams | philox({stream, segment, is_second_ ? 1U : 0U, 0}, {0, 0})[0] >> 3;
}

ShadowTracer::ShadowTracer(const PathScene& scene, MediaSetTable& media_sets, uint64_t seed,
                           std::size_t slots, bool is_second)
    : scene_(scene),
      media_sets_(media_sets),
      seed_(seed),
      is_second_(is_second),
      has_holes_(std::any_of(scene.materials.begin(), scene.materials.end(),
                             [](const Material& material) { return material.has_holes(); }) ||
                 std::any_of(scene.shapes.begin(), scene.shapes.end(),
                             [](const PathShape& shape) { return shape.alpha.has_value(); })),
      is_open_(!scene.surfaces && !scene.domain),
      batches_(slots, false) {}

void ShadowTracer::add_open(const ScenePath& path, MediumId medium, const Vec3f& origin,
                            const Vec3f& direction, float end) {
  const Walker& walker = path.colors->walker(medium, path.channel);
  auto [batch, slot] = batches_.add(walker, static_cast<uint32_t>(arrivals_.size() - 1));
  set_ray(batch.rays, slot, origin, direction, end);
  batch.rays.pixel[slot] = path.pixel;
  batch.rays.sample[slot] = path.sample_key;
  batch.rays.stream[slot] = stream_of(path.flights, 0);
}

void ShadowTracer::add_segment(Shadow& shadow, const ScenePath& path, MediaSetId media, float begin,
                               float end) {
  if (!(begin < end)) return;
  const MediumId medium = media_sets_.medium(media);
  if (medium == kVacuum) return;
  const Walker& walker = path.colors->walker(medium, path.channel);
  auto [batch, slot] = batches_.add(walker, static_cast<uint32_t>(segments_.size()));
  segments_.push_back({static_cast<uint32_t>(&shadow - shadows_.data())});
  set_ray(batch.rays, slot, shadow.origin + shadow.direction * begin, shadow.direction,
          end - begin);
  batch.rays.pixel[slot] = path.pixel;
  batch.rays.sample[slot] = path.sample_key;
  batch.rays.stream[slot] = stream_of(path.flights, shadow.segments++);
}

bool ShadowTracer::passes(const Shadow& shadow, Arrival& arrival, const ScenePath& path,
                          const SurfaceHit& hit, MediaSetId& media) {
  const float alpha = scene_.alpha_at(hit.point);
  if (alpha == 0) return true;
  const PathShape& shape = scene_.shapes[hit.point.shape];
  const SurfaceContext context{path.colors->spectra, scene_.textures, path.hero, path.only_hero};
  if (shape.material &&
      !scene_.materials[*shape.material].is_hole(hit.point, shadow.direction, context)) {
    arrival.radiance *= 1 - alpha;
    return alpha < 1;
  }
  // Media on both sides of it have no mean.
  const AlphaChance chance{seed_, path.pixel, path.sample_key,
                           stream_number(StreamPurpose::kShadowWalk, path.flights)};
  if (chance.meets(hit.position.key, alpha)) {
    media = media_sets_.cross(media, hit.point.shape, !hit.from_inside);
  }
  return true;
}

void ShadowTracer::trace_porous_surfaces(Shadow& shadow, Arrival& arrival, const ScenePath& path) {
  const Surfaces& surfaces = *scene_.surfaces;
  float begin = 0;
  MediaSetId media = shadow.media;
  Vec3f origin = shadow.origin;
  const auto is_end = [&](const RayPosition& met) {
    return surfaces.is_end(origin, shadow.direction, met,
                           {shadow.end.distance - begin, shadow.end.target});
  };
  while (begin < shadow.end.distance) {
    const auto hit = surfaces.intersect(origin, shadow.direction, 0, shadow.end.distance - begin);
    if (!hit) break;
    ties_.clear();
    if (hit->is_tied) surfaces.find_ties(origin, shadow.direction, *hit, ties_);
    bool ends = is_end(hit->position);
    const Vec3f beyond = surfaces.offset_ray_origin(hit->point, shadow.direction);
    const float end = begin + hit->t;
    add_segment(shadow, path, media, begin, end);
    bool is_free = ends || passes(shadow, arrival, path, *hit, media);
    for (const TiedSurface& tied : ties_) {
      // What a ray from beyond meets may wait.
      if (!surfaces.is_beyond(tied.position, beyond, shadow.direction)) continue;
      const SurfaceHit there = surfaces.describe(origin, shadow.direction, tied);
      ends = ends || is_end(there.position);
      is_free = is_free && (ends || passes(shadow, arrival, path, there, media));
    }
    if (ends) {
      shadow.media = media;
      return;
    }
    if (!is_free) {
      arrival.radiance = SampledSpectrum();
      return;
    }
    begin = end;
    origin = beyond;
  }
  add_segment(shadow, path, media, begin, shadow.end.distance);
  shadow.media = media;
}

void ShadowTracer::trace_surfaces(Shadow& shadow, Arrival& arrival, const ScenePath& path) {
  if (scene_.domain) {
    trace_domain(shadow, arrival, path);
  } else {
    trace_part(shadow, arrival, path);
  }
  if (shadow.bend == 0 || is_black(arrival.radiance)) return;
  const Bend& bend = bends_[shadow.bend - 1];
  shadow.origin = bend.origin;
  shadow.direction = bend.direction;
  shadow.end = bend.end;
  shadow.media = media_sets_.cross(shadow.media, bend.shape, /*enters=*/false);
  trace_part(shadow, arrival, path);
}

void ShadowTracer::trace_domain(Shadow& shadow, Arrival& arrival, const ScenePath& path) {
  const ShadowEnd end = shadow.end;
  float left = end.distance;
  for (uint32_t sides = 0;;) {
    const float side = scene_.domain->way_to_side(shadow.origin, shadow.direction);
    const bool is_last = !(side < left);
    shadow.end = is_last ? ShadowEnd{left, end.target} : ShadowEnd{side};
    trace_part(shadow, arrival, path);
    if (is_last || is_black(arrival.radiance)) return;
    left -= side;
    shadow.origin = scene_.domain->beyond_side(shadow.origin, shadow.direction, side);
    if (++sides % PeriodicDomain::kSidesPerRoulette != 0) continue;
    RandomStream random(seed_, path.pixel, path.sample_key,
                        stream_of(path.flights, shadow.segments++));
    const bool survives = random.uniform() < PeriodicDomain::kSurvival;
    arrival.radiance *= survives ? 1 / PeriodicDomain::kSurvival : 0.0F;
    if (!survives) return;
  }
}

void ShadowTracer::trace_part(Shadow& shadow, Arrival& arrival, const ScenePath& path) {
  if (has_holes_ && scene_.surfaces) {
    trace_porous_surfaces(shadow, arrival, path);
    return;
  }
  if (!scene_.surfaces) {
    add_segment(shadow, path, shadow.media, 0, shadow.end.distance);
    return;
  }
  float begin = 0;
  MediaSetId media = shadow.media;
  std::optional<RayPosition> last;  // which crossing came before
  while (true) {
    if (scene_.surfaces->occluded(shadow.origin, shadow.direction, shadow.end, crossings_,
                                  last ? &*last : nullptr)) {
      arrival.radiance = SampledSpectrum();
      return;
    }
    for (const BoundaryCrossing& crossing : crossings_.all()) {
      // Those at one place are crossed as one: nothing lies between them.
      if (!last || !crossing.position.is_tied(*last)) {
        const auto end = static_cast<float>(crossing.position.t);
        add_segment(shadow, path, media, begin, end);
        begin = end;
      }
      last = crossing.position;
      media = media_sets_.cross(media, crossing.shape, crossing.enters);
    }
    if (!crossings_.overflowed()) break;
  }
  add_segment(shadow, path, media, begin, shadow.end.distance);
  shadow.media = media;
}

void ShadowTracer::trace(std::span<ScenePath> paths, WalkStatistics& statistics,
                         const Deposit& deposit) {
  if (arrivals_.empty()) return;
  if (scene_.surfaces) {
    for (std::size_t i = 0; i < shadows_.size(); ++i) {
      trace_surfaces(shadows_[i], arrivals_[i], paths[arrivals_[i].owner]);
    }
  }
  for (WalkBatches::Batch* const batch : batches_.finish()) {
    batch->walker->transmittance(batch->rays, flights_, statistics);
    const int channels = batch->walker->transmittance_channels();
    for (std::size_t i = 0; i < batch->count; ++i) {
      const uint32_t owner = batch->owners[i];
      SampledSpectrum transmittance(flights_.weight[0][i]);
      for (int c = 1; c < channels; ++c) transmittance[c] = flights_.weight[c][i];
      if (is_open_) {
        arrivals_[owner].radiance *= transmittance;
        arrivals_[owner].lookups = flights_.lookups[i];
      } else {
        segments_[owner].transmittance = transmittance;
        segments_[owner].lookups = flights_.lookups[i];
      }
    }
  }
  // In the order of the rays' ways, whatever batches there were.
  for (const Segment& segment : segments_) {
    arrivals_[segment.arrival].radiance *= segment.transmittance;
    arrivals_[segment.arrival].lookups += segment.lookups;
  }
  for (const Arrival& arrival : arrivals_) {
    ScenePath& path = paths[arrival.owner];
    path.lookups += arrival.lookups;
    if (arrival.cell != kNoCell) {
      deposit(path, arrival.cell, arrival.radiance);
      continue;
    }
    (arrival.is_rgb ? path.rgb : path.radiance) += arrival.radiance;
  }
  arrivals_.clear();
  shadows_.clear();
  bends_.clear();
  batches_.clear();
  segments_.clear();
}

}  // namespace freepath
