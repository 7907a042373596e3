// The second of two scatterings of a PathWavefront before light from outside, drawn from the
// light's end.

#include "freepath/paths/path_wavefront.h"

namespace freepath {

void PathWavefront::draw_lobe_line(std::size_t i, const ShadowRoulette& guide) {
  const float chance = scatterings_.lobe_chance[i];
  // The other end of the numbers is the shadow ray's.
  if (!(chance > 0) || scatterings_.numbers[kShadowNumber][i] < 1 - chance) return;
  const Scattering& scattering = scattered_[i];
  const ScenePath& path = paths_[scattering.slot];
  const auto vector_of = [&](const std::array<ScatteringStream::Row<float>, 3>& rows) {
    return Vec3f(rows[0][i], rows[1][i], rows[2][i]);
  };
  const Vec3f to_light = vector_of(scatterings_.to_light);
  const float light_pdf = scatterings_.light_pdf[i];
  if (!(light_pdf > 0) || scattering.end.distance != kFromOutside ||
      path.scatterings >= setup_.max_scatterings ||
      to_light.dot(guide.dominant) < ShadowRoulette::kSameDirection) {
    return;
  }
  RandomStream random = LobeLines::numbers(setup_.seed, path);
  // Braces keep the order of draws.
  const std::array<float, 2> u{random.uniform(), random.uniform()};
  const Vec3f direction = scattering.phase->sample(to_light, u[0], u[1]).direction;
  const float before = scattering.phase->evaluate(vector_of(scatterings_.direction), direction);
  const float after = scattering.phase->evaluate(direction, to_light);
  const float found = scatterings_.light_found[i];
  const float density = before * (light_pdf + found * after) + chance * light_pdf * after;
  const SampledSpectrum radiance = scattering.radiance * (before * after / density);
  if (is_black(radiance)) return;
  const Vec3f position = vector_of(scatterings_.position);
  const float length = scene_.way_to_surface(path.medium, position, direction);
  lobe_lines_->add({.slot = scattering.slot,
                    .in_rgb = scattering.in_rgb,
                    .number = random.uniform(),
                    .direction = direction,
                    .to_light = to_light,
                    .radiance = radiance},
                   position, length, path);
}

void PathWavefront::light_lobe_line(const LobeLines::Line& line) {
  const ScenePath& path = paths_[line.slot];
  SampledSpectrum radiance = line.radiance;
  const ShadowRoulette& roulette = setup_.shadow_guide->roulette(path.medium);
  const float survival =
      roulette.survival(line.position, line.to_light, brightness_of(path, radiance, line.in_rgb));
  if (survival < 1) radiance *= line.number < survival ? 1 / survival : 0.0F;
  if (is_black(radiance)) return;
  lobe_shadows_->add(line.slot, path, line.position, line.to_light, {kFromOutside, {}}, path.media,
                     radiance, line.in_rgb, line.in_rgb ? kInRgb : kInWavelengths);
}

void PathWavefront::trace_lobe_lines() {
  lobe_lines_->trace(paths_, counts_.free_paths,
                     [&](const LobeLines::Line& line) { light_lobe_line(line); });
  lobe_shadows_->trace(paths_, counts_.shadow_rays,
                       [&](ScenePath& path, uint32_t sum, const SampledSpectrum& radiance) {
                         add_ahead(path, sum, radiance);
                       });
}

}  // namespace freepath
