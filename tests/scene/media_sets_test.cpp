// Media that overlap, touch and share boundaries, against closed forms and twins.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/random.h"
#include "freepath/paths/media_set.h"
#include "tests/scene/media_bodies.h"
#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

/// Sums over scenes, so that a small common error shows.
struct Pool {
  double difference = 0;
  double variance = 0;
  double expected = 0;

  void add(const Picture& picture, double mean) {
    expect_sound(picture);
    difference += picture.mean[0] - mean;
    variance += picture.error[0] * picture.error[0];
    expected += mean;
    EXPECT_LT(std::abs(picture.mean[0] - mean), 5 * picture.error[0] + 2e-5) << "expected " << mean;
  }
  ::testing::AssertionResult agrees() const {
    const double error = std::sqrt(variance);
    const bool is_near = std::abs(difference) < 4 * error + 1e-5 * expected;
    const bool is_sharp = error < 0.0025 * expected;  // 1 % would be seen
    if (is_near && is_sharp) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure()
           << "off by " << difference << " +- " << error << " of " << expected;
  }
};

// From all sides and in all orders of statements, also where the frame is turned, so that rounding
// tears apart what coincides.
TEST(MediaSets, RandomBodiesAbsorbAsTheirUnion) {
  Pool pool;
  for (uint32_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Arrangement arrangement(seed);
    const Vec3d direction = arrangement.in_box(1).normalized();
    const Vec3d origin = arrangement.in_box(0.8) - direction * (seed % 4 == 3 ? 0 : 7);
    const double expected = std::exp(-arrangement.depth(origin, direction, 0, 1e9));
    arrangement.shuffle();
    const double turn = seed % 2 == 0 ? 0 : 37;
    pool.add(render_text(
                 joined({kUnlimited, film(8), look(origin, origin + direction), turned(-turn), kRay,
                         kSurround, arrangement.media(), turned(turn), arrangement.bodies()}),
                 {.samples = 192, .seed = seed + 1}),
             expected);
  }
  EXPECT_TRUE(pool.agrees());
}

// A small diffuse square beneath the bodies, lit through them by a lamp among or above them.
TEST(MediaSets, ShadowRaysThroughRandomBodies) {
  Pool pool;
  for (uint32_t seed = 100; seed < 116; ++seed) {
    SCOPED_TRACE(seed);
    Arrangement arrangement(seed);
    const bool is_near = seed % 2 == 0;
    Vec3d lamp = arrangement.in_box(1);
    if (!is_near) lamp.z += 6;
    const Vec3d point(0.13, -0.27, -3);
    const Vec3d towards = lamp - point;
    const double distance = towards.length();
    const double depth = arrangement.depth(point, towards / distance, 0, distance);
    const double irradiance = 100 * towards.z / std::pow(distance, 3);
    arrangement.shuffle();
    pool.add(
        render_text("Integrator \"volpath\" \"integer maxdepth\" 1\n" + film(8) +
                        "LookAt 0.13 -0.27 -2.9  0.13 -0.27 -3  0 1 0\n" + kRay +
                        fmt::format("LightSource \"point\" \"rgb I\" [ 100 100 100 ] \"point3 "
                                    "from\" [ {:.17g} {:.17g} {:.17g} ]\n",
                                    lamp.x, lamp.y, lamp.z) +
                        R"(AttributeBegin Material "diffuse" "rgb reflectance" [ .5 .5 .5 ] )"
                        R"(Shape "bilinearmesh" "point3 P" [ -1 -1 -3  1 -1 -3  -1 1 -3  1 1 -3 ])"
                        " AttributeEnd\n" +
                        arrangement.media() + arrangement.bodies(),
                    {.samples = 192, .seed = seed}),
        irradiance * 0.5 / 3.14159265358979 * std::exp(-depth));
  }
  EXPECT_TRUE(pool.agrees());
}

// Three touching layers, from the front and the back.
TEST(MediaSets, LayersFromBothSides) {
  for (const double side : {-5.0, 5.0}) {
    for (const bool reversed : {false, true}) {
      std::vector<std::string> layers = {medium_box("m0", Vec3d(-1, -1, 0), Vec3d(1, 1, 1)),
                                         medium_box("m1", Vec3d(-1, -1, 1), Vec3d(1, 1, 2)),
                                         medium_box("m0", Vec3d(-1, -1, 2), Vec3d(1, 1, 3))};
      if (reversed) std::reverse(layers.begin(), layers.end());
      const double expected = std::exp(-1.4);
      expect_mean(
          "layers",
          render_text(
              joined({kUnlimited, film(), look({0.1, 0.2, side}, {0.15, 0.1, 0}), kRay, kSurround,
                      absorber("m0", 0.5), absorber("m1", 0.4), layers[0], layers[1], layers[2]}),
              {.samples = 512}),
          {expected, expected, expected}, {.absolute = 3e-3, .largest_relative_error = 0.005});
    }
  }
}

// What overlaps adds up: absorption, emission and scattering alike, in all channels.
TEST(MediaSets, MediaWithOneBoundaryAreTheirSum) {
  const auto scene = [](const std::string& tracker, const std::string& world) {
    return R"(Integrator "volpath" "integer maxdepth" 12 "string tracker" ")" + tracker + "\"\n" +
           film(8) + look({2, 1, -3}, {0, 0, 0}) +
           "Camera \"perspective\" \"float fov\" 25\nWorldBegin\n"
           "LightSource \"infinite\" \"rgb L\" [ .3 .3 .3 ]\n"
           "LightSource \"distant\" \"rgb L\" [ 2 2 2 ] \"point3 from\" [ 1 2 -1 ]\n" +
           world;
  };
  const auto medium = [](const std::string& name, const std::string& values) {
    return R"(MakeNamedMedium ")" + name + R"(" "string type" "homogeneous" )" + values + "\n";
  };
  const auto box = [](const std::string& name) {
    return medium_box(name, Vec3d(-1), Vec3d(1, 0.6, 1));
  };
  const std::string both =
      medium("a", R"("rgb sigma_a" [ .1 .3 .2 ] "rgb sigma_s" [ 1 .5 .7 ] "rgb Le" [ .4 .2 0 ])") +
      medium("b", R"("rgb sigma_a" [ .2 0 .2 ] "rgb sigma_s" [ .2 .8 .3 ])") + box("a") + box("b");
  // Absorption of a alone emits: Le is weighted with its share.
  const std::string sum =
      medium("c", R"("rgb sigma_a" [ .3 .3 .4 ] "rgb sigma_s" [ 1.2 1.3 1 ] "rgb Le" )"
                  "[ .13333333 .2 0 ]") +
      box("c");
  for (const char* const tracker : {"spectral", "delta"}) {
    expect_alike(tracker, render_text(scene(tracker, both), {.samples = 1024}),
                 render_text(scene(tracker, sum), {.samples = 1024, .seed = 9}),
                 {.absolute = 2e-5, .largest_relative_error = 0.008});
  }
}

// Tiles of one medium are the whole, as meshes each and as one mesh, seen and lit through their
// common faces.
TEST(MediaSets, TilesAreTheWhole) {
  const std::string start =
      kUnlimited + film(8) + look({0.4, 3, -2}, {0.1, 0, 0.1}) +
      "Camera \"perspective\" \"float fov\" 30\nWorldBegin\n" + kSurround +
      "LightSource \"point\" \"rgb I\" [ 3 3 3 ] \"point3 from\" [ 2 2 1 ]\n" +
      grey_fog("m", 0.5, 2);
  std::string tiles;
  std::string points;
  std::string indices;
  int first = 0;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      const Vec3d low(0.4 * i - 1, -0.3, 0.4 * j - 1);
      const Vec3d high(0.4 * (i + 1) - 1, 0.3, 0.4 * (j + 1) - 1);
      tiles += medium_box("m", low, high);
      for (int corner = 0; corner < 8; ++corner) {
        points +=
            fmt::format("{} {} {} ", (corner & 1) != 0 ? high.x : low.x,
                        (corner & 2) != 0 ? high.y : low.y, (corner & 4) != 0 ? high.z : low.z);
      }
      for (const int index : {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                              2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5}) {
        indices += fmt::format("{} ", first + index);
      }
      first += 8;
    }
  }
  const Picture whole = render_text(start + medium_box("m", Vec3d(-1, -0.3, -1), Vec3d(1, 0.3, 1)),
                                    {.samples = 1024});
  const std::string mesh = R"(Material "interface" MediumInterface "m" "" Shape "trianglemesh" )"
                           R"("point3 P" [ )" +
                           points + "] \"integer indices\" [ " + indices + "]\n";
  for (const std::string& world : {tiles, mesh}) {
    expect_alike("tiles", render_text(start + world, {.samples = 1024, .seed = 3}), whole);
  }
}

// A floor at the bottom of the fog is never passed over, nor does it hide the fog.
TEST(MediaSets, FloorAtTheBottomOfTheFog) {
  const std::string fog = medium_box("m", Vec3d(-1, 0, -1), Vec3d(1, 2, 1));
  const auto floor = [](double reflectance) {
    return fmt::format(
        R"(AttributeBegin Material "diffuse" "rgb reflectance" [ {0} {0} {0} ] Shape )"
        R"("trianglemesh" "point3 P" [ -5 0 -5  5 0 -5  5 0 5  -5 0 5 ] "integer indices" )"
        "[ 0 1 2 0 2 3 ] AttributeEnd\n",
        reflectance);
  };
  for (const double turn : {0.0, 23.0}) {
    for (const Vec3d& eye : {Vec3d(0.1, 7, 0.2), Vec3d(0.4, 3, -6)}) {
      const auto scene = [&](const std::string& world) {
        return joined({kUnlimited, film(8), look(eye, Vec3d(0.05, 0, 0.02)), turned(-turn),
                       "Camera \"perspective\" \"float fov\" 8\nWorldBegin\n", kSurround,
                       turned(turn), world});
      };
      const Picture below = render_text(scene(absorber("m", 0.1) + floor(0) + fog));
      const Picture above = render_text(scene(absorber("m", 0.1) + fog + floor(0)));
      EXPECT_EQ(below.mean[0], 0);
      EXPECT_EQ(above.mean[0], 0);
      // A furnace without loss.
      expect_mean("furnace",
                  render_text(scene(grey_fog("m", 0, 1.5, 0.3) + floor(1) + fog), {.samples = 512}),
                  {1, 1, 1}, {.absolute = 3e-5, .largest_relative_error = 0.004});
    }
  }
}

// Light on the floor beneath the fog comes through it, once.
TEST(MediaSets, LightOnTheFloorBeneathTheFog) {
  const std::string world =
      R"(LightSource "distant" "rgb L" [ 2 2 2 ] "point3 from" [ 1 2 0.5 ])"
      "\n" +
      absorber("m", 0.4) + medium_box("m", Vec3d(-1, 0, -1), Vec3d(1, 2, 1)) +
      R"(Material "diffuse" "rgb reflectance" [ .5 .5 .5 ] Shape "trianglemesh" "point3 P" )"
      "[ -5 0 -5  5 0 -5  5 0 5  -5 0 5 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n";
  const Vec3d sun = Vec3d(1, 2, 0.5).normalized();
  // Down through the fog, and up to the lamp through one of its sides.
  const double up = 0.9 / sun.x;
  const double expected = 2 * sun.y * 0.5 / 3.14159265358979 * std::exp(-0.4 * (2 + up));
  expect_mean("floor",
              render_text("Integrator \"volpath\" \"integer maxdepth\" 1\n" + film() +
                              look({0.1, 5, 0.2}, {0.1, 0, 0.2}) + kRay + world,
                          {.samples = 512}),
              {expected, expected, expected}, {.absolute = 2e-5, .largest_relative_error = 0.006});
}

// Furnaces of all kinds of coincidence.
TEST(MediaSets, RandomBodiesInAFurnace) {
  for (uint32_t seed = 200; seed < 204; ++seed) {
    Arrangement arrangement(seed);
    const Vec3d direction = arrangement.in_box(1).normalized();
    const double turn = seed % 2 == 0 ? 0 : 51;
    const std::string media =
        grey_fog("m0", 0, 0.6, 0.5) + grey_fog("m1", 0, 1) + grey_fog("m2", 0, 0.4, -0.4);
    for (const ColorMode mode : kColorModes) {
      expect_mean(
          "furnace",
          render_text(joined({kUnlimited, film(8), look(direction * -8, Vec3d(0)), turned(-turn),
                              "Camera \"perspective\" \"float fov\" 20\nWorldBegin\n", kSurround,
                              media, turned(turn), arrangement.bodies()}),
                      {.mode = mode, .samples = 128}),
          {1, 1, 1}, {.absolute = 3e-5, .largest_relative_error = 0.01});
    }
  }
}

// Emission along a line through two media that overlap in its middle.
TEST(MediaSets, EmissionOfWhatOverlaps) {
  const std::string world = absorber("a", 0.5, "\"rgb Le\" [ 1 1 1 ]") +
                            absorber("b", 0.3, "\"rgb Le\" [ 2 2 2 ]") +
                            medium_box("a", Vec3d(-1, -1, 0), Vec3d(1, 1, 2)) +
                            medium_box("b", Vec3d(-1, -1, 1), Vec3d(1, 1, 3));
  const auto emitted = [](double sigma, double radiance) {
    return radiance * (1 - std::exp(-sigma));
  };
  const double first = emitted(0.5, 1);
  const double both = emitted(0.8, (0.5 * 1 + 0.3 * 2) / 0.8);
  const double last = emitted(0.3, 2);
  const double expected = first + std::exp(-0.5) * (both + std::exp(-0.8) * last);
  expect_mean("emission",
              render_text(kUnlimited + film() + look({0, 0, -3}, {0, 0, 0}) + kRay + world,
                          {.samples = 1024}),
              {expected, expected, expected}, {.absolute = 2e-5, .largest_relative_error = 0.004});
}

// A lamp far away is shadowed by what is near it, and lit through the fog that is around it.
TEST(MediaSets, ShadowRaysEndAtTheirLamp) {
  const auto scene = [](const std::string& world) {
    return "Integrator \"volpath\" \"integer maxdepth\" 1\n" + film(4) +
           "LookAt 0 0 0.5  0 0 0  0 1 0\n" + kRay +
           R"(LightSource "point" "rgb I" [ 1e8 1e8 1e8 ] "point3 from" [ 0 0 5000 ])"
           "\nMaterial \"diffuse\" \"rgb reflectance\" [ .5 .5 .5 ]\n"
           R"(Shape "bilinearmesh" "point3 P" [ -9 -9 0  9 -9 0  -9 9 0  9 9 0 ])"
           "\n" +
           world;
  };
  const std::string sphere =
      "AttributeBegin Translate 0 0 5000 Shape \"sphere\" \"float radius\" 0.01 AttributeEnd\n";
  EXPECT_EQ(render_text(scene(sphere)).mean[0], 0);
  const double expected = 4 * 0.5 / 3.14159265358979 * std::exp(-1.5);
  expect_mean("fog",
              render_text(scene(absorber("m", 6) +
                                medium_box("m", Vec3d(-1, -1, 4999.75), Vec3d(1, 1, 5001))),
                          {.samples = 8192}),
              {expected, expected, expected}, {.absolute = 2e-5, .largest_relative_error = 0.006});
}

// Lamps that are surfaces: on a ceiling, and behind a thin fog that touches them.
TEST(MediaSets, LampsOnACeilingBeneathFog) {
  const auto scene = [](const std::string& world) {
    return "Integrator \"volpath\" \"integer maxdepth\" 1\n" + film(8) +
           "LookAt 0 0.4 -3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 8\nWorldBegin\n"
           R"(AttributeBegin Material "diffuse" "rgb reflectance" [ .5 .5 .5 ] Shape )"
           R"("bilinearmesh" "point3 P" [ -3 0 -3  -3 0 3  3 0 -3  3 0 3 ] AttributeEnd)"
           "\n" +
           world;
  };
  const std::string lamp =
      R"(AttributeBegin AreaLightSource "diffuse" "rgb L" [ 9 9 9 ] Material "diffuse" Shape )"
      R"("trianglemesh" "point3 P" [ -.5 2 -.5  .5 2 -.5  .5 2 .5  -.5 2 .5 ] )"
      "\"integer indices\" [ 0 1 2 0 2 3 ] AttributeEnd\n";
  const std::string ceiling =
      R"(AttributeBegin Material "diffuse" Shape "trianglemesh" "point3 P" )"
      "[ -4 2 -4  4 2 -4  4 2 4  -4 2 4 ] \"integer indices\" [ 0 1 2 0 2 3 ] AttributeEnd\n";
  const Picture alone = render_text(scene(lamp), {.samples = 512});
  ASSERT_GT(alone.mean[0], 0.1);
  for (const std::string& world : {lamp + ceiling, ceiling + lamp}) {
    expect_alike("ceiling", render_text(scene(world), {.samples = 512, .seed = 3}), alone);
  }
  // A layer of fog below the lamp, and the same some way down.
  const auto layer = [&](double low, double high) {
    return render_text(
        scene(lamp + absorber("m", 3) + medium_box("m", Vec3d(-4, low, -4), Vec3d(4, high, 4))),
        {.samples = 1024});
  };
  expect_alike("layer", layer(1.9, 2), layer(1, 1.1),
               {.absolute = 2e-5, .largest_relative_error = 0.008});
}

TEST(MediaSets, CountsDoNotDependOnTheOrder) {
  MediaSet a, b;
  a.cross(0, kVacuum, true);
  a.cross(1, 0, true);
  b.cross(1, 0, true);
  b.cross(0, kVacuum, true);
  EXPECT_TRUE(a == b);
  EXPECT_EQ(a.count(1), 1);
  EXPECT_EQ(a.count(0), 0);
  a.cross(1, 0, false);
  EXPECT_EQ(a.count(0), 1);
  a.cross(0, kVacuum, false);
  EXPECT_TRUE(a.entries().empty());
  for (int i = 0; i < MediaSet::kCapacity; ++i) a.add(i, 1);
  EXPECT_THROW(a.add(MediaSet::kCapacity, 1), Error);
}

}  // namespace
}  // namespace freepath::testing
