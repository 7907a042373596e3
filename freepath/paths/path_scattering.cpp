// Surfaces that the paths of a PathWavefront meet.

#include "freepath/paths/path_wavefront.h"

#include <utility>

#include "freepath/paths/alpha_chance.h"

namespace freepath {

bool PathWavefront::is_grey(const ScenePath& path) {
  const SampledSpectrum& c = path.throughput;
  for (int i = 1; i < path.colors->spectra.channels(); ++i) {
    if (c[i] != c[0]) return false;
  }
  return true;
}

SampledSpectrum PathWavefront::light_throughput(const ScenePath& path, bool in_rgb) {
  return in_rgb ? SampledSpectrum(path.throughput[0]) : path.throughput;
}

const SpectrumValues& PathWavefront::light_spectra(const ScenePath& path, bool in_rgb) const {
  return in_rgb ? setup_.factory->rgb() : path.colors->spectra;
}

void PathWavefront::go_on(ScenePath& path, const Vec3f& origin, const Vec3f& direction) const {
  path.origin = origin;
  path.direction = direction;
  path.ends_at_surface = false;
  path.surfaces_known = false;
  path.is_in_rays = false;
  path.line_is_drawn = false;
  path.emission_share = 1;
  ++path.flights;
}

int PathWavefront::rank(uint32_t shape) const {
  const PathShape& sides = scene_.shapes[shape];
  if (sides.light) return 3;
  if (!sides.material) return 0;
  return scene_.materials[*sides.material].transmits() ? 1 : 2;
}

void PathWavefront::turn(ScenePath& path, const Vec3f& from, const Vec3f& origin,
                         const Vec3f& direction) const {
  path.turned_at = from;
  go_on(path, origin, direction);
  path.turned_in = path.flights;
}

std::optional<SurfaceHit> PathWavefront::first_there(const ScenePath& path) {
  const Surfaces& surfaces = *scene_.surfaces;
  const AlphaChance chance{setup_.seed, path.pixel, path.sample_key,
                           stream_number(StreamPurpose::kWalk, path.turned_in)};
  const auto is_there = [&](const SurfaceHit& hit) {
    return chance.meets(hit.position.key, scene_.alpha_at(hit.point));
  };
  const auto is_missing = [&](const TiedSurface& tied) {
    return scene_.shapes[tied.shape].alpha &&
           !is_there(surfaces.describe(path.origin, path.direction, tied));
  };
  SurfaceHit hit = hit_of(path);
  while (true) {
    ties_.clear();
    if (hit.is_tied) surfaces.find_ties(path.origin, path.direction, hit, ties_);
    std::erase_if(ties_, is_missing);
    if (is_there(hit)) return hit;
    if (ties_.empty()) return std::nullopt;
    hit = surfaces.describe(path.origin, path.direction, ties_.front());
  }
}

std::optional<SurfaceHit> PathWavefront::choose_surface(const ScenePath& path) {
  const Surfaces& surfaces = *scene_.surfaces;
  SurfaceHit hit = hit_of(path);
  if (has_alpha_) {
    const std::optional<SurfaceHit> there = first_there(path);
    if (!there) return std::nullopt;
    hit = *there;
  } else {
    ties_.clear();
    if (hit.is_tied) surfaces.find_ties(path.origin, path.direction, hit, ties_);
  }
  if (ties_.empty()) return hit;
  Vec3f beyond = surfaces.offset_ray_origin(hit.point, path.direction);
  const auto take = [&](TiedSurface& tied) {
    const TiedSurface before{hit.position, hit.point.shape, !hit.from_inside};
    hit = surfaces.describe(path.origin, path.direction, tied);
    tied = before;
  };
  // All boundaries at the place are crossed at once: nothing lies between them.
  if (rank(hit.point.shape) == 0) {
    for (TiedSurface& tied : ties_) {
      const bool waits = surfaces.is_beyond(tied.position, beyond, path.direction);
      if (rank(tied.shape) > 0 || waits) continue;
      take(tied);
      beyond = surfaces.offset_ray_origin(hit.point, path.direction);
    }
  }
  // What a ray from beyond would meet may wait.
  TiedSurface* chosen = nullptr;
  int highest = rank(hit.point.shape);
  for (TiedSurface& tied : ties_) {
    const int other = rank(tied.shape);
    if (other <= highest || !surfaces.is_beyond(tied.position, beyond, path.direction)) continue;
    highest = other;
    chosen = &tied;
  }
  if (chosen != nullptr) take(*chosen);
  return hit;
}

PathWavefront::Departure PathWavefront::depart(const ScenePath& path, const SurfaceHit& hit,
                                               const Vec3f& direction) {
  Departure departure{scene_.surfaces->offset_ray_origin(hit.point, direction), path.media};
  const auto cross = [&](uint32_t shape, bool enters) {
    departure.media = media_sets_.cross(departure.media, shape, enters);
  };
  const bool goes_through = (direction.dot(hit.point.normal) > 0) == hit.from_inside;
  if (goes_through) cross(hit.point.shape, !hit.from_inside);
  for (const TiedSurface& tied : ties_) {
    if (scene_.surfaces->is_beyond(tied.position, departure.origin, path.direction)) {
      cross(tied.shape, tied.enters);
    }
  }
  return departure;
}

LightSample PathWavefront::with_alpha(LightSample light, const Vec3f& position) const {
  if (!has_alpha_ || !light.area || light.area->light >= shapes_of_lights_.size()) return light;
  // Paths meet the light with this chance, so that its mean is the same.
  if (const std::optional<uint32_t> shape = shapes_of_lights_[light.area->light]) {
    const LightSample::Area& area = *light.area;
    light.radiance *= scene_.alpha_at({.position = position + light.direction * light.distance,
                                       .normal = area.normal,
                                       .shading_normal = area.normal,
                                       .dpdu = Vec3f(0),
                                       .u = area.u,
                                       .v = area.v,
                                       .shape = *shape,
                                       .primitive = area.primitive});
  }
  return light;
}

LightSample PathWavefront::draw_light(const Vec3f& position, const SpectrumValues& spectra,
                                      const std::array<float, 3>& u) const {
  return with_alpha(scene_.lights->sample(position, spectra, u[0], u[1], u[2]), position);
}

void PathWavefront::pass_hole(ScenePath& path) {
  const SurfaceHit& hit = hit_of(path);
  if (path.scatterings == 0) path.distance += hit.t;
  go_on(path, scene_.surfaces->offset_ray_origin(hit.point, path.direction), path.direction);
}

void PathWavefront::cross_boundary(ScenePath& path, const SurfaceHit& hit) {
  const Departure departure = depart(path, hit, path.direction);
  set_media(path, departure.media);
  if (path.scatterings == 0) path.distance += hit.t;
  go_on(path, departure.origin, path.direction);
}

bool PathWavefront::is_hole(const ScenePath& path, const SurfaceHit& hit,
                            const Material& material) const {
  if (!material.has_holes()) return false;
  const SurfaceContext context{path.colors->spectra, scene_.textures, path.hero, path.only_hero};
  return material.is_hole(hit.point, path.direction, context);
}

void PathWavefront::meet_surface(std::size_t slot) {
  ScenePath& path = paths_[slot];
  const std::optional<SurfaceHit> met = choose_surface(path);
  if (!met) {
    pass_hole(path);
    return;
  }
  const SurfaceHit& hit = *met;
  const PathShape& shape = scene_.shapes[hit.point.shape];
  if (shape.light && !path.is_branch) {
    const bool in_rgb = sees_rgb(path);
    const SpectrumValues& spectra = light_spectra(path, in_rgb);
    const LightSeen light = see_light(path, *shape.light, hit, spectra);
    const float share = path.pdf > 0 ? path.pdf / (path.pdf + light.pdf) : 1.0F;
    (in_rgb ? path.rgb : path.radiance) += light_throughput(path, in_rgb) * light.radiance * share;
  }
  if (!shape.material || is_hole(path, hit, scene_.materials[*shape.material])) {
    cross_boundary(path, hit);
    return;
  }
  scatter_at_surface(slot, hit);
}

void PathWavefront::count_cut(const ScenePath& path, const SampledSpectrum& albedo) {
  const int channels = path.colors->spectra.channels();
  float sum = 0;
  for (int c = 0; c < channels; ++c) sum += path.throughput[c] * albedo[c];
  jobs_[path.job].counts.cut(path.channel < 0 ? sum / static_cast<float>(channels) : sum);
}

float PathWavefront::shadow_survival(const ScenePath& path, const Vec3f& position,
                                     const LightSample& light,
                                     const SampledSpectrum& radiance) const {
  if (setup_.shadow_guide == nullptr) return 1;
  return setup_.shadow_guide->roulette(path.medium)
      .survival(position, light.direction, brightness(path, radiance, false, light.distance));
}

void PathWavefront::scatter_at_surface(std::size_t slot, const SurfaceHit& hit) {
  ScenePath& path = paths_[slot];
  const PathShape& shape = scene_.shapes[hit.point.shape];
  const Material& material = scene_.materials[*shape.material];
  if (jobs_.layers.on()) {
    jobs_.layers.scattering(path.result, path.scatterings, rgb_of(path, path.radiance, path.rgb));
  }
  if (meter_ != nullptr) arrive_at_ground(path, hit.point.position);
  if (path.scatterings++ == 0 && meter_ == nullptr) {
    const SurfaceContext context{setup_.factory->rgb(), scene_.textures};
    record_event(path, hit.t, path.throughput, material.albedo(hit.point, path.direction, context),
                 hit.point.shading_normal);
    if (jobs_.layers.on()) jobs_.layers.transmittance(path.result, transmittance_of(path));
  }
  const SurfaceContext context{path.colors->spectra, scene_.textures, path.hero, path.only_hero};
  RandomStream random(setup_.seed, path.pixel, path.sample_key,
                      stream_number(StreamPurpose::kScatter, path.flights));
  if (is_cut(path)) {
    count_cut(path, material.albedo(hit.point, path.direction, context));
    path.is_dead = true;
    return;
  }
  if (!survives(path, random.uniform())) {
    path.is_dead = true;
    return;
  }
  const Vec3f position = hit.point.position;
  if (meter_ != nullptr) {
    show_surface(slot, hit, material, random, context);
  } else if (!material.is_specular() && scene_.lights->is_drawn()) {
    // Braces keep the order of draws.
    const std::array<float, 3> u{random.uniform(), random.uniform(), random.uniform()};
    const LightSample light = draw_light(position, path.colors->spectra, u);
    const float brought = share_of_light(path, light.direction, light.distance);
    if (light.pdf > 0 && brought > 0) {
      const MaterialValue f =
          material.evaluate(hit.point, path.direction, light.direction, random, context);
      const float share = light.delta ? 1.0F : light.pdf / (light.pdf + f.pdf);
      SampledSpectrum radiance =
          path.throughput * light.radiance * f.value * (brought * share / light.pdf);
      const float survival = shadow_survival(path, position, light, radiance);
      if (survival < 1) radiance *= random.uniform() < survival ? 1 / survival : 0.0F;
      if (!is_black(radiance)) {
        const Departure departure = depart(path, hit, light.direction);
        shadows_.add(static_cast<uint32_t>(slot), path, departure.origin, light.direction,
                     shadow_end(light), departure.media, radiance, false);
      }
    }
  }
  const auto next = material.sample(hit.point, path.direction, random, context);
  if (!next || is_black(next->weight)) {
    path.is_dead = true;
    return;
  }
  path.throughput *= next->weight;
  path.may_differ = true;
  if (is_black(path.throughput)) {  // no channel of the surface has what was left of the path's
    path.is_dead = true;
    return;
  }
  path.is_coloured = true;  // equal at these wavelengths is not equal at all
  path.only_hero = path.only_hero || next->hero_only;
  const float pdf = std::exchange(path.pdf, next->specular ? 0.0F : next->pdf);
  const bool is_refracted = setup_.glass_spheres != nullptr && refract(path, hit, *next, pdf);
  const Departure departure = depart(path, hit, next->direction);
  set_media(path, departure.media);
  turn(path, is_refracted ? path.turned_at : position, departure.origin, next->direction);
}

}  // namespace freepath
