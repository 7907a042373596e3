// What lights of scenes do to a diffuse plane, against closed forms of the irradiance.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/scene/lit_plane.h"

namespace freepath::testing {
namespace {

TEST(SceneIrradiance, OfAPointIsItsIntensityTimesCosineOverSquareOfDistance) {
  const double distance_2 = 0.3 * 0.3 + 2 * 2;
  const double form = 3 * (2 / std::sqrt(distance_2)) / distance_2;
  expect_irradiance("point", 0.3,
                    R"(LightSource "point" "rgb I" [ 1 .5 .25 ] "point3 from" [ 0 0 2 ] )"
                    "\"float scale\" 3\n",
                    {form, 0.5 * form, 0.25 * form});
}

TEST(SceneIrradiance, OfAPointOfGivenPowerIsThatOverTheSphere) {
  expect_irradiance("power", 0,
                    "Translate 0 0 2 LightSource \"point\" \"float power\" 40 \"float scale\" 7\n",
                    grey(7 * 40 / (4 * std::numbers::pi) / 4));
}

TEST(SceneIrradiance, OfASpotEndsSmoothlyAtItsCone) {
  const auto form = [](double x) {
    const double cosine = 2 / std::sqrt(x * x + 4);
    const double end = std::cos(30 * std::numbers::pi / 180);
    const double start = std::cos(20 * std::numbers::pi / 180);
    const double u = std::clamp((cosine - end) / (start - end), 0.0, 1.0);
    return u * u * (3 - 2 * u) * cosine * cosine * cosine / 4;
  };
  const std::string light =
      R"(LightSource "spot" "rgb I" [ 2 2 2 ] "point3 from" [ 0 0 2 ] "point3 to" [ 0 0 0 ] )"
      "\"float coneangle\" 30 \"float conedeltaangle\" 10\n";
  for (const double x : {0.0, 0.5, 0.9}) expect_irradiance("spot", x, light, grey(2 * form(x)));
  EXPECT_EQ(render_text(plane_at(1.3, light)).mean[0], 0);
}

TEST(SceneIrradiance, OfParallelLightIsItsRadianceTimesCosine) {
  const std::string direction = " \"point3 from\" [ 1 0 2 ] \"point3 to\" [ 0 0 0 ]\n";
  const double cosine = 2 / std::sqrt(5.0);
  expect_irradiance("distant", 0, R"(LightSource "distant" "rgb L" [ 3 2 1 ])" + direction,
                    {3 * cosine, 2 * cosine, cosine});
  expect_irradiance("illuminance", 0, R"(LightSource "distant" "float illuminance" 5)" + direction,
                    grey(5 * cosine));
}

TEST(SceneIrradiance, OfASkyOfOneRadianceIsPiTimesThat) {
  expect_irradiance("sky", 0, "LightSource \"infinite\" \"rgb L\" [ 2 1 .5 ]\n",
                    {2 * std::numbers::pi, std::numbers::pi, 0.5 * std::numbers::pi}, 4096);
  expect_irradiance("illuminance", 0, "LightSource \"infinite\" \"float illuminance\" 4\n", grey(4),
                    4096);
}

TEST(SceneIrradiance, OfADiskAboveItsCentre) {
  // A disk's normal is z, so that it has to be turned over to shine down.
  const auto disk = [](const std::string& light) {
    return R"(AttributeBegin AreaLightSource "diffuse" )" + light +
           " ReverseOrientation Translate 0 0 2 Shape \"disk\" \"float radius\" 1.5 AttributeEnd\n";
  };
  const double form = std::numbers::pi * 1.5 * 1.5 / (1.5 * 1.5 + 2 * 2);
  expect_irradiance("disk", 0, disk(R"("rgb L" [ 1 2 3 ])"), {form, 2 * form, 3 * form}, 2048);
  // Power is radiance times pi times area.
  const double area = std::numbers::pi * 1.5 * 1.5;
  expect_irradiance("power", 0, disk(R"("float power" 30)"),
                    grey(30 / (std::numbers::pi * area) * form), 2048);
}

// A light of alpha 0 shines and is not seen, nor does it cast a shadow, be it there or behind.
TEST(SceneIrradiance, OfAnInvisibleDiskIsThatOfADisk) {
  const double form = std::numbers::pi * 2.25 / (4 + 2.25);
  const auto disk = [](const std::string& light, double z, const std::string& alpha) {
    return fmt::format(
        "AttributeBegin {} ReverseOrientation Translate 0 0 {} Shape \"disk\" \"float radius\" 1.5 "
        "\"float alpha\" {} AttributeEnd\n",
        light, z, alpha);
  };
  const std::string lamp = "AreaLightSource \"diffuse\" \"rgb L\" [ 1 2 3 ]";
  const std::array<double, 3> irradiance{form, 2 * form, 3 * form};
  expect_irradiance("invisible", 0, disk(lamp, 2, "0"), irradiance, 2048);
  // In front of another, and a shape that shines not; the camera is at 0.5.
  expect_irradiance("in front", 0,
                    disk(lamp, 2, "1") + disk("", 0.25, "0") + disk("", 1, "0") +
                        disk("AreaLightSource \"diffuse\" \"rgb L\" [ 0 0 0 ]", 0.3, "0"),
                    irradiance, 2048);
}

TEST(SceneIrradiance, OfADiskThatShinesAwayIsNothing) {
  const std::string scene =
      plane_at(0, R"(AttributeBegin AreaLightSource "diffuse" Translate 0 0 2 Shape "disk" )"
                  "AttributeEnd\n");
  EXPECT_EQ(render_text(scene).mean[0], 0);
}

TEST(SceneIrradiance, OfASphereIsAsIfItWereAtItsCentre) {
  // pi L (R / D)² cos.
  const double distance_2 = 1.5 * 1.5 + 4;
  const double form = std::numbers::pi * 0.49 / distance_2 * 2 / std::sqrt(distance_2);
  expect_irradiance("sphere", 1.5,
                    R"(AttributeBegin AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] )"
                    R"("float scale" 2 Translate 0 0 2 Shape "sphere" "float radius" 0.7 )"
                    "AttributeEnd\n",
                    grey(2 * form), 1024);
}

TEST(SceneIrradiance, OfARectangleAboveItsCentre) {
  // Four times the factor of an element below the corner of a parallel rectangle.
  const double x = 0.8 / 2;
  const double y = 1.2 / 2;
  const double corner = x / std::hypot(1, x) * std::atan(y / std::hypot(1, x)) +
                        y / std::hypot(1, y) * std::atan(x / std::hypot(1, y));
  const std::array<double, 3> expected = grey(4 * 0.5 * corner);
  const std::string light = R"(AttributeBegin AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] )";
  const std::string corners = R"("point3 P" [ -.8 -1.2 2  -.8 1.2 2  .8 -1.2 2  .8 1.2 2 ])";
  expect_irradiance("patch", 0, light + R"(Shape "bilinearmesh" )" + corners + " AttributeEnd\n",
                    expected, 1024);
  expect_irradiance("triangles", 0,
                    light + R"(Shape "trianglemesh" )" + corners +
                        " \"integer indices\" [ 0 1 2  1 3 2 ] AttributeEnd\n",
                    expected, 1024);
}

}  // namespace
}  // namespace freepath::testing
