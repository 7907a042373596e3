// Light of near lights along the rays of a PathWavefront.

#include "freepath/paths/path_wavefront.h"

namespace freepath {
namespace {

/// The two ways in which a path adds up what it sees, as cells of a ShadowTracer.
enum Sum : uint32_t { kInWavelengths = 0, kInRgb = 1 };

/// Share of the lines from scatterings that take the directions of their paths.
constexpr float kPathDirections = 0.5F;

}  // namespace

void PathWavefront::send_near_line(std::size_t slot, float length) {
  const ScenePath& path = paths_[slot];
  if (path.scatterings >= setup_.max_scatterings || path.line_is_drawn) return;
  RandomStream random = NearLightLines::numbers(setup_.seed, path);
  const auto point =
      setup_.near_lights->sample(path.medium, path.origin, path.direction, length, random);
  if (point) add_near_line(slot, path.origin, path.direction, *point, 1, random);
}

void PathWavefront::draw_near_line(std::size_t i) {
  const Scattering& scattering = scattered_[i];
  ScenePath& path = paths_[scattering.slot];
  path.line_is_drawn = true;
  if (path.scatterings >= setup_.max_scatterings) return;
  const NearLights& lights = *setup_.near_lights;
  const Vec3f position{scatterings_.position[0][i], scatterings_.position[1][i],
                       scatterings_.position[2][i]};
  RandomStream random = NearLightLines::numbers(setup_.seed, path);
  const auto aim = lights.aim(path.medium, position, random);
  if (!aim) return;
  // One of both directions; the balance heuristic for one sample [Veach97].
  Vec3f direction = aim->direction;
  float value = scatterings_.next_pdf[i];
  if (random.uniform() < kPathDirections) {
    direction = {scatterings_.next[0][i], scatterings_.next[1][i], scatterings_.next[2][i]};
  } else {
    value = scattering.phase->evaluate(
        {scatterings_.direction[0][i], scatterings_.direction[1][i], scatterings_.direction[2][i]},
        direction);
  }
  const float density =
      kPathDirections * value +
      (1 - kPathDirections) * lights.aim_pdf(aim->ball, path.medium, position, direction);
  const float length = scene_.way_to_surface(path.medium, position, direction);
  const auto point = lights.sample_on(aim->ball, path.medium, position, direction, length, random);
  if (!point) return;
  add_near_line(scattering.slot, position, direction, *point, value / (density * aim->probability),
                random);
}

void PathWavefront::add_near_line(std::size_t slot, const Vec3f& origin, const Vec3f& direction,
                                  const NearLights::Point& point, float factor,
                                  RandomStream& random) {
  const ScenePath& path = paths_[slot];
  NearLightLines::Line line{.slot = static_cast<uint32_t>(slot),
                            .t = point.t,
                            .factor = point.weight * factor,
                            .in_rgb = sees_rgb(path),  // then media don't tell colours apart
                            .position = origin + direction * point.t,
                            .direction = direction};
  // Braces keep the order of draws.
  const std::array<float, 2> u{random.uniform(), random.uniform()};
  line.light = with_alpha(scene_.lights->sample_of(point.light, line.position,
                                                   light_spectra(path, line.in_rgb), u[0], u[1]),
                          line.position);
  if (!(line.light.pdf > 0) || is_black(line.light.radiance)) return;
  line.light_share = scene_.lights->share_of(point.light, line.position);
  near_lines_->add(line, origin, path);
}

void PathWavefront::light_near_line(const NearLightLines::Line& line) {
  const ScenePath& path = paths_[line.slot];
  const LightSample& light = line.light;
  const MediumWalkers::Origin scatterer = scatterer_of(path, line.component);
  const PhaseFunction& phase = scene_.media[scatterer.medium].phase(scatterer.component);
  const float value = phase.evaluate(line.direction, light.direction);
  // The share that a draw of the light at a scattering would have beside paths that find it.
  const float drawn = light.pdf * line.light_share;
  const float share = light.delta ? 1.0F : drawn / (drawn + value);
  const SampledSpectrum radiance = light_throughput(path, line.in_rgb) * line.scattered *
                                   light.radiance * (line.factor * value * share / light.pdf);
  if (is_black(radiance)) return;
  near_shadows_->add(line.slot, path, line.position, light.direction, shadow_end(light), path.media,
                     radiance, line.in_rgb, line.in_rgb ? kInRgb : kInWavelengths);
}

void PathWavefront::trace_near_lines() {
  near_lines_->trace(paths_, counts_.shadow_rays,
                     [&](const NearLightLines::Line& line) { light_near_line(line); });
  near_shadows_->trace(paths_, counts_.shadow_rays,
                       [&](ScenePath& path, uint32_t sum, const SampledSpectrum& radiance) {
                         const SampledSpectrum none;
                         (sum == kInRgb ? path.rgb : path.radiance) += radiance;
                         if (!jobs_.layers.on()) return;
                         jobs_.layers.ahead(path.result, sum == kInRgb
                                                             ? rgb_of(path, none, radiance)
                                                             : rgb_of(path, radiance, none));
                       });
}

}  // namespace freepath
