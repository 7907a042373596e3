// The flights of a PathWavefront: rays sent, walked, and what they came to.

#include <cmath>
#include <limits>

#include "freepath/paths/path_wavefront.h"

namespace freepath {

bool PathWavefront::needs_surfaces_first(const ScenePath& path) const {
  if (!scene_.surfaces || path.surfaces_known) return false;
  return !scene_.is_clear_at(path.medium, path.origin);
}

void PathWavefront::find_surface(ScenePath& path) {
  path.surfaces_known = true;
  if (!scene_.surfaces) return;
  const auto hit = scene_.surfaces->intersect(path.origin, path.direction, 0, path.side);
  path.ends_at_surface = hit.has_value();
  if (hit) hit_of(path) = *hit;
}

void PathWavefront::send(std::size_t slot) {
  ScenePath& path = paths_[slot];
  path.is_sent = true;
  set_side(path, path.origin, path.direction);
  if (needs_surfaces_first(path)) find_surface(path);
  if (path.medium == kVacuum) {
    sent_in_vacuum_.push_back(static_cast<uint32_t>(slot));
    return;
  }
  const Walker& walker = path.colors->walker(path.medium, path.channel);
  const float end = path.ends_at_surface ? hit_of(path).t : path.side;
  write_ray(slot, walker, path.origin, path.direction, end);
  if (near_lines_ && !path.is_branch) send_near_line(slot, end);
}

void PathWavefront::write_ray(std::size_t slot, const Walker& walker, const Vec3f& origin,
                              const Vec3f& direction, float end) {
  const ScenePath& path = paths_[slot];
  auto [batch, i] = sent_.add(walker, static_cast<uint32_t>(slot));
  RayStream& rays = batch.rays;
  set_ray(rays, i, origin, direction, end);
  rays.pixel[i] = path.pixel;
  rays.sample[i] = path.sample_key;
  rays.stream[i] = stream_number(StreamPurpose::kWalk, path.flights);
  if (!rays.weighted()) return;
  for (int c = 0; c < walker.channels(); ++c) {
    rays.weight[c][i] = path.throughput[c];
    rays.density[c][i] = path.density[c];
  }
}

void PathWavefront::fly() {
  std::swap(flying_, sent_);
  std::swap(in_vacuum_, sent_in_vacuum_);
  sent_.clear();
  sent_in_vacuum_.clear();
  for (const uint32_t slot : in_vacuum_) {
    paths_[slot].is_sent = false;
    end_flight(slot);
  }
  for (WalkBatches::Batch* const batch : flying_.finish()) {
    batch->walker->free_paths(batch->rays, flights_, counts_.free_paths);
    scatterer_ = {};
    for (std::size_t i = 0; i < batch->count; ++i) {
      // What is ahead lies in no near cache after the walk.
      constexpr std::size_t kAhead = 6;
      const ScenePath* const ahead = &paths_[batch->owners[std::min(i + kAhead, batch->count - 1)]];
      __builtin_prefetch(ahead);
      __builtin_prefetch(&ahead->throughput);
      take_flight(*batch, i);
    }
    scatter_in_media(*batch);
  }
  escapes_.finish();
}

void PathWavefront::set_side(ScenePath& path, const Vec3f& origin, const Vec3f& direction) const {
  if (!has_sides_) return;
  path.side = scene_.domain ? scene_.domain->way_to_side(origin, direction)
                            : meter_->way_to_plane(origin, direction, path.level);
}

void PathWavefront::pass_side(ScenePath& path) {
  if (path.scatterings == 0) path.distance += path.side;
  RandomStream random(setup_.seed, path.pixel, path.sample_key,
                      stream_number(StreamPurpose::kScatter, path.flights));
  go_on(path, scene_.domain->beyond_side(path.origin, path.direction, path.side), path.direction);
  if (++path.sides % PeriodicDomain::kSidesPerRoulette != 0) return;
  if (random.uniform() < PeriodicDomain::kSurvival) {
    path.throughput *= 1 / PeriodicDomain::kSurvival;
  } else {
    path.is_dead = true;
  }
}

void PathWavefront::end_flight(std::size_t slot) {
  ScenePath& path = paths_[slot];
  if (!path.surfaces_known) find_surface(path);
  if (path.ends_at_surface) {
    meet_surface(slot);
  } else if (path.side == std::numeric_limits<float>::infinity()) {
    meter_ == nullptr ? leave_scene(slot) : leave_meter(path);
  } else if (scene_.domain) {
    pass_side(path);
  } else {
    pass_plane(slot);
  }
}

void PathWavefront::take_ray(ScenePath& path, const RayStream& rays, std::size_t i) {
  if (!std::exchange(path.is_in_rays, false)) return;
  path.origin = path.turned_at = {rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]};
  path.direction = {rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]};
}

void PathWavefront::take_flight(const WalkBatches::Batch& batch, std::size_t i) {
  const uint32_t slot = batch.owners[i];
  ScenePath& path = paths_[slot];
  path.is_sent = false;
  path.lookups += flights_.lookups[i];
  if (batch.rays.weighted()) {
    const int channels = batch.walker->channels();
    path.may_differ = true;
    for (int c = 0; c < channels; ++c) {
      if (!path.is_branch) path.radiance[c] += flights_.emitted[c][i] * path.emission_share;
      path.throughput[c] = flights_.weight[c][i];
      path.density[c] = flights_.density[c][i];
    }
  } else if (meter_ != nullptr) {
    path.throughput[0] *= flights_.weight[0][i];
  } else {
    // A walker of one channel serves all, or the only one that there is.
    if (const float emitted = flights_.emitted[0][i]; emitted != 0 && !path.is_branch) {
      path.radiance += path.throughput * (emitted * path.emission_share);
    }
    path.throughput *= flights_.weight[0][i];
  }
  const float largest = magnitude(path);
  if (!(largest < kLargestThroughput)) {
    path.radiance = SampledSpectrum(std::numeric_limits<float>::quiet_NaN());  // finish() counts it
    path.is_dead = true;
    return;
  }
  if (flights_.event[i] == Event::kScatter) {
    collide(slot, batch, i, largest);
    return;
  }
  take_ray(path, batch.rays, i);
  if (flights_.event[i] == Event::kEscape) {
    end_flight(slot);
    return;
  }
  path.is_dead = true;
  if (meter_ != nullptr) {
    const Vec3f position = path.origin + path.direction * flights_.t[i];
    deposit(path, meter_->cell(Flux::kAbsorbed, meter_->column(position)), path.throughput[0]);
  } else if (path.scatterings == 0) {
    record_medium_event(path, flights_.t[i], scatterer_of(path, flights_.component[i]));
  }
}

void PathWavefront::leave_scene(std::size_t slot) {
  ScenePath& path = paths_[slot];
  if (!escapes_.has_image()) {
    escape(path);
    return;
  }
  path.is_dead = true;
  __builtin_prefetch(&result_of(path), 1);  // finish() writes it
  escapes_.add(static_cast<uint32_t>(slot), path.direction);
}

void PathWavefront::see_outside() {
  escapes_.look_up(
      [&](uint32_t slot, const LightValue& in_image) { escape(paths_[slot], &in_image); });
}

void PathWavefront::escape(ScenePath& path, const LightValue* in_image) {
  constexpr float kFromOutside = std::numeric_limits<float>::infinity();
  path.is_dead = true;
  if (path.scatterings == 0) {
    result_of(path).alpha = 1 - path.mean(path.throughput);
    if (jobs_.layers.on()) jobs_.layers.transmittance(path.result, transmittance_of(path));
  }
  const bool in_rgb = sees_rgb(path);
  const LightSeen light =
      scene_.lights->escape(path.turned_at, path.direction, light_spectra(path, in_rgb), in_image);
  // What next-event estimation could have found too is shared with it.
  const bool is_shared = path.pdf > 0 && path.glass == nullptr;
  const float share = is_shared ? path.pdf / (path.pdf + light.pdf) : 1.0F;
  const float brought = share_of_light(path, path.direction, kFromOutside);
  const SampledSpectrum seen =
      light_throughput(path, in_rgb) * (light.radiance * share + light.undrawn) * brought;
  if (jobs_.layers.on() && path.scatterings == 0) {
    jobs_.layers.background(path.result, rgb_of(path, in_rgb ? SampledSpectrum() : seen,
                                                in_rgb ? seen : SampledSpectrum()));
  }
  if (setup_.transparent && path.scatterings == 0) return;
  (in_rgb ? path.rgb : path.radiance) += seen;
}

}  // namespace freepath
