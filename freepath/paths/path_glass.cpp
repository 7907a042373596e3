// Lamps that the paths of a PathWavefront see through spheres of glass.

#include "freepath/paths/path_wavefront.h"

namespace freepath {

void PathWavefront::draw_light_through(std::size_t i, const ScenePath& path,
                                       const GlassSphere& glass, const LightSample& draw) {
  // Lamps that are not drawn stay dark: no straight ray leaves the sphere.
  scatterings_.light_pdf[i] = 0;
  scatterings_.light_found[i] = 1;
  scatterings_.brightness[i] = 0;
  for (int axis = 0; axis < 3; ++axis) scatterings_.to_light[axis][i] = draw.direction[axis];
  Scattering& scattering = scattered_[i];
  scattering.radiance = SampledSpectrum();
  const bool plays = GlassSpheres::plays(path.scatterings, setup_.max_scatterings);
  if (path.is_branch || !plays || !draw.area || draw.delta || !(draw.pdf > 0)) return;
  const Vec3f position{scatterings_.position[0][i], scatterings_.position[1][i],
                       scatterings_.position[2][i]};
  const Vec3f lamp = position + draw.direction * draw.distance;
  const auto light = GlassSpheres::find(glass, position, lamp, draw.area->normal);
  if (!light || !(light->transmitted > 0)) return;

  const Vec3f normal(light->entry.normal);
  SurfacePoint left{};
  left.position = Vec3f(light->entry.position);
  left.normal = normal;
  left.shape = glass.shape;
  const Vec3f origin = scene_.surfaces->offset_ray_origin(left, normal);
  LightSample seen = draw;
  const Vec3f way = lamp - origin;
  seen.distance = way.length();
  seen.direction = way * (1 / seen.distance);
  SurfacePoint shining{};
  shining.normal = draw.area->normal;
  shining.u = draw.area->u;
  shining.v = draw.area->v;
  shining.primitive = draw.area->primitive;
  seen.radiance = scene_.lights->emitted(draw.area->light, shining, -seen.direction,
                                         light_spectra(path, scattering.in_rgb));
  seen = with_alpha(seen, origin);
  const auto eta = static_cast<float>(glass.sphere.eta());
  scattering.radiance = light_throughput(path, scattering.in_rgb) * seen.radiance * (eta * eta);
  scattering.end = {(left.position - position).length(),
                    ShadowEnd::Target{glass.shape, glass.primitive}};
  scattering.bend = {origin, seen.direction, shadow_end(seen), glass.shape};
  // Both ways to find it are by as much less likely, or darker, as the glass reflects.
  scatterings_.light_pdf[i] = draw.pdf * light->density_ratio / light->transmitted;
  scatterings_.brightness[i] =
      brightness(path, scattering.radiance, scattering.in_rgb, seen.distance);
  for (int axis = 0; axis < 3; ++axis) scatterings_.to_light[axis][i] = light->towards[axis];
}

LightSeen PathWavefront::see_light(const ScenePath& path, uint32_t light, const SurfaceHit& hit,
                                   const SpectrumValues& spectra) const {
  if (path.pdf > 0 && path.glass == nullptr) {
    return scene_.lights->hit(path.turned_at, light, hit.point, spectra);
  }
  LightSeen seen{scene_.lights->emitted(light, hit.point, -path.direction, spectra), 0};
  if (path.glass == nullptr) return seen;
  const auto through = GlassSpheres::at(*path.glass, path.turned_at, hit.point.position,
                                        hit.point.normal, path.direction);
  if (through) {
    seen.pdf =
        scene_.lights->hit(path.turned_at, light, hit.point, spectra).pdf * through->density_ratio;
  }
  return seen;
}

bool PathWavefront::refract(ScenePath& path, const SurfaceHit& hit, const MaterialSample& next,
                            float pdf) const {
  const bool is_from_medium = std::exchange(path.is_from_medium, false);
  path.glass = nullptr;
  if (!is_from_medium || !next.specular || !next.transmitted || !hit.from_inside) return false;
  if (!GlassSpheres::plays(path.scatterings - 1, setup_.max_scatterings)) return false;
  const GlassSphere* const glass = setup_.glass_spheres->around(path.turned_at);
  if (glass == nullptr || glass->shape != hit.point.shape) return false;
  path.glass = glass;
  path.pdf = pdf * glass->transmitted(path.direction.dot(hit.point.normal));
  return true;
}

}  // namespace freepath
