// Light that a sphere refracts, against Snell's law, differences, and rays that go the other way.

#include "freepath/geometry/refracting_sphere.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/geometry/surface_rays.h"

namespace freepath::testing {
namespace {

constexpr double kIndices[] = {1.5, 1.05, 2.2, 0.7};

/// Where a ray from inside leaves a sphere, and its direction from there on.
struct Leaving {
  Vec3d position, direction;
};

std::optional<Leaving> leave(const RefractingSphere& sphere, const Vec3d& from,
                             const Vec3d& direction) {
  const Vec3d p = from - sphere.center();
  const double along = p.dot(direction);
  const double t =
      -along + std::sqrt(along * along - p.length2() + sphere.radius() * sphere.radius());
  const Vec3d position = from + direction * t;
  const Vec3d normal = (position - sphere.center()).normalized();
  const double cosine = direction.dot(normal);
  const double rest = 1 - sphere.eta() * sphere.eta() * (1 - cosine * cosine);
  if (rest < 0) return std::nullopt;
  return Leaving{position, (direction - normal * cosine) * sphere.eta() + normal * std::sqrt(rest)};
}

RefractingSphere random_sphere(RandomSurfaces& random, double eta) {
  return {random.in_box(3), random.uniform(0.5, 2), eta};
}

Vec3d random_inside(RandomSurfaces& random, const RefractingSphere& sphere) {
  const double radius = sphere.radius() * std::cbrt(random.uniform(0, 0.999));
  return sphere.center() + random.direction() * radius;
}

TEST(RefractingSphere, LightEntersByTheLawOfSnell) {
  RandomSurfaces random(1);
  for (const double eta : kIndices) {
    int found = 0;
    for (int i = 0; i < 2000; ++i) {
      const RefractingSphere sphere = random_sphere(random, eta);
      const Vec3d inside = random_inside(random, sphere);
      const Vec3d outside =
          sphere.center() + random.direction() * (sphere.radius() * random.uniform(1.01, 6));
      const auto entry = sphere.find(inside, outside);
      if (!entry) continue;
      ++found;
      const Vec3d towards = (entry->position - inside).normalized();
      const auto left = leave(sphere, inside, towards);
      ASSERT_TRUE(left);
      EXPECT_LT((left->position - entry->position).length(), 1e-6);
      EXPECT_LT((left->direction - (outside - entry->position).normalized()).length(), 1e-5);
      EXPECT_NEAR(entry->cosine, towards.dot(entry->normal), 1e-7);
    }
    EXPECT_GT(found, 500) << eta;
  }
}

TEST(RefractingSphere, SpreadIsThatOfNeighbouringRays) {
  RandomSurfaces random(2);
  for (const double eta : {1.0, 1.5, 1.05, 2.2, 0.7}) {
    for (int i = 0; i < 500; ++i) {
      const RefractingSphere sphere = random_sphere(random, eta);
      const Vec3d inside = random_inside(random, sphere);
      const Vec3d outside =
          sphere.center() + random.direction() * (sphere.radius() * random.uniform(1.1, 6));
      const auto entry = sphere.find(inside, outside);
      if (!entry) continue;
      const Vec3d towards = (entry->position - inside).normalized();
      const Vec3d along = (outside - entry->position).normalized();
      const Vec3d u = towards.cross(random.direction()).normalized();
      const Vec3d v = towards.cross(u);
      // Where rays meet the plane through the point outside, across the one that ends there.
      const auto met = [&](const Vec3d& aside) -> std::optional<Vec3d> {
        const auto left = leave(sphere, inside, (towards + aside).normalized());
        if (!left) return std::nullopt;
        const double t = (outside - left->position).dot(along) / left->direction.dot(along);
        return left->position + left->direction * t;
      };
      constexpr double kStep = 1e-5;
      const auto a = met(u * kStep), b = met(u * -kStep), c = met(v * kStep), d = met(v * -kStep);
      if (!a || !b || !c || !d) continue;
      const double area = std::abs((*a - *b).cross(*c - *d).dot(along)) / (4 * kStep * kStep);
      // Where reflection is nearly total neighbours are no measure.
      const double sine2 = eta * eta * (1 - entry->cosine * entry->cosine);
      if (sine2 > 0.98) continue;
      EXPECT_NEAR(entry->spread / area, 1, 2e-3) << eta;
      if (eta == 1) {
        EXPECT_NEAR(entry->spread / (outside - inside).length2(), 1, 1e-6);
      }
    }
  }
}

// What one of both ways to find light takes for the other's would be counted twice or never.
TEST(RefractingSphere, RaysThatLeaveKnowWhetherTheirWayIsFound) {
  RandomSurfaces random(3);
  for (const double eta : kIndices) {
    int known = 0;
    int unknown = 0;
    for (int i = 0; i < 20'000; ++i) {
      const RefractingSphere sphere = random_sphere(random, eta);
      const Vec3d inside = random_inside(random, sphere);
      const auto left = leave(sphere, inside, random.direction());
      if (!left) continue;
      const Vec3d outside =
          left->position + left->direction * (sphere.radius() * random.uniform(0.01, 5));
      const auto at = sphere.at(inside, outside, left->position);
      const auto found = sphere.find(inside, outside);
      const bool is_same = found && (found->position - left->position).length() < 1e-4;
      EXPECT_EQ(at.has_value(), is_same) << eta << ", ray " << i;
      at ? ++known : ++unknown;
      if (at && is_same && found->cosine > 0.05) {
        EXPECT_NEAR(at->spread / found->spread, 1, 1e-2);
      }
    }
    EXPECT_GT(known, 1000);
    if (eta > 1.4) {
      EXPECT_GT(unknown, 20);
    }
  }
}

TEST(RefractingSphere, CenterAndAxisAreNoExceptions) {
  const RefractingSphere sphere(Vec3d(1, 2, 3), 2, 1.5);
  const auto of_center = sphere.find(Vec3d(1, 2, 3), Vec3d(1, 2, 9));
  ASSERT_TRUE(of_center);
  EXPECT_LT((of_center->position - Vec3d(1, 2, 5)).length(), 1e-9);
  // Rays from the centre are not refracted: their spread is that of the distance.
  EXPECT_NEAR(of_center->spread, 36, 1e-6);
  for (const double z : {4.0, 2.0}) {
    const auto on_axis = sphere.find(Vec3d(1, 2, z), Vec3d(1, 2, 9));
    ASSERT_TRUE(on_axis) << z;
    EXPECT_LT((on_axis->position - Vec3d(1, 2, 5)).length(), 1e-6) << z;
    // Of a spherical surface, near the axis: height outside over angle inside.
    const double depth = 5 - z;
    const double height = depth + 4 * (1.5 - 0.5 * depth / 2);
    EXPECT_NEAR(on_axis->spread, height * height, 1e-4 * height * height) << z;
  }
}

}  // namespace
}  // namespace freepath::testing
