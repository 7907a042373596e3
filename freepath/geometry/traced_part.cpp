#include "freepath/geometry/traced_part.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "freepath/base/error.h"

namespace freepath {

namespace {

SurfaceQuery& query_of(RTCIntersectContext* context) {
  return *reinterpret_cast<SurfaceQuery*>(context);
}

// Rays come one at a time, so that a packet of them is just one.
const RTCHit& hit_of(const RTCFilterFunctionNArguments* args) {
  return *reinterpret_cast<const RTCHit*>(args->hit);
}

/// Adds a surface to what a query of several collects.
template <class Enters>
void collect(SurfaceQuery& query, const TracedShape& shape, const RayPosition& position, float u,
             float v, const Enters& enters) {
  if (query.kind == QueryKind::kAll) {
    query.all->push_back({position, shape.shape, enters()});
  } else if (position.key != query.around->key && position.is_tied(*query.around)) {
    query.ties->push_back({position, shape.shape, enters(), u, v});
  }
}

/// Whether an occlusion query ends at a surface; crossings are noted.
template <class Enters>
bool blocks(SurfaceQuery& query, const TracedShape& shape, const LinePoint& at,
            const SurfaceKey& key, const Enters& enters) {
  if (!shape.is_boundary) return at.t < query.t_block && key != query.target;
  const RayPosition position = query.rule->position(query.ray, at, key, shape.shape);
  if (query.after == nullptr || query.after->is_before(position)) {
    query.crossings->add({position, shape.shape, enters()});
  }
  return false;
}

/// Whether a surface is the nearest so far.
bool is_nearest(SurfaceQuery& query, const TracedShape& shape, const LinePoint& at,
                const SurfaceKey& key, float& t_far) {
  const RayPosition position = query.rule->position(query.ray, at, key, shape.shape);
  const bool is_tied = position.is_tied(query.nearest);
  if (!position.is_before(query.nearest)) {
    if (position.key != query.nearest.key) query.is_tied = query.is_tied || is_tied;
    return false;
  }
  query.is_tied = is_tied;
  query.nearest = position;
  // Shapes at the same position have to be offered, too.
  t_far = static_cast<float>(
      std::min(position.t + query.rule->search_range(query.ray, at, position), query.t_max));
  return true;
}

/// Takes a surface into account.
/// @param enters tells whether the ray goes to the inside there
/// @param t_far of the ray, which ends there for the time being
/// @return whether the ray is to end there
template <class Enters>
bool meet(SurfaceQuery& query, const TracedShape& shape, const LinePoint& at, const SurfaceKey& key,
          float u, float v, float& t_far, const Enters& enters) {
  ++query.looked_at;
  if (!(at.t > query.t_min && at.t < query.t_max)) return false;
  switch (query.kind) {
    case QueryKind::kNearest:
      return is_nearest(query, shape, at, key, t_far);
    case QueryKind::kOcclusion:
      return blocks(query, shape, at, key, enters);
    case QueryKind::kCount:
      if (std::find(query.counted.begin(), query.counted.end(), shape.shape) !=
          query.counted.end()) {
        ++query.count;
      }
      return false;
    case QueryKind::kTies:
    case QueryKind::kAll:
      collect(query, shape, query.rule->position(query.ray, at, key, shape.shape), u, v, enters);
      return false;
  }
  return false;
}

void filter_triangle(const RTCFilterFunctionNArguments* args) {
  SurfaceQuery& query = query_of(args->context);
  const RTCHit& hit = hit_of(args);
  const auto& mesh = *static_cast<const TracedTriangles*>(args->geometryUserPtr);
  const SurfaceKey key{query.instance_of(hit.instID[0]), hit.geomID, hit.primID, 0};
  const LocalRay local = query.rule->local_ray(query.ray, key.instance);
  const LinePoint at = mesh.meet_plane(hit.primID, local);
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  const auto enters = [&] {
    return mesh.normal(hit.primID, hit.u, hit.v).dot(local.direction) < 0;
  };
  if (!meet(query, mesh, at, key, hit.u, hit.v, ray.tfar, enters)) args->valid[0] = 0;
}

/// Of a primitive that Embree does not know: what lies on the ray, in ascending order.
struct UserHit {
  LinePoint at;
  uint32_t root;
  float u, v;
};

void offer(RTCRay& ray, RTCHit* hit, SurfaceQuery& query, const TracedShape& shape, SurfaceKey key,
           std::span<const UserHit> found) {
  for (const UserHit& candidate : found) {
    key.root = candidate.root;
    const auto enters = [&] { return candidate.at.across < 0; };
    float t_far = ray.tfar;
    if (!meet(query, shape, candidate.at, key, candidate.u, candidate.v, t_far, enters)) continue;
    if (query.kind != QueryKind::kNearest) {
      ray.tfar = -std::numeric_limits<float>::infinity();
      return;
    }
    ray.tfar = t_far;
    hit->u = candidate.u;
    hit->v = candidate.v;
    hit->geomID = key.geometry;
    hit->primID = key.primitive;
    hit->instID[0] = query.context.instID[0];
  }
}

struct UserHits {
  std::array<UserHit, 2> hits{};
  std::size_t count = 0;
  std::span<const UserHit> all() const { return {hits.data(), count}; }
};

/// Where on a ray it is worth while to look closer: what lies outside, no query takes.
struct RayRange {
  double begin = -std::numeric_limits<double>::infinity();
  double end = std::numeric_limits<double>::infinity();

  /// The part that a ray of Embree's has left; ties have their place in it.
  RayRange(const SurfaceQuery& query, const RTCRay& ray) : begin(query.t_min), end(query.t_max) {
    constexpr double kSinglePrecision = 1 + 0x1p-20;
    if (query.kind == QueryKind::kNearest) end = std::min(end, ray.tfar * kSinglePrecision);
  }
  RayRange() = default;
  bool contains(double t) const { return t > begin && t < end; }
};

UserHits hits_of(const TracedPatches& mesh, uint32_t primitive, const LocalRay& ray,
                 const RayRange& range = {}) {
  const PatchRoots roots = mesh.patch(primitive).intersect(ray.origin, ray.direction);
  UserHits found;
  for (int i = 0; i < roots.count; ++i) {
    const PatchRoot& root = roots.root[i];
    if (!range.contains(root.t)) continue;
    const Vec3d normal = mesh.normal(primitive, root.u, root.v);
    found.hits[found.count++] = {{root.t, normal, normal.dot(ray.direction)},
                                 static_cast<uint32_t>(i),
                                 static_cast<float>(root.u),
                                 static_cast<float>(root.v)};
  }
  return found;
}

UserHits hits_of(const TracedQuadric& quadric, const LocalRay& ray, const RayRange& range = {}) {
  const LocalRay object = quadric.to_object(ray);
  const QuadricRoots roots = quadric.quadric.intersect(object.origin, object.direction);
  UserHits found;
  for (int i = 0; i < roots.count; ++i) {
    if (!range.contains(roots.t[i])) continue;
    const Vec3d gradient = quadric.quadric.gradient(object.origin + object.direction * roots.t[i]);
    const Vec3d normal =
        quadric.part_to_object.normal_back(quadric.is_reversed ? -gradient : gradient);
    // A line goes in first and then out.
    const bool leaves = gradient.dot(object.direction) > 0;
    const bool has_inside = quadric.quadric.kind() != QuadricKind::kDisk;
    found.hits[found.count++] = {
        {roots.t[i], normal, normal.dot(ray.direction)}, has_inside && leaves ? 1U : 0U, 0, 0};
  }
  return found;
}

void meet_patch(RTCRay& ray, RTCHit* hit, SurfaceQuery& query, const void* user, unsigned geometry,
                unsigned primitive) {
  const auto& mesh = *static_cast<const TracedPatches*>(user);
  const SurfaceKey key{query.instance_of(query.context.instID[0]), geometry, primitive, 0};
  const LocalRay local = query.rule->local_ray(query.ray, key.instance);
  offer(ray, hit, query, mesh, key, hits_of(mesh, primitive, local, {query, ray}).all());
}

void meet_quadric(RTCRay& ray, RTCHit* hit, SurfaceQuery& query, const void* user,
                  unsigned geometry, unsigned primitive) {
  const TracedQuadric& quadric = (*static_cast<const std::vector<TracedQuadric>*>(user))[primitive];
  const SurfaceKey key{query.instance_of(query.context.instID[0]), geometry, primitive, 0};
  const LocalRay local = query.rule->local_ray(query.ray, key.instance);
  offer(ray, hit, query, quadric, key, hits_of(quadric, local, {query, ray}).all());
}

template <auto kMeet>
void intersect_callback(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  auto& ray_hit = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  kMeet(ray_hit.ray, &ray_hit.hit, query_of(args->context), args->geometryUserPtr, args->geomID,
        args->primID);
}

template <auto kMeet>
void occluded_callback(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  kMeet(*reinterpret_cast<RTCRay*>(args->ray), nullptr, query_of(args->context),
        args->geometryUserPtr, args->geomID, args->primID);
}

void bound_patch(const RTCBoundsFunctionArguments* args) {
  const BilinearPatch patch =
      static_cast<const TracedPatches*>(args->geometryUserPtr)->patch(args->primID);
  Box3d box;
  for (const Vec3d& corner : {patch.p00, patch.p10, patch.p01, patch.p11}) box.extendBy(corner);
  *args->bounds_o = rounded_outward(box);
}

void bound_quadric(const RTCBoundsFunctionArguments* args) {
  const auto& quadrics = *static_cast<const std::vector<TracedQuadric>*>(args->geometryUserPtr);
  *args->bounds_o = rounded_outward(quadrics[args->primID].bounds());
}

/// Geometry that belongs to the scene it is attached to.
void hand_over(RTCScene scene, RTCGeometry geometry, unsigned number) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, number);
  rtcReleaseGeometry(geometry);
}

template <auto kMeet>
RTCGeometry user_geometry(RTCDevice device, std::size_t count, const void* user,
                          RTCBoundsFunction bounds) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
  rtcSetGeometryUserData(geometry, const_cast<void*>(user));
  rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_callback<kMeet>);
  rtcSetGeometryOccludedFunction(geometry, occluded_callback<kMeet>);
  return geometry;
}

}  // namespace

void check_device(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) {
    fail("the memory does not suffice for what finds the surfaces; use smaller meshes");
  }
  fail("Embree reports error {} for the surfaces; a version 3 with filter functions is needed",
       static_cast<int>(error));
}

RTCBounds rounded_outward(const Box3d& box) {
  // Rays of instances reach the box rounded to floats, hence more than the nearest float.
  constexpr double kSlack = 0x1p-20;
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    largest = std::max({largest, std::abs(box.min[axis]), std::abs(box.max[axis])});
  }
  const Vec3f low(box.min - Vec3d(largest * kSlack));
  const Vec3f high(box.max + Vec3d(largest * kSlack));
  return {low.x, low.y, low.z, 0, high.x, high.y, high.z, 0};
}

RayPosition RayPositionRule::position(const LocalRay& world, const LinePoint& at,
                                      const SurfaceKey& key, uint32_t shape) const {
  // A new ray begins at most six roundings of the position off the surface: see
  // Surfaces::offset_ray_origin().
  constexpr double kRoundings = 8 * 0x1p-24;
  const Vec3d normal = world_normal(at.normal, key.instance);
  const Vec3d position = world.origin + world.direction * at.t;
  double error = 0;
  double length = 0;  // no less than the normal's
  for (int axis = 0; axis < 3; ++axis) {
    error += std::abs(normal[axis] * position[axis]);
    length += std::abs(normal[axis]);
  }
  const double reach = kRoundings * error + 2 * length * smallest_offset[shape];
  return {at.t, reach / std::abs(at.across), key};
}

double RayPositionRule::search_range(const LocalRay& world, const LinePoint& at,
                                     const RayPosition& position) const {
  constexpr double kSinglePrecision = 0x1p-20;
  const Vec3d normal = world_normal(at.normal, position.key.instance);
  double length = 0;
  double largest = extent;
  for (int axis = 0; axis < 3; ++axis) {
    length += std::abs(normal[axis]);
    largest = std::max(largest, std::abs(world.origin[axis]));
  }
  return position.reach + kSinglePrecision * largest * length / std::abs(at.across);
}

TracedPart::TracedPart(std::span<const SurfaceShape> shapes, const Vec3d& part_origin)
    : origin(part_origin) {
  for (const SurfaceShape& shape : shapes) {
    if (std::holds_alternative<TriangleMesh>(shape.geometry)) {
      triangles.push_back(trace_triangles(shape, origin));
    } else if (std::holds_alternative<BilinearMesh>(shape.geometry)) {
      patches.push_back(trace_patches(shape, origin));
    } else {
      quadrics.push_back(trace_quadric(shape, origin));
    }
  }
  uint32_t geometry = 0;
  const auto note = [&](const TracedShape& shape, uint32_t number, uint32_t first, uint32_t count) {
    primitives_.push_back({shape.shape, shape.first_primitive, number, first, count});
  };
  for (const TracedTriangles& mesh : triangles) note(mesh, geometry++, 0, mesh.count());
  for (const TracedPatches& mesh : patches) note(mesh, geometry++, 0, mesh.count());
  for (uint32_t i = 0; i < quadrics.size(); ++i) note(quadrics[i], geometry, i, 1);
  std::stable_sort(primitives_.begin(), primitives_.end(), [](const auto& a, const auto& b) {
    return std::pair(a.shape, a.from) < std::pair(b.shape, b.from);
  });
  for (TracedTriangles& mesh : triangles) mesh.box = mesh.bounds(looked_at);
  for (TracedPatches& mesh : patches) mesh.box = mesh.bounds(looked_at);
  for (TracedQuadric& quadric : quadrics) quadric.box = quadric.bounds();
}

void TracedPart::attach(RTCDevice device, RTCScene scene) const {
  unsigned number = 0;
  for (const TracedTriangles& mesh : triangles) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               mesh.positions.data(), 0, sizeof(Vec3f), mesh.positions.size() - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.indices.data(), 0, 3 * sizeof(uint32_t), mesh.count());
    rtcSetGeometryUserData(geometry, const_cast<TracedTriangles*>(&mesh));
    rtcSetGeometryIntersectFilterFunction(geometry, filter_triangle);
    rtcSetGeometryOccludedFilterFunction(geometry, filter_triangle);
    hand_over(scene, geometry, number++);
  }
  for (const TracedPatches& mesh : patches) {
    hand_over(scene, user_geometry<meet_patch>(device, mesh.count(), &mesh, bound_patch), number++);
  }
  if (!quadrics.empty()) {
    hand_over(scene, user_geometry<meet_quadric>(device, quadrics.size(), &quadrics, bound_quadric),
              number++);
  }
}

TracedPart::Found TracedPart::find(const SurfaceKey& key, float u, float v, double t,
                                   const LocalRay& ray) const {
  std::size_t number = key.geometry;
  if (number < triangles.size()) {
    const TracedTriangles& mesh = triangles[number];
    return {&mesh, mesh.describe(key.primitive, u, v, ray)};
  }
  number -= triangles.size();
  if (number < patches.size()) {
    const TracedPatches& mesh = patches[number];
    return {&mesh, mesh.describe(key.primitive, u, v)};
  }
  const TracedQuadric& quadric = quadrics[key.primitive];
  const LocalRay object = quadric.to_object(ray);
  return {&quadric, quadric.describe(object.origin + object.direction * t)};
}

std::optional<TracedPart::Met> TracedPart::meet(const SurfaceKey& key, const LocalRay& ray,
                                                double t) const {
  if (key.geometry < triangles.size()) {
    return Met{triangles[key.geometry].meet_plane(key.primitive, ray), 0};
  }
  const bool quadric = is_quadric(key.geometry);
  const UserHits found =
      quadric ? hits_of(quadrics[key.primitive], ray)
              : hits_of(patches[key.geometry - triangles.size()], key.primitive, ray);
  std::optional<Met> nearest;
  for (const UserHit& hit : found.all()) {
    if (quadric && key.root != kAnyRoot && hit.root != key.root) continue;
    if (!nearest || std::abs(hit.at.t - t) < std::abs(nearest->at.t - t)) {
      nearest = Met{hit.at, hit.root};
    }
  }
  return nearest;
}

std::optional<SurfaceKey> TracedPart::find_primitive(uint32_t shape, uint32_t primitive) const {
  const auto begins_after = [](const auto& at, const Primitives& primitives) {
    return at < std::pair(primitives.shape, primitives.from);
  };
  const auto found = std::upper_bound(primitives_.begin(), primitives_.end(),
                                      std::pair(shape, primitive), begins_after);
  if (found == primitives_.begin()) return std::nullopt;
  const Primitives& primitives = *(found - 1);
  const uint32_t number = primitive - primitives.from;
  if (primitives.shape != shape || number >= primitives.count) return std::nullopt;
  return SurfaceKey{kNoInstance, primitives.geometry, primitives.first + number, kAnyRoot};
}

}  // namespace freepath
