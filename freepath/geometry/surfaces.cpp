#include "freepath/geometry/surfaces.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/geometry/box_overlap.h"
#include "freepath/geometry/traced_part.h"

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

constexpr auto kByPosition = [](const auto& a, const auto& b) {
  return a.position.is_before(b.position);
};

}  // namespace

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

Surfaces::Surfaces(const SurfaceScene& scene, const Vec3d& origin)
    : data_(std::make_unique<const Data>(scene, origin)) {}
Surfaces::~Surfaces() = default;
Surfaces::Surfaces(Surfaces&&) noexcept = default;
Surfaces& Surfaces::operator=(Surfaces&&) noexcept = default;

const Vec3d& Surfaces::origin() const { return data_->origin; }

SurfaceCosts Surfaces::costs() const {
  SurfaceCosts costs{data_->world->looked_at, static_cast<uint64_t>(data_->embree_bytes)};
  for (const auto& group : data_->groups) costs.positions += group->looked_at;
  return costs;
}

std::vector<WholeSphere> Surfaces::whole_spheres() const {
  std::vector<WholeSphere> spheres;
  for (const TracedQuadric& traced : data_->world->quadrics) {
    const AffineTransform& map = traced.object_to_part;
    if (!traced.quadric.is_whole_sphere() || traced.is_reversed || !map.is_similarity()) continue;
    spheres.push_back({traced.shape, traced.first_primitive, map.translation,
                       traced.quadric.radius() * map.x.length()});
  }
  return spheres;
}

Box3f Surfaces::bounds() const {
  RTCBounds b;
  rtcGetSceneBounds(data_->scene.get(), &b);
  if (!(b.lower_x <= b.upper_x)) return {};
  return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

std::optional<SurfaceHit> Surfaces::intersect(const Vec3f& origin, const Vec3f& direction,
                                              float t_min, float t_max, uint64_t* looked_at) const {
  SurfaceQuery query = data_->query(QueryKind::kNearest, origin, direction, t_min, t_max);
  RTCRayHit found{};
  found.ray = Data::ray(origin, direction, t_min, t_max);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(data_->scene.get(), &query.context, &found);
  if (looked_at != nullptr) *looked_at += query.looked_at;
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  SurfaceHit hit = data_->describe(query.nearest, found.hit.u, found.hit.v, query.ray);
  hit.is_tied = query.is_tied;
  return hit;
}

void Surfaces::find_ties(const Vec3f& origin, const Vec3f& direction, const SurfaceHit& hit,
                         std::vector<TiedSurface>& ties) const {
  ties.clear();
  SurfaceQuery query = data_->query(QueryKind::kTies, origin, direction);
  query.around = &hit.position;
  query.ties = &ties;
  const auto met = data_->meet(hit.position.key, query.ray, hit.position.t);
  const double range =
      met ? data_->rule.search_range(query.ray, met->at, hit.position) : hit.position.reach;
  RTCRay ray =
      Data::ray(origin, direction, static_cast<float>(std::max(hit.position.t - range, 0.0)),
                static_cast<float>(hit.position.t + range));
  rtcOccluded1(data_->scene.get(), &query.context, &ray);
  std::sort(ties.begin(), ties.end(), kByPosition);
  std::size_t kept = 0;
  for (const TiedSurface& tied : ties) {
    const auto is_same = [&](uint32_t shape, uint32_t instance, bool enters) {
      return tied.shape == shape && tied.position.key.instance == instance && tied.enters == enters;
    };
    bool is_known = is_same(hit.point.shape, hit.instance, !hit.from_inside);
    for (std::size_t i = 0; i < kept && !is_known; ++i) {
      is_known = is_same(ties[i].shape, ties[i].position.key.instance, ties[i].enters);
    }
    if (!is_known) ties[kept++] = tied;
  }
  ties.resize(kept);
}

SurfaceHit Surfaces::describe(const Vec3f& origin, const Vec3f& direction,
                              const TiedSurface& tied) const {
  SurfaceHit hit =
      data_->describe(tied.position, tied.u, tied.v, {Vec3d(origin), Vec3d(direction)});
  hit.is_tied = true;
  return hit;
}

bool Surfaces::is_beyond(const RayPosition& position, const Vec3f& origin,
                         const Vec3f& direction) const {
  const auto met = data_->meet(position.key, {Vec3d(origin), Vec3d(direction)}, 0);
  return !met || !(met->at.t > 0);
}

bool Surfaces::occluded(const Vec3f& origin, const Vec3f& direction, const ShadowEnd& end,
                        BoundaryCrossings& crossings, const RayPosition* after) const {
  crossings.clear();
  SurfaceQuery query =
      data_->query(QueryKind::kOcclusion, origin, direction, 0, double{end.distance});
  data_->aim(query, end);
  query.after = after;
  query.crossings = &crossings;
  // Embree's range is in single precision; what is in the query's, the query decides.
  constexpr float kSinglePrecision = 1 + 0x1p-18F;
  RTCRay ray = Data::ray(origin, direction, 0, static_cast<float>(query.t_max) * kSinglePrecision);
  rtcOccluded1(data_->scene.get(), &query.context, &ray);
  return ray.tfar < 0;
}

bool Surfaces::is_end(const Vec3f& origin, const Vec3f& direction, const RayPosition& position,
                      const ShadowEnd& end) const {
  if (!end.target) return false;
  std::optional<SurfaceKey> target =
      data_->world->find_primitive(end.target->shape, end.target->primitive);
  if (!target) return false;
  const auto met = data_->meet(*target, {Vec3d(origin), Vec3d(direction)}, end.distance);
  if (!met) return false;
  target->root = met->root;
  return position.key == *target;
}

std::vector<BoundaryCrossing> Surfaces::all_crossings(const Vec3f& origin,
                                                      const Vec3f& direction) const {
  std::vector<BoundaryCrossing> all;
  SurfaceQuery query = data_->query(QueryKind::kAll, origin, direction);
  query.all = &all;
  RTCRay ray = Data::ray(origin, direction);
  rtcOccluded1(data_->scene.get(), &query.context, &ray);
  std::sort(all.begin(), all.end(), kByPosition);
  std::vector<BoundaryCrossing> each;
  for (const BoundaryCrossing& crossing : all) {
    bool is_known = false;
    for (auto at = each.rbegin(); at != each.rend() && at->position.is_tied(crossing.position);
         ++at) {
      is_known = is_known || at->is_same(crossing);
    }
    if (!is_known) each.push_back(crossing);
  }
  return each;
}

Vec3f Surfaces::offset_ray_origin(const SurfacePoint& point, const Vec3f& direction) const {
  // Half a rounding for the position, half a one for the new origin, and as much to spare.
  constexpr float kRoundings = 4 * 0x1p-24F;
  const Vec3f& n = point.normal;
  const Vec3f& p = point.position;
  const float error = std::abs(n.x * p.x) + std::abs(n.y * p.y) + std::abs(n.z * p.z);
  const std::vector<float>& smallest = data_->rule.smallest_offset;
  const float offset =
      kRoundings * error + (point.shape < smallest.size() ? smallest[point.shape] : 0);
  return p + n * (n.dot(direction) < 0 ? -offset : offset);
}

bool Surfaces::intersects_box(std::span<const uint32_t> shapes, const OrientedBox& exact) const {
  if (exact.box().isEmpty()) return false;
  // By more than floats round.
  const OrientedBox box = exact.grown_by(exact.farthest_coordinate(data_->origin) * 0x1p-22);
  const Matrix4d to_box = Matrix4d().setTranslation(data_->origin) * box.to_world().inverse();
  const AffineTransform from_scene(to_box), to_scene(to_box.inverse());
  const auto meets = [&](const TracedPart& part, const AffineTransform& part_to_world,
                         const AffineTransform& world_to_part) {
    return part_meets_box(part, part_to_world.then(from_scene), to_scene.then(world_to_part),
                          shapes, box.box());
  };
  if (meets(*data_->world, {}, {})) return true;
  return std::ranges::any_of(data_->rule.instances, [&](const TracedInstance& instance) {
    return meets(*data_->groups[instance.group], instance.part_to_world, instance.world_to_part);
  });
}

bool Surfaces::is_inside(const Vec3f& point, std::span<const uint32_t> shapes) const {
  int votes = 0;
  for (const Vec3f& direction : kProbes) {
    SurfaceQuery query = data_->query(QueryKind::kCount, point, direction);
    query.counted = shapes;
    RTCRay ray = Data::ray(point, direction);
    rtcOccluded1(data_->scene.get(), &query.context, &ray);
    votes += static_cast<int>(query.count % 2);
  }
  return votes >= 2;
}

}  // namespace freepath
