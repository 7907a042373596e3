// What instances of objects cost, as counts at N and 4 N: what is in an object is built once, and
// a ray looks at few of them.

#include <gtest/gtest.h>

#include <string>

#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

/// A grid of `side` x `side` unit squares, each of two triangles, scaled to the unit square.
std::string grid_mesh(int side) {
  std::string points;
  std::string indices;
  for (int y = 0; y <= side; ++y) {
    for (int x = 0; x <= side; ++x) {
      points += fmt::format("{} {} 0  ", double(x) / side, double(y) / side);
      if (x == side || y == side) continue;
      const int corner = y * (side + 1) + x;
      indices += fmt::format("{0} {1} {2} {1} {3} {2}  ", corner, corner + 1, corner + side + 1,
                             corner + side + 2);
    }
  }
  return R"(Shape "trianglemesh" "point3 P" [ )" + points + R"(] "integer indices" [ )" + indices +
         "]\n";
}

/// So many instances of a grid in a plane, two units apart, 32 in a row.
BuiltScene built_instances(int count, int side) {
  std::string text = "WorldBegin ObjectBegin \"grid\"\n" + grid_mesh(side) + "ObjectEnd\n";
  for (int i = 0; i < count; ++i) {
    text += fmt::format("AttributeBegin Translate {} {} 0 ObjectInstance \"grid\" AttributeEnd\n",
                        2 * (i % 32), 2 * (i / 32));
  }
  Diagnostics diagnostics;
  const PbrtScene pbrt = parse(text, diagnostics);
  return build_scene(pbrt, diagnostics);
}

TEST(InstanceCosts, OfBuildingFollowObjectsAndInstancesNotTheirProduct) {
  const auto costs = [](int count, int side) {
    return built_instances(count, side).scene.surfaces->costs();
  };
  const SurfaceCosts some = costs(100, 16);
  const SurfaceCosts more = costs(400, 16);
  EXPECT_GE(some.positions, 17U * 17U);
  EXPECT_EQ(more.positions, some.positions);
  EXPECT_LT(more.bytes, some.bytes + 300U * 4096U);
  // The same instances of what is 16 times as large: what they add has not grown.
  const SurfaceCosts some_large = costs(100, 64);
  const SurfaceCosts more_large = costs(400, 64);
  EXPECT_LT(some_large.positions, 17 * some.positions);
  EXPECT_EQ(more_large.positions, some_large.positions);
  EXPECT_LT(double(more_large.bytes) - double(some_large.bytes),
            1.2 * (double(more.bytes) - double(some.bytes)));
}

TEST(InstanceCosts, OfRaysDoNotGrowWithInstances) {
  const auto looked_at = [](int count) {
    const BuiltScene built = built_instances(count, 4);
    const Surfaces& surfaces = *built.scene.surfaces;
    uint64_t sum = 0;
    for (int i = 0; i < count; ++i) {
      const Vec3d from(2 * (i % 32) + 0.3, 2 * (i / 32) + 0.4, 5);
      const auto hit = surfaces.intersect(Vec3f(from - surfaces.origin()), Vec3f(0, 0, -1), 0,
                                          std::numeric_limits<float>::infinity(), &sum);
      EXPECT_TRUE(hit && hit->instance == static_cast<uint32_t>(i)) << i;
    }
    return double(sum) / count;
  };
  const double some = looked_at(256);
  EXPECT_GE(some, 1);
  EXPECT_LT(looked_at(1024), 1.1 * some);
}

}  // namespace
}  // namespace freepath::testing
