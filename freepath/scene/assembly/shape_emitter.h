#pragma once
/// @file A shape of the scene as the geometry of a light.

#include <vector>

#include "freepath/geometry/area_shape.h"
#include "freepath/lights/emitter_geometry.h"

namespace freepath {

/// Where AreaShape and the lights meet. Its parts are the primitives of one mesh, or one quadric.
class ShapeEmitter final : public EmitterGeometry {
 public:
  /// @param origin of the rays [world]
  /// @throws Error as AreaShape
  ShapeEmitter(const SurfaceShape& shape, const Vec3d& origin);

  uint32_t part_count() const override { return shape_.primitive_count(); }
  EmitterBounds bounds(uint32_t part) const override { return bounds_[part]; }
  EmitterPoint sample(uint32_t part, const Vec3f& reference, float u0, float u1) const override;
  float pdf(const Vec3f& reference, const SurfacePoint& point) const override {
    return shape_.pdf_from(reference, point);
  }

 private:
  AreaShape shape_;
  std::vector<EmitterBounds> bounds_;
};

}  // namespace freepath
