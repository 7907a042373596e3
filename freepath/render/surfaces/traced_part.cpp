#include "freepath/render/surfaces/traced_part.h"

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

/// Refuses hits of triangles that are not there in double precision.
void filter_nearest(const RTCFilterFunctionNArguments* args) {
  const SurfaceQuery& query = query_of(args->context);
  const RTCHit& hit = hit_of(args);
  const auto& mesh = *static_cast<const TracedTriangles*>(args->geometryUserPtr);
  const double t = mesh.distance(hit.primID, query.local_ray(hit.instID[0]));
  if (!(t > query.t_min)) args->valid[0] = 0;
}

/// Notes boundaries and lets the ray go on.
void filter_occlusion(const RTCFilterFunctionNArguments* args) {
  SurfaceQuery& query = query_of(args->context);
  const RTCHit& hit = hit_of(args);
  const auto& mesh = *static_cast<const TracedTriangles*>(args->geometryUserPtr);
  const LocalRay ray = query.local_ray(hit.instID[0]);
  const double t = mesh.distance(hit.primID, ray);
  if (!(t > query.t_min)) {
    args->valid[0] = 0;
    return;
  }
  const bool enters = mesh.normal(hit.primID, hit.u, hit.v).dot(ray.direction) < 0;
  if (!query.meet(mesh, t, enters, hit.instID[0])) args->valid[0] = 0;
}

struct UserHit {
  double t;
  float u, v;
};

/// Of each hit in the range of the ray: keeps the nearest, or notes it.
/// @param normal_at gives the outward normal of a hit, in the space of `ray`
template <class NormalAt>
void offer(RTCRay& ray, RTCHit* hit, SurfaceQuery& query, const TracedShape& shape,
           unsigned geometry, unsigned primitive, std::span<const UserHit> found,
           const LocalRay& local, NormalAt normal_at) {
  for (const UserHit& candidate : found) {
    if (!(candidate.t > query.t_min && candidate.t < ray.tfar)) continue;
    if (query.kind == QueryKind::kNearest) {
      ray.tfar = static_cast<float>(candidate.t);
      hit->u = candidate.u;
      hit->v = candidate.v;
      hit->geomID = geometry;
      hit->primID = primitive;
      hit->instID[0] = query.context.instID[0];
      return;  // they come in order
    }
    const bool enters = normal_at(candidate).dot(local.direction) < 0;
    if (query.meet(shape, candidate.t, enters, query.context.instID[0])) {
      ray.tfar = -std::numeric_limits<float>::infinity();
      return;
    }
  }
}

void meet_patch(RTCRay& ray, RTCHit* hit, SurfaceQuery& query, const void* user, unsigned geometry,
                unsigned primitive) {
  const auto& mesh = *static_cast<const TracedPatches*>(user);
  const LocalRay local = query.local_ray(query.context.instID[0]);
  const PatchRoots roots = mesh.patch(primitive).intersect(local.origin, local.direction);
  std::array<UserHit, 2> found{};
  for (int i = 0; i < roots.count; ++i) {
    found[i] = {roots.root[i].t, static_cast<float>(roots.root[i].u),
                static_cast<float>(roots.root[i].v)};
  }
  offer(ray, hit, query, mesh, geometry, primitive,
        {found.data(), static_cast<std::size_t>(roots.count)}, local,
        [&](const UserHit& at) { return mesh.normal(primitive, at.u, at.v); });
}

void meet_quadric(RTCRay& ray, RTCHit* hit, SurfaceQuery& query, const void* user,
                  unsigned geometry, unsigned primitive) {
  const TracedQuadric& quadric = (*static_cast<const std::vector<TracedQuadric>*>(user))[primitive];
  const LocalRay local = query.local_ray(query.context.instID[0]);
  const LocalRay object = quadric.to_object(local);
  const QuadricRoots roots = quadric.quadric.intersect(object.origin, object.direction);
  std::array<UserHit, 2> found{};
  for (int i = 0; i < roots.count; ++i) found[i] = {roots.t[i], 0, 0};
  offer(ray, hit, query, quadric, geometry, primitive,
        {found.data(), static_cast<std::size_t>(roots.count)}, local, [&](const UserHit& at) {
          return quadric.describe(object.origin + object.direction * at.t).normal;
        });
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

bool SurfaceQuery::meet(const TracedShape& shape, double t, bool enters,
                        unsigned instance_geometry) {
  if (kind == QueryKind::kCount) {
    if (std::find(counted.begin(), counted.end(), shape.shape) != counted.end()) ++count;
    return false;
  }
  if (!shape.is_boundary) return true;
  const uint32_t instance = instance_geometry == RTC_INVALID_GEOMETRY_ID
                                ? kNoInstance
                                : instance_geometry - first_instance;
  crossings->add({static_cast<float>(t), shape.shape, instance, enters});
  return false;
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
    rtcSetGeometryIntersectFilterFunction(geometry, filter_nearest);
    rtcSetGeometryOccludedFilterFunction(geometry, filter_occlusion);
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

TracedPart::Found TracedPart::find(const RTCHit& hit, float t, const LocalRay& ray) const {
  std::size_t number = hit.geomID;
  if (number < triangles.size()) {
    const TracedTriangles& mesh = triangles[number];
    return {&mesh, mesh.describe(hit.primID, hit.u, hit.v, ray)};
  }
  number -= triangles.size();
  if (number < patches.size()) {
    const TracedPatches& mesh = patches[number];
    return {&mesh, mesh.describe(hit.primID, hit.u, hit.v)};
  }
  // The t of the hit has lost digits; the root next to it has them.
  const TracedQuadric& quadric = quadrics[hit.primID];
  const LocalRay object = quadric.to_object(ray);
  const QuadricRoots roots = quadric.quadric.intersect(object.origin, object.direction);
  double nearest = roots.t[0];
  if (roots.count == 2 && std::abs(roots.t[1] - t) < std::abs(nearest - t)) nearest = roots.t[1];
  return {&quadric, quadric.describe(object.origin + object.direction * nearest)};
}

}  // namespace freepath
