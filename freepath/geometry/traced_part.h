#pragma once
/// @file The world without its instances, or one group: shapes and what finds them. Internal to
/// this folder.

#include <embree3/rtcore.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/geometry/surfaces.h"
#include "freepath/geometry/traced_shapes.h"

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
  AffineTransform part_to_world, world_to_part;
};

enum class QueryKind { kNearest, kOcclusion, kCount, kTies, kAll };

/// Sizes and directions of a scene that the positions of all its rays depend on.
struct RayPositionRule {
  std::vector<TracedInstance> instances;
  std::vector<float> smallest_offset;  ///< Indexed by SurfaceShape::shape.
  double extent = 0;                   ///< Largest coordinate of anything [world, from the origin].

  /// @param at,key of a point where the ray meets a surface of the shape
  RayPosition position(const LocalRay& world, const LinePoint& at, const SurfaceKey& key,
                       uint32_t shape) const;
  /// Distance from its position within which single precision may find a surface that faces the
  /// same way [t].
  double search_range(const LocalRay& world, const LinePoint& at,
                      const RayPosition& position) const;
  /// The ray in the space of what a key is of.
  LocalRay local_ray(const LocalRay& world, uint32_t instance) const {
    if (instance == kNoInstance) return world;
    const AffineTransform& map = instances[instance].world_to_part;
    return {map.point(world.origin), map.vector(world.direction)};
  }

 private:
  Vec3d world_normal(const Vec3d& normal, uint32_t instance) const {
    return instance == kNoInstance ? normal : instances[instance].world_to_part.normal_back(normal);
  }
};

/// One ray on its way. The first member is what Embree knows of it, and hands to the callbacks.
struct SurfaceQuery {
  SurfaceQuery(QueryKind query_kind, const LocalRay& world_ray) : kind(query_kind), ray(world_ray) {
    rtcInitIntersectContext(&context);
  }

  RTCIntersectContext context;
  QueryKind kind;
  LocalRay ray;  ///< The ray in the world, relative to the origin of rays.
  double t_min = 0, t_max = 0;
  const RayPositionRule* rule = nullptr;
  unsigned first_instance = 0;  ///< Geometry number of the first instance.

  /// Hit that kNearest has found.
  RayPosition nearest = {std::numeric_limits<double>::infinity(), 0, {}};
  bool is_tied = false;

  double t_block = 0;                     ///< For kOcclusion: only what is nearer blocks,
  std::optional<SurfaceKey> target = {};  ///< and never this.
  const RayPosition* after = nullptr;     ///< Crossings up to there are left out.
  BoundaryCrossings* crossings = nullptr;

  const RayPosition* around = nullptr;  ///< What kTies looks for the ties of.
  std::vector<TiedSurface>* ties = nullptr;
  std::vector<BoundaryCrossing>* all = nullptr;  ///< What kAll collects.
  std::span<const uint32_t> counted = {};        ///< The shapes that kCount counts.
  uint32_t count = 0;
  uint64_t looked_at = 0;  ///< Surfaces, whatever became of them.

  uint32_t instance_of(unsigned instance_geometry) const {
    return instance_geometry == RTC_INVALID_GEOMETRY_ID ? kNoInstance
                                                        : instance_geometry - first_instance;
  }
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
  /// @param u,v of the primitive
  /// @param t of the ray, which is in the space of the part
  Found find(const SurfaceKey& key, float u, float v, double t, const LocalRay& ray) const;

  struct Met {
    LinePoint at;
    uint32_t root = 0;
  };
  /// Where the line of a ray meets the key's root of a primitive; of patches, or of kAnyRoot, the
  /// one nearest to t.
  /// @return nothing where it misses a curved one; triangles count as their planes
  std::optional<Met> meet(const SurfaceKey& key, const LocalRay& ray, double t) const;
  /// The key of a primitive of a shape, of kAnyRoot, if it is here.
  std::optional<SurfaceKey> find_primitive(uint32_t shape, uint32_t primitive) const;

  static constexpr uint32_t kAnyRoot = 0xFFFFFFFF;

  Vec3d origin;
  std::vector<TracedTriangles> triangles;
  std::vector<TracedPatches> patches;
  std::vector<TracedQuadric> quadrics;
  uint64_t looked_at = 0;  ///< Positions of meshes, for their boxes.

 private:
  /// The primitives of a shape from a number on.
  struct Primitives {
    uint32_t shape, from;
    uint32_t geometry, first, count;
  };

  std::vector<Primitives> primitives_;  // by shape and number
};

/// A box around shapes that is not cut off by its rounding to floats.
RTCBounds rounded_outward(const Box3d& box);

}  // namespace freepath
