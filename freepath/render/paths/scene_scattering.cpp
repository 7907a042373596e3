// What happens to the paths of a SceneWavefront at surfaces and collisions.

#include "freepath/render/paths/scene_wavefront.h"

namespace freepath {
namespace {

/// Light on a surface is not shadowed by that surface itself.
constexpr float kShadowLength = 1 - 1e-4F;

}  // namespace

bool SceneWavefront::sees_rgb(const ScenePath& path) const {
  const bool needs_spectrum = !spectra_.empty();
  if (!setup_.factory->sees_rgb() || path.is_coloured || needs_spectrum) return false;
  const Channels& c = path.throughput;
  for (int i = 1; i < path.colors->spectra.channels(); ++i) {
    if (c[i] != c[0]) return false;
  }
  return true;
}

Channels SceneWavefront::light_throughput(const ScenePath& path, bool in_rgb) {
  return in_rgb ? Channels(path.throughput[0]) : path.throughput;
}

const SpectrumValues& SceneWavefront::light_spectra(const ScenePath& path, bool in_rgb) const {
  return in_rgb ? setup_.factory->rgb() : path.colors->spectra;
}

void SceneWavefront::go_on(ScenePath& path, const Vec3f& origin, const Vec3f& direction) const {
  path.origin = origin;
  path.direction = direction;
  path.hit.reset();
  path.surfaces_known = false;
  path.emission_share = 1;
  ++path.flights;
}

void SceneWavefront::cross_boundary(ScenePath& path, const SurfaceHit& hit) const {
  path.medium = medium_beyond(scene_.shapes[hit.point.shape], !hit.from_inside, path.medium);
  if (path.scatterings == 0) path.distance += hit.t;
  go_on(path, scene_.surfaces->offset_ray_origin(hit.point, path.direction), path.direction);
}

void SceneWavefront::meet_surface(std::size_t slot) {
  ScenePath& path = paths_[slot];
  const SurfaceHit& hit = *path.hit;
  const PathShape& shape = scene_.shapes[hit.point.shape];
  if (shape.light) {
    const bool in_rgb = sees_rgb(path);
    const SpectrumValues& spectra = light_spectra(path, in_rgb);
    const LightSeen light =
        path.pdf > 0
            ? scene_.lights->hit(path.scattered_from, *shape.light, hit.point, spectra)
            : LightSeen{scene_.lights->emitted(*shape.light, hit.point, -path.direction, spectra),
                        0};
    const float share = path.pdf > 0 ? path.pdf / (path.pdf + light.pdf) : 1.0F;
    (in_rgb ? path.rgb : path.radiance) += light_throughput(path, in_rgb) * light.radiance * share;
  }
  if (!shape.material) {
    const SurfaceHit crossed = hit;  // which goes with the ray
    cross_boundary(path, crossed);
    return;
  }
  scatter_at_surface(slot);
}

bool SceneWavefront::survives(ScenePath& path, RandomStream& random) const {
  if (path.scatterings > setup_.max_scatterings) return false;
  const float throughput = largest_magnitude(path.throughput);
  if (throughput >= setup_.roulette_threshold) return true;
  const float survival = throughput / setup_.roulette_threshold;
  if (random.uniform() >= survival) return false;
  path.throughput *= 1.0F / survival;
  return true;
}

void SceneWavefront::scatter_at_surface(std::size_t slot) {
  ScenePath& path = paths_[slot];
  const SurfaceHit hit = *path.hit;
  const PathShape& shape = scene_.shapes[hit.point.shape];
  const Material& material = scene_.materials[*shape.material];
  if (layers_.on()) {
    layers_.scattering(path.result, path.scatterings, rgb_of(path, path.radiance, path.rgb));
  }
  if (path.scatterings++ == 0) {
    const SurfaceContext context{setup_.factory->rgb(), scene_.textures};
    record_event(path, hit.t, material.albedo(hit.point, path.direction, context),
                 hit.point.shading_normal);
    if (layers_.on()) layers_.transmittance(path.result, transmittance_of(path));
    path.sample.alpha = 1;
  }
  RandomStream random(setup_.seed, path.pixel, path.sample_key,
                      stream_number(StreamPurpose::kScatter, path.flights));
  if (!survives(path, random)) {
    path.is_dead = true;
    return;
  }
  const SurfaceContext context{path.colors->spectra, scene_.textures, path.hero, path.only_hero};
  const Vec3f position = hit.point.position;
  const auto side = [&](const Vec3f& direction) {
    return medium_beyond(shape, direction.dot(hit.point.normal) < 0, path.medium);
  };
  if (!material.is_specular() && !scene_.lights->is_dark()) {
    const float u0 = random.uniform();
    const float u1 = random.uniform();
    const float u2 = random.uniform();
    const LightDraw light = scene_.lights->sample(position, path.colors->spectra, u0, u1, u2);
    if (light.pdf > 0) {
      const MaterialValue f =
          material.evaluate(hit.point, path.direction, light.direction, random, context);
      const float share = light.delta ? 1.0F : light.pdf / (light.pdf + f.pdf);
      const Channels radiance = path.throughput * light.radiance * f.value * (share / light.pdf);
      if (!is_black(radiance)) {
        shadows_.add(static_cast<uint32_t>(slot),
                     scene_.surfaces->offset_ray_origin(hit.point, light.direction),
                     light.direction, light.distance * kShadowLength, side(light.direction),
                     radiance, false);
      }
    }
  }
  const auto next = material.sample(hit.point, path.direction, random, context);
  if (!next || is_black(next->weight)) {
    path.is_dead = true;
    return;
  }
  path.throughput *= next->weight;
  path.is_coloured = true;  // equal at these wavelengths is not equal at all
  path.only_hero = path.only_hero || next->hero_only;
  path.pdf = next->specular ? 0.0F : next->pdf;
  path.scattered_from = position;
  path.medium = side(next->direction);
  go_on(path, scene_.surfaces->offset_ray_origin(hit.point, next->direction), next->direction);
}

void SceneWavefront::scatter_in_medium(std::size_t slot, float t, std::size_t component) {
  ScenePath& path = paths_[slot];
  const SceneMedium& medium = scene_.media[path.medium];
  if (layers_.on()) {
    layers_.scattering(path.result, path.scatterings, rgb_of(path, path.radiance, path.rgb));
  }
  if (path.scatterings++ == 0) {
    record_event(path, t, medium.albedo(component, setup_.factory->rgb()), -path.direction);
    path.sample.alpha = 1;
  }
  RandomStream random(setup_.seed, path.pixel, path.sample_key,
                      stream_number(StreamPurpose::kScatter, path.flights));
  if (!survives(path, random)) {
    path.is_dead = true;
    return;
  }
  const Vec3f position = path.origin + path.direction * t;
  const PhaseFunction& phase = medium.phase(component);
  if (!scene_.lights->is_dark()) {
    const float u0 = random.uniform();
    const float u1 = random.uniform();
    const float u2 = random.uniform();
    const bool in_rgb = sees_rgb(path);
    const LightDraw light =
        scene_.lights->sample(position, light_spectra(path, in_rgb), u0, u1, u2);
    if (light.pdf > 0) {
      // The phase function is its own density.
      const float value = phase.evaluate(path.direction, light.direction);
      const float share = light.delta ? value / light.pdf : value / (light.pdf + value);
      const Channels radiance = light_throughput(path, in_rgb) * light.radiance * share;
      if (!is_black(radiance)) {
        shadows_.add(static_cast<uint32_t>(slot), position, light.direction,
                     light.distance * kShadowLength, path.medium, radiance, in_rgb);
      }
    }
  }
  const EmissionGuide* const guide = guide_of(path.medium);
  if (guide != nullptr) draw_emission(slot, *guide, position, phase, random);
  const float u1 = random.uniform();
  const float u2 = random.uniform();
  const PhaseSample next = phase.sample(path.direction, u1, u2);
  path.pdf = next.pdf;
  path.scattered_from = position;
  go_on(path, position, next.direction);
  if (guide != nullptr) {
    path.emission_share = next.pdf / (next.pdf + guide->pdf(position, next.direction));
  }
}

void SceneWavefront::draw_emission(std::size_t slot, const EmissionGuide& guide,
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
