#pragma once
/// @file Spheres of glass whose insides see lights through them.

#include <cstdint>
#include <optional>
#include <vector>

#include "freepath/geometry/refracting_sphere.h"
#include "freepath/lights/light_sample.h"
#include "freepath/paths/path_scene.h"

namespace freepath {

/// A sphere of smooth glass.
struct GlassSphere {
  RefractingSphere sphere;
  uint32_t shape, primitive;  ///< Of SurfacePoint.

  /// Share of the light that passes from inside to outside, and back.
  float transmitted(double cosine) const;
};

/// Light of a lamp that a sphere of glass refracts to a point inside.
struct GlassLight {
  SphereEntry entry;
  Vec3f towards;      ///< Direction in which it is seen from inside, unit [world].
  float transmitted;  ///< GlassSphere::transmitted
  /// Solid angle at the point inside, would nothing be refracted, over the one in which the light
  /// is seen: densities of directions are multiplied by it.
  float density_ratio;
};

/// Finds the light of lamps that is refracted once: paths that a medium scatters in a sphere of
/// smooth glass find it where the line to the lamp is solved for, as [Walter09] does for meshes,
/// and by chance, combined by the balance heuristic. No straight shadow ray leaves such a sphere.
/// Immutable; threads share it.
class GlassSpheres {
 public:
  /// @param scene must have surfaces and outlive this
  explicit GlassSpheres(const PathScene& scene);

  bool is_empty() const { return spheres_.empty(); }
  /// The sphere around a point; null: none.
  const GlassSphere* around(const Vec3f& position) const {
    for (const GlassSphere& glass : spheres_) {
      if (glass.sphere.holds(Vec3d(position))) return &glass;
    }
    return nullptr;
  }

  /// Whether light from that far is refracted once and found so, and not by chance alone. Of the
  /// first scattering light is found by chance: layers take it for one that was scattered twice.
  /// @param scatterings of the path in the sphere
  static bool plays(uint32_t scatterings, uint32_t max_scatterings) {
    return scatterings > 1 && scatterings < max_scatterings;
  }
  /// Light of a point of a lamp outside.
  static std::optional<GlassLight> find(const GlassSphere& glass, const Vec3f& inside,
                                        const Vec3f& lamp, const Vec3f& normal);
  /// The same if a path finds it by chance.
  /// @param travel direction in which the path meets the lamp
  static std::optional<GlassLight> at(const GlassSphere& glass, const Vec3f& inside,
                                      const Vec3f& lamp, const Vec3f& normal, const Vec3f& travel);

 private:
  std::vector<GlassSphere> spheres_;
};

}  // namespace freepath
