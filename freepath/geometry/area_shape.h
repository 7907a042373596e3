#pragma once
/// @file Shapes as lights: points drawn on one of their primitives.

#include <cstdint>
#include <memory>

#include "freepath/base/vector.h"
#include "freepath/geometry/shape_geometry.h"
#include "freepath/geometry/surface_point.h"

namespace freepath {

/// A point drawn on a primitive. Relative to the origin of the rays [world].
struct AreaSample {
  Vec3f position;
  Vec3f normal;        ///< Geometric, unit, to the outside.
  float u = 0, v = 0;  ///< Texture coordinates.
  float pdf = 0;       ///< [1/world²] or [1/sr]; 0 where nothing could be drawn.
};

/// One shape. Its primitives bear the numbers of SurfacePoint::primitive, beginning with
/// SurfaceShape::first_primitive. All uniform numbers are in [0, 1).
///
/// Seen from a point, these are drawn uniformly in solid angle, the others by area:
///   - whole spheres that are not distorted, from outside: the cone that they fill;
///   - triangles of a solid angle in [2e-4, 6.22]: with fewer digits or wider ones the spherical
///     triangle is ill conditioned [Arvo95].
class AreaShape {
 public:
  /// @param origin of the rays [world]
  /// @throws Error for bad geometry, as Surfaces does
  AreaShape(const SurfaceShape& shape, const Vec3d& origin);
  ~AreaShape();
  AreaShape(AreaShape&&) noexcept;
  AreaShape& operator=(AreaShape&&) noexcept;

  uint32_t first_primitive() const;
  uint32_t primitive_count() const;

  /// [world²]
  double area(uint32_t primitive) const;
  /// @return with a pdf per area [1/world²]; constant unless the primitive is a patch that is not
  ///   flat or a distorted quadric
  AreaSample sample(uint32_t primitive, float u0, float u1) const;
  /// Density per area of `sample` at a point of the shape [1/world²].
  float pdf(const SurfacePoint& point) const;

  /// @return with a pdf per solid angle around `from` [1/sr]
  AreaSample sample_from(const Vec3f& from, uint32_t primitive, float u0, float u1) const;
  /// Density of `sample_from` for the direction to a point of the shape that is seen from there,
  /// that is with no other part of its primitive between [1/sr]. Among the two points of a ray
  /// through a sphere, patch or cylinder each has its own density, except for the cone of a sphere:
  /// there the nearer alone is drawn, and the density of the other is 0.
  float pdf_from(const Vec3f& from, const SurfacePoint& point) const;

 private:
  class Kind;
  class TriangleKind;
  class PatchKind;
  class QuadricKind;
  std::unique_ptr<const Kind> kind_;
};

}  // namespace freepath
