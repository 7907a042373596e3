#pragma once
/// @file What Surfaces are made of: parts as Embree traces them. For surfaces.cpp alone.

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "freepath/geometry/surfaces.h"
#include "freepath/geometry/traced_part.h"

namespace freepath {

class Surfaces::Data {
 public:
  Data(const SurfaceScene& scene, const Vec3d& ray_origin);

  SurfaceQuery query(QueryKind kind, const Vec3f& origin, const Vec3f& direction, float t_min = 0,
                     double t_max = std::numeric_limits<double>::infinity()) const;
  static RTCRay ray(const Vec3f& origin, const Vec3f& direction, float t_min = 0,
                    float t_max = std::numeric_limits<float>::infinity());
  SurfaceHit describe(const RayPosition& position, float u, float v, const LocalRay& ray) const;
  const TracedPart& part_of(const SurfaceKey& key) const {
    return key.instance == kNoInstance ? *world : *groups[rule.instances[key.instance].group];
  }
  std::optional<TracedPart::Met> meet(const SurfaceKey& key, const LocalRay& ray, double t) const {
    return part_of(key).meet(key, rule.local_ray(ray, key.instance), t);
  }
  /// Sets where an occlusion query ends for what blocks.
  void aim(SurfaceQuery& query, const ShadowEnd& end) const;

  Vec3d origin;
  std::atomic<int64_t> embree_bytes = 0;  // outlives the device, which counts them
  DeviceHandle device;
  // Parts stay where they are: the scenes refer to their insides. They outlive the scenes.
  std::unique_ptr<const TracedPart> world;
  std::vector<std::unique_ptr<const TracedPart>> groups;
  RayPositionRule rule;
  std::vector<SceneHandle> group_scenes;
  SceneHandle scene;

 private:
  void add_instances(const SurfaceScene& scene);
  void note_offsets(const TracedPart& part, const AffineTransform& to_world);
  void note_offset(const TracedShape& shape, const AffineTransform& to_world);
  SceneHandle new_scene() const;
};

}  // namespace freepath
