// Lights that are images, portals and both sides of area lights, against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/scene/image_file.h"
#include "tests/scene/lit_plane.h"
#include "tests/scene/twin_scenes.h"

namespace freepath::testing {
namespace {

// The image is 1 where its x is negative and 3 where it is positive. A surface that faces along x
// sees one half alone, one that faces along y sees halves of both.
TEST(SceneLightImage, OfTheSkyIsTurnedWithIt) {
  const ImageFile image("sky.exr", 64, 64, [](int column, int) {
    const float value = column < 32 ? 1 : 3;
    return Vec3f(value, 2 * value, value / 2);
  });
  const auto sky = [&](const std::string& turn) {
    return turn + R"( LightSource "infinite" "float scale" 2 )" + image.parameter();
  };
  const auto expect = [&](const char* name, const std::string& turn, double form) {
    expect_irradiance(name, 0, sky(turn), {2 * form, 4 * form, form}, 4096);
  };
  expect("x is up", "Rotate -90 0 1 0", 3 * std::numbers::pi);
  expect("x is down", "Rotate 90 0 1 0", std::numbers::pi);
  expect("z is up", "", 2 * std::numbers::pi);
}

// Of skies that add up to white one is drawn, by what is above its mean, and others, which shine
// from its directions too, are found by chance; shadow rays towards the one are cast by roulette.
TEST(SceneLightImage, SkiesThatAddUpToWhiteMakeAFurnace) {
  const WhiteSkies skies;
  const std::string fog =
      R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ 2 3 1 ] )"
      R"("rgb sigma_a" [ 0 0 0 ] "float g" 0.4)"
      "\n";
  const std::string text =
      kUnlimited + film() +
      "LookAt 1 0.5 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 30\nWorldBegin\n" +
      skies.lights() + fog + medium_box("fog", Vec3d(-1), Vec3d(1));
  for (const ColorMode mode : {ColorMode::kRgb, ColorMode::kSpectral}) {
    const Picture picture = render_text(text, {.mode = mode, .samples = 512});
    expect_sound(picture);
    for (int c = 0; c < 3; ++c) {
      EXPECT_LT(std::abs(picture.mean[c] - 1), 4 * picture.error[c] + 1e-4) << c;
      EXPECT_LT(picture.error[c], 2e-3);
    }
  }
}

/// Four times the factor of an element below the corner of a parallel rectangle, for half edges of
/// 0.8 and 1.2 at a height of 2.
double rectangle_form() {
  const double x = 0.8 / 2;
  const double y = 1.2 / 2;
  return 2 * (x / std::hypot(1, x) * std::atan(y / std::hypot(1, x)) +
              y / std::hypot(1, y) * std::atan(x / std::hypot(1, y)));
}

// A portal lets in what comes through it, as a rectangle of the sky's radiance would shine.
TEST(SceneLightImage, PortalLetsInTheLightOfARectangle) {
  const std::string portal = R"("point3 portal" [ -.8 -1.2 2  -.8 1.2 2  .8 1.2 2  .8 -1.2 2 ])"
                             "\n";
  const double form = rectangle_form();
  expect_irradiance("constant", 0, R"(LightSource "infinite" "rgb L" [ 2 1 .5 ] )" + portal,
                    {2 * form, form, 0.5 * form}, 2048);
  const ImageFile image("grey.exr", 16, 16, [](int, int) { return Vec3f(1.5F); });
  expect_irradiance("image", 0, R"(LightSource "infinite" )" + image.parameter() + portal,
                    grey(1.5 * form), 2048);
}

// The image's left half is where x is negative.
TEST(SceneLightImage, GoniometricLightIsItsImageTimesItsIntensity) {
  const ImageFile image("lamp.exr", 8, 8,
                        [](int column, int) { return Vec3f(column < 4 ? 0.25F : 1.0F); });
  const std::string light =
      R"(Translate 0 0 2 LightSource "goniometric" "rgb I" [ 4 2 1 ] )" + image.parameter();
  for (const double x : {-0.5, 0.7}) {
    const double distance_2 = x * x + 4;
    const double form = (x < 0 ? 0.25 : 1) * 2 / std::pow(distance_2, 1.5);
    expect_irradiance(fmt::format("at {}", x), x, light, {4 * form, 2 * form, form});
  }
  // Without an image it is a point; power is that over the sphere.
  expect_irradiance("power", 0, "Translate 0 0 2 LightSource \"goniometric\" \"float power\" 40\n",
                    grey(40 / (4 * std::numbers::pi) / 4));
}

// Turned around x to look down, where the image's top is at -y and its left at -x.
TEST(SceneLightImage, ProjectionShowsItsImageWithinItsAngle) {
  const ImageFile image("slide.exr", 2, 1, [](int column, int) {
    return column == 0 ? Vec3f(3, 2, 1) : Vec3f(1, 4, 2);
  });
  const std::string light =
      "Translate 0 0 2 Rotate 180 1 0 0 LightSource \"projection\" \"float scale\" 2 "
      "\"float fov\" 30 " +
      image.parameter();
  for (const double x : {-0.5, 0.7}) {
    const double form = 2 * 2 / std::pow(x * x + 4, 1.5);
    expect_irradiance(fmt::format("at {}", x), x, light,
                      x < 0 ? std::array<double, 3>{3 * form, 2 * form, form}
                            : std::array<double, 3>{form, 4 * form, 2 * form});
  }
  // The shorter side spans 30 degrees, the longer reaches twice as far from the axis.
  const double edge = 2 * 2 * std::tan(15 * std::numbers::pi / 180);
  EXPECT_GT(render_text(plane_at(0.99 * edge, light)).mean[0], 0);
  EXPECT_EQ(render_text(plane_at(1.01 * edge, light)).mean[0], 0);
}

// u runs along x here: the halves are mirrors of each other from below the middle.
TEST(SceneLightImage, AreaLightShinesWithItsImage) {
  const ImageFile image("panel.exr", 2, 1,
                        [](int column, int) { return Vec3f(column == 0 ? 1 : 3); });
  const std::string light =
      R"(AttributeBegin AreaLightSource "diffuse" )" + image.parameter() +
      R"("bool twosided" true Material "diffuse" "rgb reflectance" [ 0 0 0 ] )"
      R"(Shape "bilinearmesh" "point3 P" [ -.8 -1.2 2  .8 -1.2 2  -.8 1.2 2  .8 1.2 2 ])"
      " AttributeEnd\n";
  expect_irradiance("irradiance", 0, light, grey(2 * rectangle_form()), 2048);
  // Linear between the centres of the two pixels, seen from below.
  const auto seen = [&](double x, double expected) {
    const std::string scene =
        "Integrator \"volpath\"\n" + film(4) + fmt::format("LookAt {0} 0 0  {0} 0 1  0 1 0\n", x) +
        "Camera \"orthographic\" \"float screenwindow\" [ -1e-5 1e-5 -1e-5 1e-5 ]\nWorldBegin\n" +
        light;
    expect_mean(fmt::format("seen at {}", x), render_text(scene), grey(expected),
                {.absolute = 1e-4, .largest_relative_error = 0.001});
  };
  seen(-0.6, 1);
  seen(-0.2, 1.5);
  seen(0, 2);
  seen(0.6, 3);
}

TEST(SceneLightImage, TwoSidedLightShinesToBothSides) {
  const double form = std::numbers::pi * 1.5 * 1.5 / (1.5 * 1.5 + 2 * 2);
  for (const std::string side : {"", "ReverseOrientation "}) {
    expect_irradiance("disk " + side, 0,
                      R"(AttributeBegin AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] )"
                      "\"bool twosided\" true " +
                          side +
                          "Translate 0 0 2 Shape \"disk\" \"float radius\" 1.5 AttributeEnd\n",
                      grey(form), 2048);
  }
}

}  // namespace
}  // namespace freepath::testing
