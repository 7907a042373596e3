#include "freepath/geometry/surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "freepath/geometry/box_overlap.h"
#include "freepath/geometry/surfaces_data.h"

namespace freepath {
namespace {

constexpr auto kByPosition = [](const auto& a, const auto& b) {
  return a.position.is_before(b.position);
};

}  // namespace

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
