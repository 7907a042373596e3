#pragma once
/// @file What a light that is a surface needs to know of its geometry.

#include <cstdint>

#include "freepath/base/vector.h"
#include "freepath/geometry/surface_point.h"

namespace freepath {

/// A point drawn on a surface that shines.
struct EmitterPoint {
  Vec3f position;
  Vec3f normal;        ///< Unit; the same side as SurfacePoint::normal of this point.
  float u = 0, v = 0;  ///< Coordinates on the surface, as in SurfacePoint.
  float pdf = 0;       ///< [1/sr], seen from the reference; with 0 there is no point.
};

/// Where a part of a surface is, how large, and to where it faces.
struct EmitterBounds {
  Box3f box;
  Vec3f axis{0, 0, 1};      ///< Unit vector in the middle of all normals.
  float cosine_spread = 1;  ///< Cosine of the largest angle between it and a normal; -1 for all.
  double area = 0;
};

/// A shape as a light. Its parts are those that SurfacePoint::primitive numbers (the triangles of a
/// mesh); each is a light of its own. Positions are relative to the origin of the rays [world].
/// All but the counts and bounds is called by many threads at once; none of it throws.
class EmitterGeometry {
 public:
  EmitterGeometry() = default;
  EmitterGeometry(const EmitterGeometry&) = delete;
  EmitterGeometry& operator=(const EmitterGeometry&) = delete;
  virtual ~EmitterGeometry() = default;

  virtual uint32_t part_count() const = 0;
  virtual EmitterBounds bounds(uint32_t part) const = 0;
  /// A point that need not be visible from the reference.
  virtual EmitterPoint sample(uint32_t part, const Vec3f& reference, float u0, float u1) const = 0;
  /// Density with which `sample` draws a point, seen from the reference [1/sr].
  virtual float pdf(const Vec3f& reference, const SurfacePoint& point) const = 0;
};

}  // namespace freepath
