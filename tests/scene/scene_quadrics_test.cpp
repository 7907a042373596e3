// Shapes that are cut, seen as lights from afar: their areas, and where they are.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/scene/twin_scenes.h"

namespace freepath::testing {
namespace {

/// Parallel rays over a square of edge 2.
/// @param side what is looked along: x, y or z
std::string seen_along(char side, const std::string& shape, const std::string& light) {
  const char* const look = side == 'x'   ? "LookAt -9 0 0  0 0 0  0 0 1\n"
                           : side == 'y' ? "LookAt 0 -9 0  0 0 0  0 0 1\n"
                                         : "LookAt 0 0 -9  0 0 0  0 1 0\n";
  return "Integrator \"volpath\"\n" + film() + look +
         "Camera \"orthographic\"\nWorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
         R"(AreaLightSource "diffuse" "bool twosided" true )" +
         light + "\nShape " + shape;
}

/// @param area of the silhouette
void expect_area(char side, const std::string& shape, double area) {
  const double share = area / 4;
  expect_mean(fmt::format("{} along {}", shape, side),
              render_text(seen_along(side, shape, R"("rgb L" [ 1 1 1 ])"), {.samples = 1024}),
              {share, share, share}, {.absolute = 1e-4 * share, .largest_relative_error = 0.0035});
}

/// @param area of the surface, of which the power is the radiance times 2 pi (both sides)
void expect_radiance_of_power(char side, const std::string& shape, double silhouette, double area) {
  const double mean = 10 / (2 * std::numbers::pi * area) * silhouette / 4;
  expect_mean("power of " + shape,
              render_text(seen_along(side, shape, "\"float power\" 10"), {.samples = 1024}),
              {mean, mean, mean}, {.absolute = 1e-4 * mean, .largest_relative_error = 0.0035});
}

TEST(SceneQuadric, PartsOfADisk) {
  const std::string disk =
      R"("disk" "float radius" .9 "float innerradius" .4 "float phimax" 270 "float height" .3)";
  const double area = std::numbers::pi * (0.81 - 0.16) * 0.75;
  expect_area('z', disk, area);
  expect_radiance_of_power('z', disk, area, area);
}

// A quarter of the mantle: x and y are positive.
TEST(SceneQuadric, PartsOfACylinder) {
  const std::string cylinder =
      R"("cylinder" "float radius" .8 "float zmin" -.2 "float zmax" .7 "float phimax" 90)";
  expect_area('y', cylinder, 0.8 * 0.9);
  expect_area('x', cylinder, 0.8 * 0.9);
  expect_area('y', R"("cylinder" "float radius" .8 "float zmin" -.2 "float zmax" .7)", 1.6 * 0.9);
  expect_radiance_of_power('y', cylinder, 0.8 * 0.9, 0.5 * std::numbers::pi * 0.8 * 0.9);
}

TEST(SceneQuadric, PartsOfASphere) {
  // Seen along z: the ring between the radii at z = 0.2 and z = 0.7.
  const std::string zone = R"("sphere" "float radius" .9 "float zmin" .2 "float zmax" .7)";
  expect_area('z', zone, std::numbers::pi * (0.49 - 0.04));
  const std::string half = R"("sphere" "float radius" .9 "float phimax" 180)";
  expect_area('z', half, std::numbers::pi * 0.81 / 2);
  expect_area('y', half, std::numbers::pi * 0.81);
  expect_area('x', half, std::numbers::pi * 0.81 / 2);
  expect_radiance_of_power('z', zone, std::numbers::pi * (0.49 - 0.04),
                           2 * std::numbers::pi * 0.9 * 0.5);
}

/// A surface of parameters from 0 to 1 as triangles.
template <class PointAt>
std::string mesh_of(const PointAt& point_at, int columns, int rows) {
  std::string points;
  std::string indices;
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const Vec3d p = point_at(double(column) / columns, double(row) / rows);
      points += fmt::format("{} {} {} ", p.x, p.y, p.z);
      if (row == rows || column == columns) continue;
      const int a = row * (columns + 1) + column;
      const int b = a + columns + 1;
      indices += fmt::format("{} {} {} {} {} {} ", a, a + 1, b, b, a + 1, b + 1);
    }
  }
  return R"(Shape "trianglemesh" "point3 P" [ )" + points + R"(] "integer indices" [ )" + indices +
         "]\n";
}

// 256 edges around cut off 2e-4 of the radius at most.
TEST(SceneQuadric, CutOnesAreNearlyMeshes) {
  const auto around = [](double u, double turns, double radius, double z) {
    const double phi = 2 * std::numbers::pi * turns * u;
    return Vec3d(radius * std::cos(phi), radius * std::sin(phi), z);
  };
  const auto expect_same = [&](const std::string& quadric, const std::string& mesh) {
    const std::string begin = R"(AttributeBegin Material "diffuse" "rgb reflectance" [ .8 .4 .2 ] )"
                              "Rotate 40 1 1 0 ";
    expect_twins(quadric, stage(begin + "Shape " + quadric + " AttributeEnd\n"),
                 stage(begin + mesh + "AttributeEnd\n"), 128,
                 {.absolute = 5e-4, .largest_relative_error = 0.01});
  };
  expect_same(
      R"("cylinder" "float radius" .8 "float zmin" -.2 "float zmax" .9 "float phimax" 200)",
      mesh_of([&](double u, double v) { return around(u, 200 / 360.0, 0.8, -0.2 + 1.1 * v); }, 256,
              1));
  expect_same(
      R"("disk" "float radius" 1.1 "float innerradius" .5 "float height" .2)",
      mesh_of([&](double u, double v) { return around(u, 1, 1.1 - 0.6 * v, 0.2); }, 256, 1));
  expect_same(R"("sphere" "float zmin" -.5 "float zmax" .8 "float phimax" 300)",
              mesh_of(
                  [&](double u, double v) {
                    const double theta = std::acos(-0.5) + v * (std::acos(0.8) - std::acos(-0.5));
                    return around(u, 300 / 360.0, std::sin(theta), std::cos(theta));
                  },
                  256, 96));
}

// Where no texture looks at them they take arcs for nothing.
TEST(SceneQuadric, HaveTextureCoordinatesWhereSomethingLooksAtThem) {
  const auto seen_v = [](const std::string& before) {
    Diagnostics diagnostics;
    const BuiltScene built =
        build_scene(parse(film() + "Camera \"perspective\"\nWorldBegin\n" + before +
                              "Translate 0 0 4 Shape \"sphere\" \"float radius\" 1\n",
                          diagnostics),
                    diagnostics);
    const Vec3f origin(Vec3d(0.3, 0.2, 0) - built.scene.origin);
    const auto hit = built.scene.surfaces->intersect(origin, {0, 0, 1}, 0, 100);
    EXPECT_TRUE(hit);
    EXPECT_NEAR(hit->point.normal.z, -std::sqrt(1 - 0.13), 1e-6);
    EXPECT_GT(hit->point.dpdu.length(), 0);
    return hit->point.v;
  };
  EXPECT_EQ(seen_v(""), 0);
  const float v = seen_v(R"(Texture "t" "float" "constant" "float value" 1 )"
                         "\n");
  // From the lower pole, of which the ray meets the surroundings.
  EXPECT_NEAR(v, 1 - std::acos(-std::sqrt(1 - 0.13)) / std::numbers::pi, 1e-5);
}

}  // namespace
}  // namespace freepath::testing
