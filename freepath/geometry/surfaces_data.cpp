#include "freepath/geometry/surfaces_data.h"

#include <cmath>
#include <utility>

#include "freepath/base/error.h"

namespace freepath {
namespace {

Vec3d middle(std::span<const SurfaceShape> shapes) {
  const TracedPart part(shapes, Vec3d(0));
  Box3d box;
  for (const auto& mesh : part.triangles) box.extendBy(mesh.box);
  for (const auto& mesh : part.patches) box.extendBy(mesh.box);
  for (const auto& quadric : part.quadrics) box.extendBy(quadric.box);
  return box.isEmpty() ? Vec3d(0) : box.center();
}

void check_all(std::span<const SurfaceShape> shapes) {
  for (const SurfaceShape& shape : shapes) {
    try {
      check(shape);
    } catch (const Error& error) {
      fail("shape {}: {}", shape.shape, error.what());
    }
  }
}

/// Told by Embree before it takes or after it gives back memory; lets it.
bool count_bytes(void* total, ssize_t bytes, bool /*post*/) {
  *static_cast<std::atomic<int64_t>*>(total) += bytes;
  return true;
}

}  // namespace

SceneHandle Surfaces::Data::new_scene() const {
  SceneHandle made(rtcNewScene(device.get()));
  rtcSetSceneFlags(made.get(), RTC_SCENE_FLAG_ROBUST);
  return made;
}

Surfaces::Data::Data(const SurfaceScene& description, const Vec3d& ray_origin)
    : origin(ray_origin), device(rtcNewDevice(nullptr)) {
  if (!device) check_device(nullptr);
  rtcSetDeviceMemoryMonitorFunction(device.get(), count_bytes, &embree_bytes);
  check_all(description.shapes);
  for (const auto& group : description.groups) check_all(group);
  world = std::make_unique<TracedPart>(description.shapes, origin);
  scene = new_scene();
  world->attach(device.get(), scene.get());
  note_offsets(*world, AffineTransform());
  for (const auto& group : description.groups) {
    groups.push_back(std::make_unique<TracedPart>(group, middle(group)));
    group_scenes.push_back(new_scene());
    groups.back()->attach(device.get(), group_scenes.back().get());
    rtcCommitScene(group_scenes.back().get());
  }
  add_instances(description);
  rtcCommitScene(scene.get());
  check_device(device.get());
}

void Surfaces::Data::add_instances(const SurfaceScene& description) {
  unsigned number = world->geometry_count();
  for (const SurfaceInstance& instance : description.instances) {
    if (instance.group >= groups.size()) {
      fail("instance {} is of group {}, but there are only {} groups", rule.instances.size(),
           instance.group, groups.size());
    }
    Matrix4d from_middle, to_origin;
    from_middle.setTranslation(groups[instance.group]->origin);
    to_origin.setTranslation(-origin);
    const Matrix4d matrix = from_middle * instance.instance_to_world * to_origin;
    if (!(std::abs(matrix.determinant()) > 0)) {
      fail("the transform of instance {} has no inverse; scale by nothing but 0",
           rule.instances.size());
    }
    rule.instances.push_back(
        {instance.group, AffineTransform(matrix), AffineTransform(matrix.inverse())});
    const AffineTransform& map = rule.instances.back().part_to_world;
    note_offsets(*groups[instance.group], map);
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, group_scenes[instance.group].get());
    std::array<float, 12> columns{};
    const std::array<Vec3d, 4> rows = {map.x, map.y, map.z, map.translation};
    for (int i = 0; i < 12; ++i) columns[i] = static_cast<float>(rows[i / 3][i % 3]);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene.get(), geometry, number++);
    rtcReleaseGeometry(geometry);
  }
}

void Surfaces::Data::note_offsets(const TracedPart& part, const AffineTransform& to_world) {
  for (const auto& mesh : part.triangles) note_offset(mesh, to_world);
  for (const auto& mesh : part.patches) note_offset(mesh, to_world);
  for (const auto& quadric : part.quadrics) note_offset(quadric, to_world);
}

void Surfaces::Data::note_offset(const TracedShape& shape, const AffineTransform& to_world) {
  constexpr double kRoundings = 0x1p-42;  // many roundings of doubles of this size
  double largest = std::max({std::abs(to_world.translation.x), std::abs(to_world.translation.y),
                             std::abs(to_world.translation.z)});
  for (const Vec3d& corner : corners_of(shape.box)) {
    const Vec3d p = to_world.point(corner);
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  rule.extent = std::max(rule.extent, largest);
  std::vector<float>& offsets = rule.smallest_offset;
  if (shape.shape >= offsets.size()) offsets.resize(shape.shape + std::size_t{1});
  float& offset = offsets[shape.shape];
  offset = std::max(offset, static_cast<float>(largest * kRoundings));
}

SurfaceQuery Surfaces::Data::query(QueryKind kind, const Vec3f& ray_origin, const Vec3f& direction,
                                   float t_min, double t_max) const {
  SurfaceQuery query(kind, {Vec3d(ray_origin), Vec3d(direction)});
  query.t_min = t_min;
  query.t_max = t_max;
  query.rule = &rule;
  query.first_instance = world->geometry_count();
  return query;
}

RTCRay Surfaces::Data::ray(const Vec3f& ray_origin, const Vec3f& direction, float t_min,
                           float t_max) {
  RTCRay ray{};
  ray.org_x = ray_origin.x;
  ray.org_y = ray_origin.y;
  ray.org_z = ray_origin.z;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tnear = t_min;
  ray.tfar = t_max;
  ray.mask = ~0U;
  return ray;
}

SurfaceHit Surfaces::Data::describe(const RayPosition& position, float u, float v,
                                    const LocalRay& ray) const {
  SurfaceHit hit;
  hit.position = position;
  hit.instance = position.key.instance;
  const TracedPart& part = part_of(position.key);
  TracedPart::Found at =
      part.find(position.key, u, v, position.t, rule.local_ray(ray, position.key.instance));
  if (hit.instance != kNoInstance) {
    const TracedInstance& instance = rule.instances[hit.instance];
    at.point.position = instance.part_to_world.point(at.point.position);
    at.point.normal = instance.world_to_part.normal_back(at.point.normal);
    at.point.shading_normal = instance.world_to_part.normal_back(at.point.shading_normal);
    at.point.dpdu = instance.part_to_world.vector(at.point.dpdu);
  }
  const LocalPoint& p = at.point;
  const double across = p.normal.dot(ray.direction);
  hit.from_inside = across > 0;
  hit.t =
      static_cast<float>((p.position - ray.origin).dot(ray.direction) / ray.direction.length2());
  hit.point.position = Vec3f(p.position);
  hit.point.normal = Vec3f(p.normal.normalized());
  const bool flip = p.shading_normal.dot(p.normal) < 0;
  hit.point.shading_normal = Vec3f((flip ? -p.shading_normal : p.shading_normal).normalized());
  hit.point.dpdu = Vec3f(p.dpdu);
  hit.point.u = p.uv.x;
  hit.point.v = p.uv.y;
  hit.point.shape = at.shape->shape;
  const bool is_quadric = part.is_quadric(position.key.geometry);
  hit.point.primitive = at.shape->first_primitive + (is_quadric ? 0 : position.key.primitive);
  return hit;
}

void Surfaces::Data::aim(SurfaceQuery& query, const ShadowEnd& end) const {
  query.t_block = query.t_max;
  if (!end.target) return;
  query.target = world->find_primitive(end.target->shape, end.target->primitive);
  if (!query.target) return;
  const auto met = meet(*query.target, query.ray, end.distance);
  if (!met || !(met->at.t > 0) || !std::isfinite(met->at.t)) return;
  query.target->root = met->root;
  query.t_max = met->at.t;
  query.t_block =
      met->at.t - rule.position(query.ray, met->at, *query.target, end.target->shape).reach;
}

}  // namespace freepath
