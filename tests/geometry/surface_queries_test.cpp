#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/geometry/surfaces.h"
#include "tests/geometry/surface_rays.h"

namespace freepath::testing {

namespace {

SurfaceShape boundary(ShapeGeometry geometry, uint32_t number, const Vec3d& center = Vec3d(0)) {
  Matrix4d matrix;
  matrix.setTranslation(center);
  SurfaceShape shape = shape_of(std::move(geometry), matrix, number);
  shape.is_boundary = true;
  return shape;
}

BilinearMesh bent_patch() {
  BilinearMesh patch;
  patch.positions = {{-1, -1, 0}, {1, -1, 0.5}, {-1, 1, 0.5}, {1, 1, 0}};
  patch.indices = {0, 1, 2, 3};
  return patch;
}

TEST(Surfaces, MeshNormalsDecideTheSideAndReverseOrientationNegatesThem) {
  for (const bool mirrored : {false, true}) {
    for (const bool reversed : {false, true}) {
      RandomSurfaces random(11);
      TriangleMesh mesh = triangle_sphere(1, 12, true);
      // Turned over: only the normals still say where the outside is.
      for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        std::swap(mesh.indices[i], mesh.indices[i + 1]);
      }
      const Matrix4d object_to_world = random.transform(0.1, mirrored);
      SurfaceShape shape = shape_of(mesh, object_to_world);
      shape.reverse_orientation = reversed;
      const Surfaces surfaces = surfaces_of(shape);
      const Vec3f centre(Vec3d(0) * object_to_world);
      int hits = 0;
      for (int i = 0; i < 500; ++i) {
        const Vec3f direction(random.direction());
        const auto hit = surfaces.intersect(centre, direction, 0, kFar);
        ASSERT_TRUE(hit.has_value());
        ++hits;
        EXPECT_EQ(hit->from_inside, !reversed);
        EXPECT_GT(hit->point.shading_normal.dot(hit->point.normal), 0.9F);
        // Of the ellipsoid the normal is the gradient: the inverse transpose times the position.
        const Vec3d object = Vec3d(hit->point.position) * object_to_world.inverse();
        Vec3d gradient(0);
        const Matrix4d inverse = object_to_world.inverse();
        for (int row = 0; row < 3; ++row) {
          for (int column = 0; column < 3; ++column) {
            gradient[row] += inverse[row][column] * object[column];
          }
        }
        if (reversed) gradient = -gradient;
        EXPECT_GT(gradient.normalized().dot(Vec3d(hit->point.shading_normal)), 0.995);
      }
      EXPECT_EQ(hits, 500);
    }
  }
}

TEST(Surfaces, NearestOfManyShapesIsMet) {
  RandomSurfaces random(5);
  SurfaceScene scene;
  std::vector<Vec3d> centres;
  for (uint32_t i = 0; i < 60; ++i) {
    centres.push_back(random.in_box(5));
    Matrix4d object_to_world;
    object_to_world.setTranslation(centres.back());
    scene.shapes.push_back(shape_of(Sphere{0.6}, object_to_world, i));
  }
  const Surfaces surfaces(scene, Vec3d(0));
  for (int ray = 0; ray < 3000; ++ray) {
    const Vec3f from(random.in_box(8));
    const Vec3f direction(random.direction());
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3d& centre : centres) {
      const Vec3d to_centre = centre - Vec3d(from);
      // The direction is a unit vector but for its rounding.
      const double length2 = Vec3d(direction).length2();
      const double along = to_centre.dot(Vec3d(direction)) / length2;
      const double half2 = (0.36 - (to_centre.length2() - along * along * length2)) / length2;
      if (half2 <= 0) continue;
      for (const double t : {along - std::sqrt(half2), along + std::sqrt(half2)}) {
        if (t > 0) nearest = std::min(nearest, t);
      }
    }
    const auto hit = surfaces.intersect(from, direction, 0, kFar);
    BoundaryCrossings crossings;
    EXPECT_EQ(surfaces.occluded(from, direction, {kFar}, crossings), hit.has_value());
    if (std::isinf(nearest)) {
      EXPECT_FALSE(hit.has_value());
      continue;
    }
    ASSERT_TRUE(hit.has_value());
    EXPECT_NEAR(hit->t, nearest, 2e-5);
    EXPECT_FALSE(surfaces.occluded(from, direction, {hit->t * 0.999F}, crossings));
    EXPECT_TRUE(surfaces.occluded(from, direction, {hit->t * 1.001F}, crossings));
    EXPECT_FALSE(surfaces.intersect(from, direction, 0, hit->t * 0.999F).has_value());
  }
}

TEST(Surfaces, BoundariesDoNotBlockAndAreCrossedInOrder) {
  SurfaceScene scene;
  scene.shapes.push_back(boundary(cube(1), 1, {3, 0, 0}));
  scene.shapes.push_back(boundary(Sphere{0.5}, 2, {3, 0, 0}));
  scene.shapes.push_back(boundary(triangle_sphere(1, 20, false), 3, {8, 0, 0}));
  scene.shapes.push_back(boundary(bent_patch(), 5, {14, 0, 0}));
  scene.shapes.push_back(shape_of(Sphere{}, Matrix4d(), 4));  // behind the origin of the ray
  scene.shapes.back().object_to_world.setTranslation(Vec3d(-4, 0, 0));
  const Surfaces surfaces(scene, Vec3d(0));
  BoundaryCrossings crossings;
  // Through the diagonal that two triangles of each side of the cube share.
  ASSERT_FALSE(surfaces.occluded(Vec3f(0), Vec3f(2, 0, 0), {kFar}, crossings));
  ASSERT_FALSE(crossings.overflowed());
  const std::vector<std::pair<uint32_t, bool>> expected = {{1, true},  {2, true}, {2, false},
                                                           {1, false}, {3, true}, {3, false}};
  ASSERT_EQ(crossings.all().size(), expected.size());
  const float ts[] = {1, 1.25F, 1.75F, 2, 3.5F, 4.5F};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(crossings.all()[i].shape, expected[i].first);
    EXPECT_EQ(crossings.all()[i].enters, expected[i].second);
    EXPECT_NEAR(crossings.all()[i].position.t, ts[i], 0.02);
  }
  EXPECT_FALSE(surfaces.occluded(Vec3f(0), Vec3f(2, 0, 0), {1.5F}, crossings));
  EXPECT_EQ(crossings.all().size(), 2U);
  EXPECT_TRUE(surfaces.occluded(Vec3f(0), Vec3f(-1, 0, 0), {kFar}, crossings));
  EXPECT_TRUE(surfaces.occluded(Vec3f(20, 0, 0), Vec3f(-1, 0, 0), {kFar}, crossings));
}

TEST(Surfaces, CrossingsOfRandomRaysAlternateThroughClosedBoundaries) {
  SurfaceScene scene;
  scene.shapes.push_back(boundary(triangle_sphere(1, 40, true), 0));
  scene.shapes.push_back(boundary(cube(0.8), 1));
  const Surfaces surfaces(scene, Vec3d(0));
  RandomSurfaces random(21);
  for (int ray = 0; ray < 20000; ++ray) {
    const Vec3f from(random.direction() * 3.0);
    const Vec3f direction = Vec3f(random.in_box(1)) - from;
    BoundaryCrossings crossings;
    ASSERT_FALSE(surfaces.occluded(from, direction, {kFar}, crossings));
    std::array<bool, 2> inside{};
    double last = 0;
    for (const BoundaryCrossing& crossing : crossings.all()) {
      ASSERT_GE(crossing.position.t, last);
      last = crossing.position.t;
      ASSERT_EQ(crossing.enters, !inside[crossing.shape]);
      inside[crossing.shape] = crossing.enters;
    }
    ASSERT_FALSE(inside[0] || inside[1]);
  }
}

TEST(Surfaces, CrossingsOfCoincidentBoundariesAreEachOnce) {
  SurfaceScene scene;
  for (uint32_t i = 0; i < 3; ++i) scene.shapes.push_back(boundary(cube(1), i, {3, 0, 0}));
  const Surfaces surfaces(scene, Vec3d(0));
  BoundaryCrossings crossings;
  ASSERT_FALSE(surfaces.occluded(Vec3f(0), Vec3f(1, 0, 0), {kFar}, crossings));
  ASSERT_EQ(crossings.all().size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(crossings.all()[i].enters, i < 3);
}

TEST(Surfaces, MoreCrossingsThanThereIsRoomForKeepTheNearest) {
  SurfaceScene scene;
  for (uint32_t i = 0; i < 30; ++i) {
    scene.shapes.push_back(boundary(Sphere{0.4}, i, {0, 0, 30.0 - i}));
  }
  const Surfaces surfaces(scene, Vec3d(0));
  BoundaryCrossings crossings;
  ASSERT_FALSE(surfaces.occluded(Vec3f(0), Vec3f(0, 0, 1), {kFar}, crossings));
  EXPECT_TRUE(crossings.overflowed());
  ASSERT_EQ(crossings.all().size(), BoundaryCrossings::kCapacity);
  for (uint32_t i = 0; i < BoundaryCrossings::kCapacity; ++i) {
    const uint32_t centre = 1 + i / 2;
    EXPECT_NEAR(crossings.all()[i].position.t, centre + (i % 2 == 0 ? -0.4 : 0.4), 1e-5);
  }
}

TEST(Surfaces, AnInstanceIsMetAsTheSameShapeInItsPlace) {
  RandomSurfaces random(31);
  const std::vector<ShapeGeometry> geometries = {triangle_sphere(1, 10, true), cube(1), Sphere{},
                                                 Cylinder{}, bent_patch()};
  for (const ShapeGeometry& geometry : geometries) {
    for (const bool mirrored : {false, true}) {
      const Matrix4d in_group = random.transform(3000, false);
      Matrix4d back;
      back.setTranslation(-Vec3d(in_group[3][0], in_group[3][1], in_group[3][2]));
      SurfaceScene scene;
      scene.groups.emplace_back();
      scene.groups.push_back({shape_of(geometry, in_group, 9)});
      scene.instances.push_back({1, back * random.transform(2, mirrored)});
      const Matrix4d instance_to_world = scene.instances[0].instance_to_world;
      SurfaceShape direct = shape_of(geometry, in_group * instance_to_world, 9);
      // A mirror in an instance flips no side; in the shape it flips that of quadrics.
      const bool is_quadric = geometry.index() >= 2;
      direct.reverse_orientation = mirrored && is_quadric;
      const Surfaces instanced(scene, Vec3d(0));
      const Surfaces reference = surfaces_of(direct);
      int hits = 0;
      for (int ray = 0; ray < 2000; ++ray) {
        const Vec3f from(random.in_box(6));
        const Vec3d aim = random.in_box(1.2) * in_group * instance_to_world;
        const Vec3f direction = Vec3f(aim) - from;
        const auto a = instanced.intersect(from, direction, 0, kFar);
        const auto b = reference.intersect(from, direction, 0, kFar);
        if (!a || !b || std::abs(a->t - b->t) > 1e-4F) continue;  // the rim
        ++hits;
        EXPECT_EQ(a->instance, 0U);
        EXPECT_EQ(a->point.shape, 9U);
        EXPECT_EQ(a->point.primitive, b->point.primitive);
        EXPECT_LT((a->point.position - b->point.position).length(), 2e-5F);
        EXPECT_LT((a->point.dpdu - b->point.dpdu).length(), 1e-3F * (1 + b->point.dpdu.length()));
        EXPECT_GT(a->point.normal.dot(b->point.normal), 0.9999F);
        EXPECT_GT(a->point.shading_normal.dot(b->point.shading_normal), 0.9999F);
        EXPECT_EQ(a->from_inside, b->from_inside);
      }
      EXPECT_GT(hits, 500);
      // What leaves it does not meet it again at once.
      for (int ray = 0; ray < 5000; ++ray) {
        const Vec3f from(random.in_box(6));
        const Vec3d aim = random.in_box(1.2) * in_group * instance_to_world;
        const auto hit = instanced.intersect(from, Vec3f(aim) - from, 0, kFar);
        if (!hit) continue;
        const Vec3f onward(random.direction());
        const auto next =
            instanced.intersect(instanced.offset_ray_origin(hit->point, onward), onward, 0, kFar);
        if (next) {
          EXPECT_GT(next->t, 1e-4F);
        }
      }
    }
  }
}

TEST(Surfaces, ARayThatLeavesAMeshDoesNotMeetItAgain) {
  for (const double scale : {1e-3, 1.0, 1e4}) {
    // A convex body: from outside nothing of it can be met.
    RandomSurfaces random(41);
    Matrix4d object_to_world;
    object_to_world.setTranslation(Vec3d(0.7, -0.4, 0.3) * scale);
    const Surfaces surfaces =
        surfaces_of(shape_of(triangle_sphere(scale, 30, false), object_to_world));
    int again = 0;
    for (int ray = 0; ray < 100000; ++ray) {
      const Vec3f from(random.in_box(3 * scale));
      const Vec3d aim = random.in_box(0.5 * scale) + Vec3d(0.7, -0.4, 0.3) * scale;
      const auto hit = surfaces.intersect(from, Vec3f(aim) - from, 0, kFar);
      ASSERT_TRUE(hit.has_value());
      Vec3f onward(random.direction());
      if (onward.dot(hit->point.normal) < 0) onward = -onward;
      // Within a rounding of the direction a ray leaves no side of the plane.
      if (onward.dot(hit->point.normal) < 1e-6F) continue;
      const Vec3f start = surfaces.offset_ray_origin(hit->point, onward);
      if (surfaces.intersect(start, onward, 0, kFar)) ++again;
      BoundaryCrossings crossings;
      if (surfaces.occluded(start, onward, {kFar}, crossings)) ++again;
      // The offset is a few roundings of the position.
      ASSERT_LT((start - hit->point.position).length(), 3e-6 * scale);
    }
    EXPECT_EQ(again, 0) << "at scale " << scale;
  }
}

TEST(Surfaces, AHugeTriangleAndAFarRayKeepTheirDigits) {
  TriangleMesh ground;
  ground.positions = {{-1e5, -1e5, 0}, {1e5, -1e5, 0}, {1e5, 1e5, 0}, {-1e5, 1e5, 0}};
  ground.indices = {0, 1, 2, 0, 2, 3};
  Matrix4d turn;
  turn.setEulerAngles(Vec3d(0.3, 0.5, 0.2));
  const Surfaces surfaces = surfaces_of(shape_of(ground, turn));
  RandomSurfaces random(43);
  for (int ray = 0; ray < 20000; ++ray) {
    const Vec3f from(random.direction() * 1e4);
    const auto hit = surfaces.intersect(from, Vec3f(random.in_box(5)) - from, 0, kFar);
    if (!hit) continue;
    Vec3f onward(random.direction());
    if (std::abs(onward.dot(hit->point.normal)) < 1e-6F) continue;
    const Vec3f start = surfaces.offset_ray_origin(hit->point, onward);
    ASSERT_FALSE(surfaces.intersect(start, onward, 0, kFar).has_value());
    ASSERT_LT((start - hit->point.position).length(), 1e-6F * (1 + from.length()) * 10);
  }
}

TEST(Surfaces, BoxesAreMetWhereTheSurfaceIsAndNotWithinOrOutside) {
  const Vec3d origin(100, 200, 300);
  SurfaceScene scene;
  Matrix4d object_to_world;
  object_to_world.setTranslation(origin);
  scene.shapes.push_back(shape_of(triangle_sphere(1, 24, false), object_to_world, 0));
  scene.shapes.push_back(shape_of(Sphere{1}, object_to_world, 1));
  scene.shapes.push_back(shape_of(Cylinder{1, -1, 1}, object_to_world, 2));
  scene.shapes.push_back(shape_of(Disk{0, 1, 0.5}, object_to_world, 3));
  scene.shapes.push_back(shape_of(bent_patch(), object_to_world, 4));
  scene.groups.push_back({shape_of(triangle_sphere(1, 24, false), Matrix4d(), 5)});
  Matrix4d instance;
  instance.setTranslation(origin + Vec3d(10, 0, 0));
  scene.instances.push_back({0, instance});
  const Surfaces surfaces(scene, origin + Vec3d(1, 1, 1));
  const auto meets = [&](uint32_t shape, const Vec3d& centre, double half) {
    const std::array<uint32_t, 1> shapes = {shape};
    return surfaces.intersects_box(
        shapes, OrientedBox(Box3d(origin + centre - Vec3d(half), origin + centre + Vec3d(half))));
  };
  for (const uint32_t round : {0U, 1U}) {
    EXPECT_FALSE(meets(round, Vec3d(0), 0.5));
    EXPECT_FALSE(meets(round, {2, 0, 0}, 0.5));
    EXPECT_FALSE(meets(round, {0.9, 0.9, 0.9}, 0.2));
    EXPECT_TRUE(meets(round, {1, 0, 0}, 0.1));
    EXPECT_TRUE(meets(round, Vec3d(0), 0.7));
    EXPECT_TRUE(meets(round, Vec3d(0), 3));
  }
  EXPECT_FALSE(meets(2, Vec3d(0), 0.6));
  EXPECT_FALSE(meets(2, {1, 0, 2}, 0.5));
  EXPECT_TRUE(meets(2, {1, 0, 0.5}, 0.1));
  EXPECT_FALSE(meets(3, Vec3d(0), 0.3));
  EXPECT_FALSE(meets(3, {0.7, 0, 0.5}, 0.3));
  EXPECT_TRUE(meets(3, {0.7, 0, 0}, 0.1));
  EXPECT_TRUE(meets(4, {0, 0, 0.25}, 0.1));
  EXPECT_FALSE(meets(4, {0, 0, 2}, 0.5));
  EXPECT_FALSE(meets(5, Vec3d(0), 2));
  EXPECT_TRUE(meets(5, {11, 0, 0}, 0.1));
  EXPECT_FALSE(meets(5, {10, 0, 0}, 0.5));
  // A box that is turned by 45 degrees about z has its edges, not its faces, on the axes.
  const auto turned_meets = [&](uint32_t shape, const Vec3d& centre, double half) {
    const Matrix4d turn = Matrix4d().setAxisAngle(Vec3d(0, 0, 1), std::numbers::pi / 4);
    const OrientedBox box({Vec3d(-half), Vec3d(half)},
                          turn * Matrix4d().setTranslation(origin + centre));
    return surfaces.intersects_box(std::array{shape}, box);
  };
  for (const uint32_t round : {0U, 1U}) {
    EXPECT_FALSE(meets(round, {1.45, 0, 0}, 0.4));
    EXPECT_TRUE(turned_meets(round, {1.45, 0, 0}, 0.4));
    EXPECT_FALSE(turned_meets(round, {1.6, 0, 0}, 0.4));
  }
  // On the diagonal it is the other way round; a sphere errs towards yes.
  EXPECT_TRUE(meets(0, {1.05, 1.05, 0}, 0.4));
  EXPECT_FALSE(turned_meets(0, {1.05, 1.05, 0}, 0.4));
  EXPECT_TRUE(turned_meets(5, {10 + 1.45, 0, 0}, 0.4));
  EXPECT_FALSE(turned_meets(5, {10, 0, 0}, 0.5));
}

TEST(Surfaces, InsideIsEnclosedWhicheverWayTheNormalsPoint) {
  SurfaceScene scene;
  Matrix4d object_to_world;
  object_to_world.setTranslation(Vec3d(5, 0, 0));
  scene.shapes.push_back(shape_of(cube(1), Matrix4d(), 0));
  scene.shapes.push_back(shape_of(Sphere{2}, object_to_world, 1));
  scene.shapes.back().reverse_orientation = true;
  // A can of three shapes.
  object_to_world.setTranslation(Vec3d(0, 8, 0));
  scene.shapes.push_back(shape_of(Cylinder{}, object_to_world, 2));
  scene.shapes.push_back(shape_of(Disk{-1}, object_to_world, 3));
  scene.shapes.push_back(shape_of(Disk{1}, object_to_world, 4));
  const Surfaces surfaces(scene, Vec3d(0));
  RandomSurfaces random(51);
  const std::array<uint32_t, 1> box = {0};
  const std::array<uint32_t, 1> sphere = {1};
  const std::array<uint32_t, 3> can = {2, 3, 4};
  for (int i = 0; i < 5000; ++i) {
    const Vec3f p(random.in_box(10));
    EXPECT_EQ(surfaces.is_inside(p, box),
              std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 1);
    EXPECT_EQ(surfaces.is_inside(p, sphere), (p - Vec3f(5, 0, 0)).length() < 2);
    EXPECT_EQ(surfaces.is_inside(p, can), std::abs(p.z) < 1 && std::hypot(p.x, p.y - 8) < 1);
  }
}

TEST(Surfaces, NothingIsMetWhereThereIsNothing) {
  const Surfaces surfaces(SurfaceScene{}, Vec3d(0));
  BoundaryCrossings crossings;
  EXPECT_FALSE(surfaces.intersect(Vec3f(0), Vec3f(1, 0, 0), 0, kFar).has_value());
  EXPECT_FALSE(surfaces.occluded(Vec3f(0), Vec3f(1, 0, 0), {kFar}, crossings));
  EXPECT_TRUE(crossings.empty());
  EXPECT_TRUE(surfaces.bounds().isEmpty());
}

TEST(Surfaces, BoundsAreRelativeToTheOrigin) {
  Matrix4d object_to_world;
  object_to_world.setTranslation(Vec3d(1000, 0, 0));
  const Box3f box = surfaces_of(shape_of(cube(1), object_to_world), {999, 0, 0}).bounds();
  EXPECT_EQ(box.min, Vec3f(0, -1, -1));
  EXPECT_EQ(box.max, Vec3f(2, 1, 1));
}

}  // namespace

}  // namespace freepath::testing
