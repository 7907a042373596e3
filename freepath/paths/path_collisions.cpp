// Collisions of the paths of a PathWavefront in media.

#include "freepath/paths/path_wavefront.h"

namespace freepath {

void PathWavefront::collide(std::size_t slot, float t, std::size_t component) {
  ScenePath& path = paths_[slot];
  const MediumWalkers::Origin scatterer = scatterer_of(path, component);
  if (jobs_.layers.on()) {
    jobs_.layers.scattering(path.result, path.scatterings, rgb_of(path, path.radiance, path.rgb));
  }
  const Vec3f position = path.origin + path.direction * t;
  if (meter_ != nullptr) absorb_part(path, position, component);
  if (path.scatterings++ == 0 && meter_ == nullptr) record_medium_event(path, t, scatterer);
  if (is_cut(path)) {
    count_cut(path, Channels(1));
    path.is_dead = true;
    return;
  }
  const PhaseFunction& phase = scene_.media[scatterer.medium].phase(scatterer.component);
  const std::size_t i = scatterings_.count++;
  Scattering& scattering = scattered_[i];
  scattering.slot = slot;
  scattering.position = position;
  scattering.phase = &phase;
  scatterings_.pixel[i] = path.pixel;
  scatterings_.sample[i] = path.sample_key;
  scatterings_.stream[i] = stream_number(StreamPurpose::kScatter, path.flights);
  for (int axis = 0; axis < 3; ++axis) scatterings_.direction[axis][i] = path.direction[axis];
  const HenyeyGreenstein* const function = phase.as_henyey_greenstein();
  scatterings_.g[i] = function != nullptr ? function->g() : 0;
  if (scatterings_.count == ScatteringStream::kCapacity) scatter_in_media();
}

bool PathWavefront::survives(ScenePath& path, float u) const {
  const float throughput = largest_magnitude(path.throughput);
  if (throughput == 0) return false;
  if (throughput >= setup_.roulette_threshold) return true;
  const float survival = throughput / setup_.roulette_threshold;
  if (u >= survival) return false;
  path.throughput *= 1.0F / survival;
  return true;
}

void PathWavefront::draw_light_of(std::size_t i) {
  Scattering& scattering = scattered_[i];
  const ScenePath& path = paths_[scattering.slot];
  scattering.in_rgb = sees_rgb(path);
  std::array<float, 3> u{};
  for (uint32_t k = 0; k < 3; ++k) u[k] = scatterings_.numbers[kLightNumber + k][i];
  scattering.light = draw_light(scattering.position, light_spectra(path, scattering.in_rgb), u);
  const Vec3f& to_light = scattering.light.direction;
  for (int axis = 0; axis < 3; ++axis) scatterings_.to_light[axis][i] = to_light[axis];
}

float PathWavefront::shadow_survival(const ScenePath& path, const Vec3f& position,
                                     const LightDraw& light, const Channels& radiance,
                                     bool in_rgb) const {
  const ShadowGuide* const guide = setup_.shadow_guide;
  if (guide == nullptr || std::isfinite(light.distance)) return 1;
  float brightness = 0;
  if (in_rgb) {
    brightness = (radiance[0] + radiance[1] + radiance[2]) / 3;
  } else {
    brightness = path.mean(radiance) * path.colors->per_white;
  }
  return guide->survival(path.scatterings, path.medium, position, light.direction, brightness);
}

void PathWavefront::cast_shadow(std::size_t i) {
  const Scattering& scattering = scattered_[i];
  const LightDraw& light = scattering.light;
  if (!(light.pdf > 0)) return;
  const ScenePath& path = paths_[scattering.slot];
  // The phase function is its own density.
  const float value = scattering.phase->as_henyey_greenstein() != nullptr
                          ? scatterings_.light_value[i]
                          : scattering.phase->evaluate(path.direction, light.direction);
  const float share = light.delta ? value / light.pdf : value / (light.pdf + value);
  Channels radiance = light_throughput(path, scattering.in_rgb) * light.radiance * share;
  if (is_black(radiance)) return;
  const float survival =
      shadow_survival(path, scattering.position, light, radiance, scattering.in_rgb);
  if (survival < 1) {
    if (scatterings_.numbers[kShadowNumber][i] >= survival) return;
    radiance *= 1 / survival;
  }
  shadows_.add(static_cast<uint32_t>(scattering.slot), path, scattering.position, light.direction,
               shadow_end(light), path.place, radiance, scattering.in_rgb);
}

void PathWavefront::scatter_in_media() {
  if (scatterings_.count == 0) return;
  kernels_.draw_numbers(scatterings_, setup_.seed);
  const bool draws_lights = meter_ == nullptr && scene_.lights->is_drawn();
  for (std::size_t i = 0; i < scatterings_.count; ++i) {
    ScenePath& path = paths_[scattered_[i].slot];
    path.is_dead = !survives(path, scatterings_.numbers[kRouletteNumber][i]);
    if (draws_lights && !path.is_dead) draw_light_of(i);
  }
  kernels_.scatter(scatterings_);
  for (std::size_t i = 0; i < scatterings_.count; ++i) {
    const auto& [slot, position, phase, in_rgb, light] = scattered_[i];
    ScenePath& path = paths_[slot];
    if (path.is_dead) continue;
    if (meter_ != nullptr) show_collision(slot, position, *phase);
    if (draws_lights) cast_shadow(i);
    const EmissionGuide* const guide = guide_of(path.medium);
    if (guide != nullptr) {
      RandomStream random(setup_.seed, path.pixel, path.sample_key, scatterings_.stream[i],
                          kScatteringBlocks);
      draw_emission(slot, *guide, position, *phase, random);
    }
    PhaseSample next;
    if (phase->as_henyey_greenstein() != nullptr) {
      next.direction = {scatterings_.next[0][i], scatterings_.next[1][i], scatterings_.next[2][i]};
      next.pdf = scatterings_.next_pdf[i];
    } else {
      next = phase->sample(path.direction, scatterings_.numbers[kPhaseNumber][i],
                           scatterings_.numbers[kPhaseNumber + 1][i]);
    }
    if (meter_ != nullptr) meter_->tilt(next.direction);
    path.pdf = next.pdf;
    turn(path, position, position, next.direction);
    if (guide != nullptr) {
      path.emission_share = next.pdf / (next.pdf + guide->pdf(position, next.direction));
    }
  }
  scatterings_.count = 0;
}

void PathWavefront::draw_emission(std::size_t slot, const EmissionGuide& guide,
                                  const Vec3f& position, const PhaseFunction& phase,
                                  RandomStream& random) {
  const ScenePath& path = paths_[slot];
  const auto drawn = guide.sample(position, random);
  if (!drawn || !(drawn->pdf > 0)) return;
  // The phase function is its own density; the balance heuristic leaves this of f / pdf.
  const float value = phase.evaluate(path.direction, drawn->direction);
  emissions_.add(static_cast<uint32_t>(slot), path, position, drawn->direction,
                 path.throughput * (value / (value + drawn->pdf)));
}

}  // namespace freepath
