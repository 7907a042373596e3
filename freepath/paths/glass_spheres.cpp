#include "freepath/paths/glass_spheres.h"

#include <cmath>

#include "freepath/materials/fresnel.h"

namespace freepath {

namespace {

GlassLight light_of(const GlassSphere& glass, const Vec3d& inside, const Vec3d& lamp,
                    const Vec3d& normal, const SphereEntry& entry) {
  const Vec3d straight = lamp - inside;
  const Vec3d outside = lamp - entry.position;
  // Cosines at the lamp over distances.
  const double seen = std::abs(normal.dot(straight)) / straight.length();
  const double hit = std::abs(normal.dot(outside)) / outside.length();
  return {entry, Vec3f((entry.position - inside).normalized()), glass.transmitted(entry.cosine),
          static_cast<float>(seen / hit * entry.spread / straight.length2())};
}

}  // namespace

float GlassSphere::transmitted(double cosine) const {
  return 1 - fresnel_dielectric(static_cast<float>(cosine), static_cast<float>(1 / sphere.eta()));
}

GlassSpheres::GlassSpheres(const PathScene& scene) {
  if (!scene.surfaces || scene.domain) return;
  for (const WholeSphere& whole : scene.surfaces->whole_spheres()) {
    const PathShape& shape = scene.shapes[whole.shape];
    if (!shape.material || shape.light || shape.alpha) continue;
    const auto* const glass =
        std::get_if<DielectricMaterial>(&scene.materials[*shape.material].kind());
    if (glass == nullptr || !glass->is_specular() || !scene.spectra->is_constant(glass->eta)) {
      continue;
    }
    const double eta = scene.spectra->in_rgb()[glass->eta][0];
    if (!(eta > 0) || eta == 1) continue;
    spheres_.push_back({{whole.center, whole.radius, eta}, whole.shape, whole.primitive});
  }
}

std::optional<GlassLight> GlassSpheres::find(const GlassSphere& glass, const Vec3f& inside,
                                             const Vec3f& lamp, const Vec3f& normal) {
  const Vec3d from(inside);
  const Vec3d to(lamp);
  const auto entry = glass.sphere.find(from, to);
  if (!entry) return std::nullopt;
  return light_of(glass, from, to, Vec3d(normal), *entry);
}

std::optional<GlassLight> GlassSpheres::at(const GlassSphere& glass, const Vec3f& inside,
                                           const Vec3f& lamp, const Vec3f& normal,
                                           const Vec3f& travel) {
  // The ray has left the sphere where its line does.
  const RefractingSphere& sphere = glass.sphere;
  const Vec3d to = Vec3d(lamp) - sphere.center();
  const Vec3d back = -Vec3d(travel).normalized();
  const double along = to.dot(back);
  const double inner = along * along - to.length2() + sphere.radius() * sphere.radius();
  if (!(inner > 0)) return std::nullopt;
  const Vec3d left = Vec3d(lamp) + back * (-along - std::sqrt(inner));
  const auto entry = sphere.at(Vec3d(inside), Vec3d(lamp), left);
  if (!entry) return std::nullopt;
  return light_of(glass, Vec3d(inside), Vec3d(lamp), Vec3d(normal), *entry);
}

}  // namespace freepath
