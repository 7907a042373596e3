#pragma once
/// @file The world without its instances, or one group: shapes and what finds them. Internal to
/// this folder.

#include <embree3/rtcore.h>

#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/render/surfaces/surfaces.h"
#include "freepath/render/surfaces/traced_shapes.h"

namespace freepath {

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DeviceHandle = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

/// @throws Error if the device has met one
void check_device(RTCDevice device);

/// Maps between an instance and the world relative to the origin of the rays.
struct TracedInstance {
  uint32_t group = 0;
  AffineMap part_to_world, world_to_part;
};

enum class QueryKind { kNearest, kOcclusion, kCount };

/// One ray on its way. The first member is what Embree knows of it, and hands to the callbacks.
struct SurfaceQuery {
  RTCIntersectContext context;
  QueryKind kind;
  LocalRay ray;  ///< In the world, relative to the origin of rays.
  double t_min;
  std::span<const TracedInstance> instances;
  unsigned first_instance;                 ///< Geometry number of the first instance.
  BoundaryCrossings* crossings = nullptr;  ///< For kOcclusion.
  std::span<const uint32_t> counted = {};  ///< For kCount: the shapes.
  uint32_t count = 0;

  /// The ray in the space of the geometry that a callback is about.
  LocalRay local_ray(unsigned instance_geometry) const {
    if (instance_geometry == RTC_INVALID_GEOMETRY_ID) return ray;
    const AffineMap& map = instances[instance_geometry - first_instance].world_to_part;
    return {map.point(ray.origin), map.vector(ray.direction)};
  }
  /// Notes a hit of an occlusion or counting query.
  /// @return whether it blocks the ray
  bool meet(const TracedShape& shape, double t, bool enters, unsigned instance_geometry);
};

/// Shapes of one space. Geometry numbers: one for each mesh of triangles, then one for each mesh of
/// patches, then one for all quadrics.
class TracedPart {
 public:
  /// @param origin of the space of the part
  TracedPart(std::span<const SurfaceShape> shapes, const Vec3d& origin);
  TracedPart(const TracedPart&) = delete;
  TracedPart& operator=(const TracedPart&) = delete;

  /// Adds all shapes to a scene that has nothing in it yet.
  void attach(RTCDevice device, RTCScene scene) const;
  bool is_quadric(unsigned geometry) const { return geometry >= triangles.size() + patches.size(); }
  unsigned geometry_count() const {
    return static_cast<unsigned>(triangles.size() + patches.size() + (quadrics.empty() ? 0 : 1));
  }

  /// What is at a hit: the shape, and the point in the space of the part.
  struct Found {
    const TracedShape* shape;
    LocalPoint point;
  };
  Found find(const RTCHit& hit, float t, const LocalRay& ray) const;

  Vec3d origin;
  std::vector<TracedTriangles> triangles;
  std::vector<TracedPatches> patches;
  std::vector<TracedQuadric> quadrics;
};

/// A box around shapes that is not cut off by its rounding to floats.
RTCBounds rounded_outward(const Box3d& box);

}  // namespace freepath
