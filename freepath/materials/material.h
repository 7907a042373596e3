#pragma once
/// @file How a surface scatters light.

#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "freepath/base/random.h"
#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/vector.h"
#include "freepath/geometry/surface_point.h"
#include "freepath/materials/material_kinds.h"
#include "freepath/materials/surface_context.h"

namespace freepath {

/// A direction that a path goes on in.
struct MaterialSample {
  Vec3f direction;  ///< Direction of travel, unit [world].
  /// f |cosine| / density. With hero_only it is 0 in all channels but the hero's, where
  /// SurfaceContext::hero_factor is in it.
  SampledSpectrum weight;
  float pdf = 0;             ///< [1/sr]; 0 of a specular event.
  bool specular = false;     ///< The direction had no choice, so that no evaluate() covers it.
  bool transmitted = false;  ///< To the other side of the surface.
  bool hero_only = false;    ///< From here on SurfaceContext::only_hero is true.
};

/// A material of a scene. Shared by all threads.
///
/// Radiance is what paths carry: a refraction divides it by the square of the relative refractive
/// index. Which side of the surface a direction lies on, the geometric normal decides; directions
/// that the shading normal puts on another side carry nothing, so that no light leaks through.
/// Where the shading normal turns away from a path that comes from the front, the geometric one
/// takes its place.
///
/// Layered materials evaluate themselves by random walks: a value is an unbiased estimate, and the
/// pdf, which is then no density of what sample() draws, serves only as a weight between the two
/// techniques. It is the same in sample() and evaluate(), hence those weights sum to 1.
class Material {
 public:
  using Kind = std::variant<DiffuseMaterial, DiffuseTransmissionMaterial, ConductorMaterial,
                            DielectricMaterial, ThinDielectricMaterial, CoatedDiffuseMaterial,
                            CoatedConductorMaterial, MixMaterial>;

  /// @throws Error if a mix has no material at all, or a coating no walks or interactions
  Material(Kind kind);
  /// Material of one of the kinds.
  template <class T>
  requires std::is_constructible_v<Kind, T> Material(T kind) : Material(Kind(std::move(kind))) {}

  /// Draws where a path goes on; nothing if it ends.
  /// @param travel direction of travel before, unit [world]
  std::optional<MaterialSample> sample(const SurfacePoint& point, const Vec3f& travel,
                                       RandomStream& random, const SurfaceContext& context) const;

  /// Value and density for two directions of travel; 0 of specular events. A channel-parting
  /// refraction has a value in the hero's channel only, hero_factor included.
  MaterialValue evaluate(const SurfacePoint& point, const Vec3f& travel, const Vec3f& next,
                         RandomStream& random, const SurfaceContext& context) const;

  /// Whether evaluate() is 0 everywhere.
  bool is_specular() const { return is_specular_; }
  /// Whether any path goes on to the other side.
  bool transmits() const { return transmits_; }
  /// Whether there is an interface among the parts of a mix.
  bool has_holes() const { return has_holes_; }
  /// Whether a path goes on at a point as if there were no surface. sample() and evaluate() are for
  /// all others.
  bool is_hole(const SurfacePoint& point, const Vec3f& travel,
               const SurfaceContext& context) const {
    return has_holes_ && resolved(point, travel, context) == nullptr;
  }

  /// The share of light that is scattered, for pictures of it: exact for diffuse, smooth and
  /// thin ones, else an approximation that leaves roughness and the medium of a coating out. The
  /// radiance scale of refraction is not in it.
  ///
  /// Parts of a mix that are parts of others, too, are looked at once, however deep mixes nest.
  /// @param visited if given, how many materials were looked at is added to it
  SampledSpectrum albedo(const SurfacePoint& point, const Vec3f& travel,
                         const SurfaceContext& context, uint64_t* visited = nullptr) const;

  const Kind& kind() const { return kind_; }

 private:
  void check() const;
  /// The one that a mix chooses, itself for others, null for an interface: by a hash of place and
  /// direction, so that sample() and evaluate() at a hit agree.
  const Material* resolved(const SurfacePoint& point, const Vec3f& travel,
                           const SurfaceContext& context) const;

  Kind kind_;
  bool is_specular_ = false, transmits_ = false, has_holes_ = false;
};

}  // namespace freepath
