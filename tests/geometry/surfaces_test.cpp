#include "freepath/geometry/surfaces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/geometry/surface_rays.h"
#include "tests/geometry/surface_references.h"

namespace freepath::testing {

namespace {

class EveryShape : public ::testing::TestWithParam<std::tuple<int, bool, bool>> {
 protected:
  ShapeReference reference() const { return references()[std::get<0>(GetParam())]; }
  bool is_mirrored() const { return std::get<1>(GetParam()); }
  bool is_reversed() const { return std::get<2>(GetParam()); }
};

std::string shape_name(const ::testing::TestParamInfo<std::tuple<int, bool, bool>>& info) {
  static const char* const kNames[] = {"Sphere",   "PartialSphere", "Disk",  "Ring",
                                       "Cylinder", "PartialTube",   "Patch", "Triangle"};
  return std::string(kNames[std::get<0>(info.param)]) +
         (std::get<1>(info.param) ? "Mirrored" : "") + (std::get<2>(info.param) ? "Reversed" : "");
}

INSTANTIATE_TEST_SUITE_P(Surfaces, EveryShape,
                         ::testing::Combine(::testing::Range(0, 8), ::testing::Bool(),
                                            ::testing::Bool()),
                         shape_name);

TEST_P(EveryShape, IsMetWhereItIsParameterisedWithTheDerivativeAndTheSideOfPbrt) {
  RandomSurfaces random(7 + std::get<0>(GetParam()));
  const ShapeReference shape = reference();
  int hits = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Vec3d origin = random.in_box(100);
    Matrix4d object_to_world = random.transform(2, is_mirrored());
    Matrix4d move;
    move.setTranslation(origin);
    object_to_world = object_to_world * move;  // the shape is near the origin of the rays
    SurfaceShape description = shape_of(shape.geometry, object_to_world, 3);
    description.reverse_orientation = is_reversed();
    const Surfaces surfaces = surfaces_of(description, origin);
    const auto world_at = [&](double u, double v) {
      return shape.at(shape.geometry, u, v) * object_to_world - origin;
    };
    for (int ray = 0; ray < 200; ++ray) {
      const Vec3f from(random.in_box(6));
      const Vec3d aim = random.in_box(1) * object_to_world - origin;
      const Vec3f direction((aim - Vec3d(from)).normalized() * random.uniform(0.3, 3));
      const auto hit = surfaces.intersect(from, direction, 0, kFar);
      if (!hit) continue;
      ++hits;
      const SurfacePoint& point = hit->point;
      EXPECT_EQ(point.shape, 3U);
      EXPECT_EQ(point.primitive, 0U);
      EXPECT_EQ(hit->instance, kNoInstance);
      EXPECT_LT((from + direction * hit->t - point.position).length(), 1e-5F);
      const double u = point.u;
      const double v = point.v;
      EXPECT_LT((world_at(u, v) - Vec3d(point.position)).length(), 3e-5);
      constexpr double kStep = 1e-4;
      const Vec3d dpdu = (world_at(u + kStep, v) - world_at(u - kStep, v)) / (2 * kStep);
      const Vec3d dpdv = (world_at(u, v + kStep) - world_at(u, v - kStep)) / (2 * kStep);
      EXPECT_LT((dpdu - Vec3d(point.dpdu)).length(), 1e-3 * (1 + dpdu.length()));
      // In the world the cross product changes its side with a mirror, in the object space of
      // quadrics it does not.
      const Vec3d across = dpdu.cross(dpdv);
      if (across.length() < 1e-3) continue;
      const bool is_quadric = std::get<0>(GetParam()) < 6;
      bool flip = is_reversed() != is_mirrored();
      if (is_quadric) flip = flip != is_mirrored();
      const Vec3d normal = (flip ? -across : across).normalized();
      EXPECT_GT(normal.dot(Vec3d(point.normal)), 1 - 1e-4);
      EXPECT_EQ(point.normal, point.shading_normal);
      EXPECT_EQ(hit->from_inside, normal.dot(Vec3d(direction)) > 0);
    }
  }
  EXPECT_GT(hits, 200);
}

TEST_P(EveryShape, IsMetByEveryRayToAPointOfIt) {
  RandomSurfaces random(70 + std::get<0>(GetParam()));
  const ShapeReference shape = reference();
  const Matrix4d object_to_world = random.transform(2, is_mirrored());
  const Surfaces surfaces = surfaces_of(shape_of(shape.geometry, object_to_world));
  for (int ray = 0; ray < 2000; ++ray) {
    double u = random.uniform(0.01, 0.99);
    double v = random.uniform(0.01, 0.99);
    if (std::holds_alternative<TriangleMesh>(shape.geometry) && v > u) std::swap(u, v);
    const Vec3d target = shape.at(shape.geometry, u, v) * object_to_world;
    const Vec3f from(target + random.direction() * random.uniform(0.1, 5));
    const Vec3f direction = Vec3f(target) - from;
    // A ray that grazes it meets it elsewhere, or misses the point by its rounding.
    constexpr double kStep = 1e-4;
    const auto moved = [&](double du, double dv) {
      return shape.at(shape.geometry, u + du, v + dv) * object_to_world - target;
    };
    const Vec3d normal = moved(kStep, 0).cross(moved(0, kStep)).normalized();
    if (std::abs(normal.dot(Vec3d(direction.normalized()))) < 0.1) continue;
    const auto hit = surfaces.intersect(from, direction, 0, kFar);
    ASSERT_TRUE(hit.has_value()) << "towards " << target;
    EXPECT_LT(hit->t, 1 + 1e-3F);
    if (hit->t < 1 - 1e-3F) continue;  // another part is nearer
    EXPECT_NEAR(hit->point.u, u, 2e-3);
    EXPECT_NEAR(hit->point.v, v, 2e-3);
  }
}

TEST_P(EveryShape, IsNotMetAgainByARayThatLeavesIt) {
  const ShapeReference shape = reference();
  for (const double scale : {1e-3, 1.0, 1e4}) {
    RandomSurfaces random(700 + std::get<0>(GetParam()));
    Matrix4d size;
    size.setScale(scale);
    const Matrix4d object_to_world = random.transform(1, is_mirrored()) * size;
    const Surfaces surfaces = surfaces_of(shape_of(shape.geometry, object_to_world));
    int again = 0;
    int left = 0;
    for (int ray = 0; ray < 40000; ++ray) {
      const Vec3f from(random.in_box(4 * scale));
      const Vec3d aim = random.in_box(1) * object_to_world;
      const auto hit = surfaces.intersect(from, Vec3f((aim - Vec3d(from)).normalized()), 0, kFar);
      if (!hit) continue;
      const Vec3f onward(random.direction());
      const Vec3f start = surfaces.offset_ray_origin(hit->point, onward);
      const auto next = surfaces.intersect(start, onward, 0, kFar);
      ++left;
      // Flat shapes are never met again, round ones not at the same place.
      if (next && next->t < 1e-4 * scale) ++again;
    }
    EXPECT_GT(left, 2000);
    EXPECT_EQ(again, 0) << "at scale " << scale;
  }
}

}  // namespace

}  // namespace freepath::testing
