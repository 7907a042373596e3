#pragma once
/// @file The frame that lobes work in.

#include "freepath/base/tangent_frame.h"
#include "freepath/base/vector.h"
#include "freepath/geometry/surface_point.h"

namespace freepath {

/// z is the shading normal, x lies along dpdu.
class SurfaceFrame {
 public:
  /// @param travel direction before; the geometric normal replaces a shading normal that has it
  /// come from the other side
  SurfaceFrame(const SurfacePoint& point, const Vec3f& travel)
      : geometric_(point.normal), frame_(point.normal) {
    const bool agree = point.shading_normal.dot(travel) * point.normal.dot(travel) > 0;
    const Vec3f normal = agree ? point.shading_normal : point.normal;
    const Vec3f along = point.dpdu - normal * normal.dot(point.dpdu);
    const float length2 = along.length2();
    if (length2 > 1e-6F * point.dpdu.length2()) {
      frame_.normal = normal;
      frame_.tangent = along * (1.0F / std::sqrt(length2));
      frame_.bitangent = normal.cross(frame_.tangent);
    } else {
      frame_ = TangentFrame(normal);
    }
  }

  Vec3f to_local(const Vec3f& world) const { return frame_.to_local(world); }
  Vec3f to_world(const Vec3f& local) const {
    return frame_.to_world(local.x, local.y, local.z).normalized();
  }

  /// Whether the direction lies on the side of the surface that its local form says.
  bool on_side(const Vec3f& local, const Vec3f& world) const {
    return local.z * geometric_.dot(world) > 0;
  }
  /// Whether two directions of travel cross the surface.
  bool crosses(const Vec3f& travel, const Vec3f& next) const {
    return geometric_.dot(travel) * geometric_.dot(next) > 0;
  }

 private:
  Vec3f geometric_;
  TangentFrame frame_;
};

}  // namespace freepath
