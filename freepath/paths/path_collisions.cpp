// Collisions of the paths of a PathWavefront in media.

#include "freepath/paths/path_wavefront.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace freepath {
namespace {

Vec3f vector_at(const std::array<ScatteringStream::Row<float>, 3>& rows, std::size_t i) {
  return {rows[0][i], rows[1][i], rows[2][i]};
}

/// Brightness of a light whose shadow rays don't play.
constexpr float kNeverFaint = 1e30F;
/// Weight of each of R, G, B in their mean.
constexpr float kPerColor = 1.0F / 3;
/// Where all are cast.
constexpr ShadowRoulette kAllShadowRays;

}  // namespace

inline SampledSpectrum PathWavefront::from_only_light(const ScenePath& path,
                                                      const Scattering& scattering) {
  if (scattering.in_rgb) return only_in_rgb_ * (path.throughput[0] * scattering.brought);
  if (path.colors != only_colors_) {
    only_colors_ = path.colors;
    only_in_colors_ = scene_.lights->only_radiance(path.colors->spectra);
  }
  return path.throughput * only_in_colors_ * scattering.brought;
}

inline void PathWavefront::take_only_light(std::size_t i, const ScenePath& path) {
  Scattering& scattering = scattered_[i];
  scattering.in_rgb = sees_rgb(path);
  scattering.brought = share_of_light(path, only_light_->towards, only_light_->distance);
  // Most paths have no colour, and most shadow rays are not cast: what they bring can wait.
  float& brightness_there = scatterings_.brightness[i];
  if (!plays(path, only_light_->distance)) {
    brightness_there = kNeverFaint;
  } else if (scattering.in_rgb) {
    brightness_there = path.throughput[0] * scattering.brought * only_brightness_;
  } else {
    brightness_there =
        brightness(path, from_only_light(path, scattering), false, only_light_->distance);
  }
}

void PathWavefront::collide(std::size_t slot, const WalkBatches::Batch& batch, std::size_t i,
                            float magnitude) {
  ScenePath& path = paths_[slot];
  const std::size_t component = flights_.component[i];
  if (jobs_.layers.on()) {
    jobs_.layers.scattering(path.result, path.scatterings, rgb_of(path, path.radiance, path.rgb));
  }
  if (meter_ != nullptr && !meter_->absorbed_of_scattered.empty()) {
    absorb_part(path, position_of(batch.rays, i), component);
  }
  if (path.scatterings++ == 0 && meter_ == nullptr) {
    record_medium_event(path, flights_.t[i], scatterer_of(path, component));
  }
  if (is_cut(path)) {
    count_cut(path, SampledSpectrum(1));
    path.is_dead = true;
    return;
  }
  if (component != scatterer_.component) set_scatterer(path, component);
  if (scatterings_.count == ScatteringStream::kCapacity) scatter_in_media(batch);
  const std::size_t n = scatterings_.count++;
  scattered_[n].slot = static_cast<uint32_t>(slot);
  scattered_[n].phase = scatterer_.phase;
  scatterings_.ray[n] = static_cast<uint32_t>(i);
  scatterings_.is_given[n] = scatterer_.is_given;
  scatterings_.g[n] = scatterer_.g;
  scatterings_.magnitude[n] = magnitude;
  scatterings_.lobe_scale[n] = magnitude * path.sun_share;
  scatterings_.lobe_roulette[n] = path.is_branch ? setup_.roulette_threshold : 0.0F;
  has_given_ = has_given_ || scatterer_.is_given != 0;
  if (only_light_) take_only_light(n, path);
}

void PathWavefront::set_scatterer(const ScenePath& path, std::size_t component) {
  const MediumWalkers::Origin origin = scatterer_of(path, component);
  const PhaseFunction& phase = scene_.media[origin.medium].phase(origin.component);
  const HenyeyGreenstein* const function = phase.as_henyey_greenstein();
  scatterer_ = {component, &phase, function != nullptr ? function->g() : phase.mean_cosine(),
                function != nullptr ? 0U : 1U};
}

Vec3f PathWavefront::position_of(const RayStream& rays, std::size_t i) const {
  const Vec3f origin{rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]};
  const Vec3f direction{rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]};
  return origin + direction * flights_.t[i];
}

bool PathWavefront::survives(ScenePath& path, float u) const {
  const float throughput = magnitude(path);
  if (throughput > 0 && throughput >= setup_.roulette_threshold) return true;
  return goes_on(path, u, throughput / setup_.roulette_threshold);
}

bool PathWavefront::goes_on(ScenePath& path, float u, float survival) {
  if (!(u < survival)) return false;
  if (survival < 1) path.throughput *= 1.0F / survival;
  return true;
}

float PathWavefront::brightness(const ScenePath& path, const SampledSpectrum& radiance, bool in_rgb,
                                float distance) const {
  if (!plays(path, distance)) return kNeverFaint;
  const float sum = sum_of(radiance);  // of those that are not in use 0
  if (in_rgb) return sum * kPerColor;
  return sum * (path.channel < 0 ? path.colors->per_white : path.colors->mean_per_white);
}

void PathWavefront::draw_light_of(std::size_t i, const ScenePath& path) {
  Scattering& scattering = scattered_[i];
  scattering.in_rgb = sees_rgb(path);
  std::array<float, 3> u{};
  for (uint32_t k = 0; k < 3; ++k) u[k] = scatterings_.numbers[kLightNumber + k][i];
  const LightSample draw =
      draw_light(vector_at(scatterings_.position, i), light_spectra(path, scattering.in_rgb), u);
  scattering.bend.reset();
  if (setup_.glass_spheres != nullptr) {
    const Vec3f position = vector_at(scatterings_.position, i);
    const GlassSphere* const glass = setup_.glass_spheres->around(position);
    const Vec3f lamp = position + draw.direction * draw.distance;
    if (glass != nullptr && !glass->sphere.holds(Vec3d(lamp))) {
      draw_light_through(i, path, *glass, draw);
      return;
    }
  }
  scattering.end = shadow_end(draw);
  const float brought = share_of_light(path, draw.direction, draw.distance);
  scattering.radiance = light_throughput(path, scattering.in_rgb) * draw.radiance * brought;
  const bool has_line =
      setup_.near_lights != nullptr && draw.within &&
      setup_.near_lights->has_line(*draw.within, path.medium, vector_at(scatterings_.position, i));
  scatterings_.light_pdf[i] = has_line || brought == 0 ? 0 : draw.pdf;
  scatterings_.light_found[i] = draw.delta ? 0.0F : 1.0F;
  scatterings_.brightness[i] =
      brightness(path, scattering.radiance, scattering.in_rgb, draw.distance);
  for (int axis = 0; axis < 3; ++axis) scatterings_.to_light[axis][i] = draw.direction[axis];
}

void PathWavefront::set_only_light() {
  if (meter_ == nullptr) only_light_ = scene_.lights->only_light();
  if (!only_light_) return;
  only_in_rgb_ = scene_.lights->only_radiance(setup_.factory->rgb());
  only_brightness_ = sum_of(only_in_rgb_) * kPerColor;
  for (int axis = 0; axis < 3; ++axis) {
    scatterings_.to_light[axis].fill(only_light_->towards[axis]);
  }
  scatterings_.light_pdf.fill(only_light_->pdf);
  scatterings_.light_found.fill(only_light_->disc == nullptr ? 0 : 1);
  for (Scattering& scattering : scattered_) scattering.end = {only_light_->distance, {}};
}

void PathWavefront::cast_shadow(std::size_t i) {
  const Scattering& scattering = scattered_[i];
  const ScenePath& path = paths_[scattering.slot];
  float counted = scatterings_.shadow_weight[i];
  // The path is as it was before its own roulette.
  const float path_survival = scatterings_.survival[i];
  if (path_survival < 1) counted *= 1.0F / path_survival;
  const SampledSpectrum radiance =
      (only_light_ ? from_only_light(path, scattering) : scattering.radiance) * counted;
  if (is_black(radiance)) {
    scatterings_.cast &= ~(ScatteringStream::Set{1} << i);
    return;
  }
  if (shadows_.is_open()) {
    shadows_.add_arrival(scattering.slot, radiance, scattering.in_rgb);
    return;
  }
  const Vec3f position = vector_at(scatterings_.position, i);
  const Vec3f to_light = vector_at(scatterings_.to_light, i);
  if (scattering.bend) {
    shadows_.add_bent(scattering.slot, position, to_light, scattering.end, *scattering.bend,
                      path.media, radiance, scattering.in_rgb);
    return;
  }
  shadows_.add(scattering.slot, path, position, to_light, scattering.end, path.media, radiance,
               scattering.in_rgb);
}

void PathWavefront::draw_direction_of(std::size_t i) {
  const PhaseSample next = scattered_[i].phase->sample(vector_at(scatterings_.direction, i),
                                                       scatterings_.numbers[kPhaseNumber][i],
                                                       scatterings_.numbers[kPhaseNumber + 1][i]);
  for (int axis = 0; axis < 3; ++axis) scatterings_.next[axis][i] = next.direction[axis];
  scatterings_.next_pdf[i] = next.pdf;
}

void PathWavefront::turn_scattered(std::size_t i, ScenePath& path) {
  path.pdf = scatterings_.next_pdf[i];
  if (setup_.glass_spheres != nullptr) {
    path.is_from_medium = true;
    path.glass = nullptr;
  }
  if (meter_ != nullptr) FluxMeter::tilt(scatterings_.next[meter_->axis()][i]);
  if (has_sides_ || scene_.surfaces) {
    const Vec3f position = vector_at(scatterings_.position, i);
    const Vec3f direction = vector_at(scatterings_.next, i);
    if (scene_.surfaces && !scene_.is_clear_at(path.medium, position)) {
      turn(path, position, position, direction);
      return;
    }
    set_side(path, position, direction);
  }
  // Most rays are needed nowhere but in the stream that is walked next.
  path.ends_at_surface = false;
  path.surfaces_known = false;
  path.emission_share = 1;
  ++path.flights;
  if (has_alpha_) path.turned_in = path.flights;
  path.is_sent = path.is_in_rays = true;
  going_on_ |= ScatteringStream::Set{1} << i;
}

void PathWavefront::send_scattered(const Walker& walker) {
  const ScatteringStream::Set some = std::exchange(going_on_, 0);
  if (some == 0) return;
  const auto count = static_cast<std::size_t>(std::popcount(some));
  auto [batch, first] = sent_.add_all(walker, count);
  RayStream& rays = batch.rays;
  constexpr uint32_t kToNextWalk =
      stream_number(StreamPurpose::kWalk, 1) - stream_number(StreamPurpose::kScatter, 0);
  kernels_.send(scatterings_, some, scatterings_.next, kToNextWalk, rays, first);
  std::size_t ray = first;
  for (ScatteringStream::Set rest = some; rest != 0; rest &= rest - 1) {
    batch.owners[ray++] = scattered_[std::countr_zero(rest)].slot;
  }
  std::fill_n(rays.t_max.begin() + first, count, std::numeric_limits<float>::infinity());
  if (!has_sides_ && !rays.weighted()) return;
  for (ray = first; ray < first + count; ++ray) {
    const ScenePath& path = paths_[batch.owners[ray]];
    rays.t_max[ray] = path.side;
    if (!rays.weighted()) continue;
    for (int c = 0; c < walker.channels(); ++c) {
      rays.weight[c][ray] = path.throughput[c];
      rays.density[c][ray] = path.density[c];
    }
  }
}

void PathWavefront::send_shadows(const Walker& walker) {
  const ScatteringStream::Set some = scatterings_.cast;
  if (some == 0) return;
  const auto count = static_cast<std::size_t>(std::popcount(some));
  auto [batch, first] = shadows_.add_rays(walker, count);
  constexpr uint32_t kToShadow =
      stream_number(StreamPurpose::kShadowWalk, 0) - stream_number(StreamPurpose::kScatter, 0);
  kernels_.send(scatterings_, some, scatterings_.to_light, kToShadow, batch.rays, first);
  for (ScatteringStream::Set rest = some; rest != 0; rest &= rest - 1) {
    batch.rays.t_max[first++] = scattered_[std::countr_zero(rest)].end.distance;
  }
}

void PathWavefront::scatter_in_media(const WalkBatches::Batch& batch) {
  if (scatterings_.count == 0) return;
  kernels_.gather(batch.rays, flights_, scatterings_);
  const bool draws_lights = meter_ == nullptr && scene_.lights->is_drawn();
  const bool chooses_light = draws_lights && !only_light_;
  const DirectionDisc* const disc = only_light_ ? only_light_->disc : nullptr;
  const bool is_viewed = meter_ != nullptr && !meter_->views.empty();
  kernels_.draw_numbers(scatterings_, setup_.seed,
                        chooses_light || disc != nullptr ? kScatteringBlocks : kBlocksWithoutLight);
  kernels_.play(scatterings_, setup_.roulette_threshold);
  if (disc != nullptr) kernels_.aim(scatterings_, *disc);
  const MediumId medium = paths_[scattered_[0].slot].medium;  // of all rays of a walk
  const ShadowRoulette& shadows =
      setup_.shadow_guide != nullptr ? setup_.shadow_guide->roulette(medium) : kAllShadowRays;
  // Branches are faint: their light is looked for before they play, or most of it would be lost.
  const bool splits = shadows.lobe_scale > 0;
  if (chooses_light || (has_given_ && draws_lights)) {
    for (std::size_t i = 0; i < scatterings_.count; ++i) {
      if (!(scatterings_.numbers[kRouletteNumber][i] < scatterings_.survival[i])) continue;
      if (chooses_light) draw_light_of(i, paths_[scattered_[i].slot]);
      if (scatterings_.is_given[i] == 0) continue;
      scatterings_.light_value[i] = scattered_[i].phase->evaluate(
          vector_at(scatterings_.direction, i), vector_at(scatterings_.to_light, i));
    }
  }
  kernels_.scatter(scatterings_, shadows);
  if (draws_lights) {
    // Apart from all else, as no branch guesses which of them cast a ray.
    for (ScatteringStream::Set rest = scatterings_.cast; rest != 0; rest &= rest - 1) {
      cast_shadow(std::countr_zero(rest));
    }
    if (shadows_.is_open()) send_shadows(*batch.walker);
  }
  const EmissionGuide* const guide = guide_of(medium);
  for (std::size_t i = 0; i < scatterings_.count; ++i) {
    ScenePath& path = paths_[scattered_[i].slot];
    path.is_dead =
        !goes_on(path, scatterings_.numbers[kRouletteNumber][i], scatterings_.survival[i]);
    if (path.is_dead) continue;
    if (is_viewed) show_collision(i);
    if (guide != nullptr && !path.is_branch) draw_emission(i, *guide);
    if (path.is_branch) {
      const float survival = scatterings_.lobe_survival[i];
      path.is_dead = !(scatterings_.numbers[kRouletteNumber][i] < survival);
      if (path.is_dead) continue;
      path.throughput *= 1 / survival;
    }
    if (scatterings_.is_given[i] != 0) draw_direction_of(i);
    if (splits) split(i, path, shadows.dominant);
    turn_scattered(i, path);
    if (near_lines_ && !path.is_branch) draw_near_line(i);
    if (guide != nullptr) {
      const float found =
          guide->pdf(vector_at(scatterings_.position, i), vector_at(scatterings_.next, i));
      path.emission_share = path.pdf / (path.pdf + found);
    }
  }
  send_scattered(*batch.walker);
  scatterings_.count = 0;
  has_given_ = false;
}

void PathWavefront::draw_emission(std::size_t i, const EmissionGuide& guide) {
  const Scattering& scattering = scattered_[i];
  const ScenePath& path = paths_[scattering.slot];
  const Vec3f position = vector_at(scatterings_.position, i);
  RandomStream random(setup_.seed, path.pixel, path.sample_key, scatterings_.stream[i],
                      kScatteringBlocks);
  const auto drawn = guide.sample(position, random);
  if (!drawn || !(drawn->pdf > 0)) return;
  // The phase function is its own density; the balance heuristic leaves this of f / pdf.
  const float value =
      scattering.phase->evaluate(vector_at(scatterings_.direction, i), drawn->direction);
  emissions_.add(scattering.slot, path, position, drawn->direction,
                 path.throughput * (value / (value + drawn->pdf)));
}

}  // namespace freepath
