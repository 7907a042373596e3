// Shapes that are there in part (alpha): cut-outs and veils, for rays of the camera, of paths and
// of shadows alike, against closed forms.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "freepath/paths/alpha_chance.h"
#include "freepath/paths/media_set.h"
#include "tests/scene/lit_plane.h"

namespace freepath::testing {
namespace {

const std::string kBlack = R"(Material "diffuse" "rgb reflectance" [ 0 0 0 ] )";
/// Squares of the unit square of (u, v); the part of 1 is where u and v are both below or above.
const std::string kHoles =
    R"(Texture "holes" "float" "checkerboard" "float uscale" 4 "float vscale" 4 )"
    "\"float tex1\" 1 \"float tex2\" 0\n";

/// A black sheet in the plane of this height, as wide as need be.
std::string veil(double z, const std::string& alpha, double half = 500) {
  return fmt::format(
      R"(AttributeBegin {0} Shape "bilinearmesh" "point3 P" [ -{1} -{1} {2}  {1} -{1} {2}  )"
      "-{1} {1} {2}  {1} {1} {2} ] {3} AttributeEnd\n",
      kBlack, half, z, alpha);
}

/// The unit square of the plane z = 0 seen by an orthographic camera from z = 3, each of so many
/// pixels a square.
std::string seen_square(const std::string& world, int pixels, const std::string& settings = "") {
  return kUnlimited + film(pixels) + settings +
         "Scale -1 1 1\nLookAt .5 .5 3  .5 .5 0  0 1 0\n"
         "Camera \"orthographic\" \"float screenwindow\" [ -.5 .5 -.5 .5 ]\nWorldBegin\n" +
         world;
}

std::string unit_square(double z, const std::string& alpha) {
  return fmt::format(
      "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 {0}  1 0 {0}  0 1 {0}  1 1 {0} ] {1}\n", z, alpha);
}

/// Pixels of a checkerboard of 4 x 4 squares, which every sample has to agree about.
void expect_board(const std::string& name, const Picture& picture, double odd, double even) {
  expect_sound(picture);
  const int red = *find_channel(picture.image, "R");
  for (int i = 0; i < 16; ++i) {
    const bool is_even = (i % 4 + i / 4) % 2 == 0;  // the upper left square has u = 0, v = 3
    EXPECT_NEAR(picture.image.pixel(i % 4, i / 4)[red], is_even ? odd : even, 2e-6)
        << name << ", pixel " << i;
  }
}

/// The irradiance of the plane of plane_at(), as R alone tells it.
void expect_red_irradiance(const std::string& name, const std::string& lights, double irradiance,
                           uint32_t samples) {
  const double radiance = irradiance * kPlaneReflectance / std::numbers::pi;
  const Picture picture = render_text(plane_at(0, lights), {.samples = samples});
  expect_sound(picture);
  EXPECT_TRUE(check_mean(name, picture.mean[0], picture.error[0], picture.paths, radiance,
                         {.absolute = 2e-5, .largest_relative_error = 0.005}));
}

TEST(SceneAlpha, VeilsTransmitWhatTheyAreNot) {
  const std::string lamp =
      R"(AttributeBegin AreaLightSource "diffuse" "rgb L" [ 1 2 3 ] ReverseOrientation )"
      "Translate 0 0 2 Shape \"disk\" \"float radius\" 1.5 AttributeEnd\n";
  const double form = std::numbers::pi * 2.25 / (4 + 2.25);
  // Shadow rays, and those that a plane scatters: the light of a sky is found by both.
  expect_red_irradiance("lamp", lamp + veil(1, R"("float alpha" 0.3)"), 0.7 * form, 2048);
  expect_red_irradiance("sky", kWhiteSky + veil(1, R"("float alpha" 0.3)"), 0.7 * std::numbers::pi,
                        4096);
  // The camera's, through two.
  for (const ColorMode mode : kColorModes) {
    const Picture picture = render_text(
        seen_square(kWhiteSky + veil(1, R"("float alpha" 0.3)") + veil(0.5, R"("float alpha" 0.6)"),
                    8),
        {.mode = mode, .samples = 4096});
    expect_mean("camera", picture, grey(0.28));
  }
}

// Each veil is met or not by a chance of its own, which is asked once where both are at one place.
TEST(SceneAlpha, VeilsAtOnePlaceAreIndependent) {
  const std::string veils = veil(1, R"("float alpha" 0.5)") + veil(1, R"("float alpha" 0.4)") +
                            R"(ObjectBegin "o" )" + veil(0, R"("float alpha" 0.2)") +
                            "ObjectEnd Translate 0 0 1 ObjectInstance \"o\"\n";
  expect_mean("camera", render_text(seen_square(kWhiteSky + veils, 8), {.samples = 8192}),
              grey(0.24));
  expect_red_irradiance("sky", kWhiteSky + veils, 0.24 * std::numbers::pi, 16384);
}

TEST(SceneAlpha, CutOutsAreHolesForAllRays) {
  const std::string cut = kBlack + unit_square(1, R"("texture alpha" "holes")");
  expect_board("camera", render_text(seen_square(kHoles + kWhiteSky + cut, 4)), 1, 0);
  // A floor in parallel light, seen from the side of the light through holes that are there for
  // both: shadow rays and the camera's meet the same sheet.
  const std::string floor = R"(LightSource "distant" "rgb L" [ 1 1 1 ] "float scale" 3.14159265 )"
                            "\"point3 from\" [ 0 0 1 ] \"point3 to\" [ 0 0 0 ]\n"
                            "Material \"diffuse\" \"rgb reflectance\" [ .5 .5 .5 ]\n" +
                            unit_square(0, "");
  expect_board("shadow", render_text(seen_square(kHoles + floor + cut, 4)), 0.5, 0);
  // Behind the camera, in a mirror.
  const std::string mirror =
      R"(Material "conductor" "spectrum eta" [ 300 0 900 0 ] "spectrum k" [ 300 1.5 900 1.5 )"
      "]\n" +
      unit_square(0, "");
  expect_board(
      "mirror",
      render_text(seen_square(
          kHoles + kWhiteSky + mirror + kBlack + unit_square(4, R"("texture alpha" "holes")"), 4)),
      1, 0);
}

TEST(SceneAlpha, LightsShineWhereTheyAre) {
  const double x = 0.8 / 2;
  const double y = 1.2 / 2;
  const double corner = x / std::hypot(1, x) * std::atan(y / std::hypot(1, x)) +
                        y / std::hypot(1, y) * std::atan(x / std::hypot(1, y));
  const auto light = [](const std::string& alpha) {
    return "Texture \"half\" \"float\" \"checkerboard\" \"float uscale\" 2 \"float vscale\" 1e-3\n"
           R"(Texture "ramp" "float" "bilerp" "float v00" 0 "float v01" 0 )"
           "\"float v10\" 1 \"float v11\" 1\n"
           R"(AttributeBegin AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] Shape "bilinearmesh" )"
           R"("point3 P" [ -.8 -1.2 2  -.8 1.2 2  .8 -1.2 2  .8 1.2 2 ] )" +
           alpha + " AttributeEnd\n";
  };
  const double whole = 4 * 0.5 * corner;
  // By symmetry half of the light comes from a half, and from a ramp.
  expect_red_irradiance("half", light(R"("texture alpha" "half")"), 0.5 * whole, 4096);
  expect_red_irradiance("ramp", light(R"("texture alpha" "ramp")"), 0.5 * whole, 4096);
  expect_red_irradiance("constant", light(R"("float alpha" 0.25)"), 0.25 * whole, 8192);
  // Seen directly it covers what is behind by as much.
  const std::string lamp = R"(AreaLightSource "diffuse" "rgb L" [ 3 3 3 ] )" + kBlack;
  expect_mean(
      "seen",
      render_text(seen_square(kWhiteSky + lamp + unit_square(0, R"("float alpha" 0.25)"), 8),
                  {.samples = 8192}),
      grey(0.75 + 0.25 * 3));
  // No part of what is 0 everywhere by a texture of one value: invisible, as by a number.
  const std::string zero = "Texture \"zero\" \"float\" \"constant\" \"float value\" 0\n";
  expect_red_irradiance("constant texture", zero + light(R"("texture alpha" "zero")"), whole, 1024);
}

// A white furnace: what a sphere does not scatter it emits. Light is found by lights' sampling, by
// scattered rays, and through the holes.
TEST(SceneAlpha, GlowingVeilsFillTheFurnace) {
  const std::string world =
      kWhiteSky +
      "AreaLightSource \"diffuse\" \"rgb L\" [ .5 .5 .5 ] \"bool twosided\" true\n"
      "Material \"diffuse\" \"rgb reflectance\" [ .5 .5 .5 ]\n"
      "Shape \"sphere\" \"float radius\" 0.4 \"float alpha\" 0.6\n" +
      kHoles +
      R"(Translate 0.3 0.2 0 Shape "sphere" "float radius" 0.5 )"
      "\"texture alpha\" \"holes\"\n";
  for (const ColorMode mode : kColorModes) {
    expect_mean("furnace", render_text(seen_square(world, 16), {.mode = mode, .samples = 256}),
                grey(1), {.absolute = 3e-5, .largest_relative_error = 0.002});
  }
}

// The wall of a pipe that shines hides the wall behind it, whether or not anything has holes.
TEST(SceneAlpha, LightsAreInTheirOwnShadow) {
  const auto scene = [](const std::string& alpha) {
    return plane_at(0, R"(AttributeBegin AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] )"
                       R"("bool twosided" true Translate 0 0 2 Rotate 90 0 1 0 )"
                       R"(Shape "cylinder" "float radius" 0.5 AttributeEnd )"
                       R"(Translate 0 0 100 Shape "disk" )" +
                           alpha);
  };
  const Picture whole = render_text(scene(""));
  EXPECT_GT(whole.mean[0], 0.05);
  EXPECT_EQ(render_text(scene(R"("float alpha" 0.5)")).image.values, whole.image.values);
}

// A boundary with holes lets rays in with its alpha, and out with its alpha: who has got in and
// not out is in the medium for ever. Who was not let in is not let out either.
TEST(SceneAlpha, BoundariesOfMediaAreCrossedByChance) {
  const std::string box =
      R"(MakeNamedMedium "smoke" "string type" "homogeneous" "rgb sigma_a" [ .7 .7 .7 ] )"
      "\"rgb sigma_s\" [ 0 0 0 ]\nAttributeBegin Material \"interface\" "
      "MediumInterface \"smoke\" \"\"\n" +
      box_shape(Vec3d(-50, -50, 0.5), Vec3d(50, 50, 1.5));
  const std::string part =
      box.substr(0, box.rfind(']') + 1) + " \"float alpha\" 0.6 AttributeEnd\n";
  const double expected = 0.4 + 0.6 * 0.6 * std::exp(-0.7);
  expect_mean("camera", render_text(seen_square(kWhiteSky + part, 8), {.samples = 8192}),
              grey(expected));
  // Shadow rays end at the floor's light after both boundaries.
  const std::string sun = R"(LightSource "distant" "rgb L" [ 1 1 1 ] "point3 from" [ 0 0 1 ] )"
                          "\"point3 to\" [ 0 0 0 ]\n";
  expect_red_irradiance("sun", sun + part, expected, 8192);
}

TEST(SceneAlpha, PorousBoundariesSetWhatIsThere) {
  MediaSet media;
  media.cross_porous(2, kVacuum, false);  // out, without having been in
  EXPECT_TRUE(media.entries().empty());
  media.cross_porous(2, kVacuum, true);
  media.cross_porous(2, kVacuum, true);  // in twice
  EXPECT_EQ(media.count(2), 1);
  media.cross_porous(3, 2, true);
  EXPECT_EQ(media.count(2), 0);
  EXPECT_EQ(media.count(3), 1);
  media.cross(5, kVacuum, true);
  media.cross_porous(3, 2, false);
  EXPECT_EQ(media.count(2), 1);
  EXPECT_EQ(media.count(3), 0);
  EXPECT_EQ(media.count(5), 1);
}

TEST(SceneAlpha, ChanceIsThatOfTheSurfaceAlone) {
  const SurfaceKey key{kNoInstance, 1, 2, 0};
  int met = 0;
  int both = 0;
  constexpr int kWays = 40000;
  for (uint32_t sample = 0; sample < kWays; ++sample) {
    const AlphaChance chance{7, 3, sample, 0};
    const bool first = chance.meets(key, 0.3F);
    EXPECT_EQ(first, chance.meets(key, 0.3F));
    SurfaceKey other = key;
    other.instance = 0;
    met += first ? 1 : 0;
    both += first && chance.meets(other, 0.5F) ? 1 : 0;
  }
  EXPECT_TRUE(check_mean("met", met / double{kWays}, std::sqrt(0.21 / kWays), kWays, 0.3));
  EXPECT_TRUE(
      check_mean("both", both / double{kWays}, std::sqrt(0.15 * 0.85 / kWays), kWays, 0.15));
  EXPECT_FALSE((AlphaChance{}.meets(key, 0)));
  EXPECT_TRUE((AlphaChance{}.meets(key, 1)));
}

TEST(SceneAlpha, PicturesDoNotDependOnThreadsOrBatches) {
  const std::string world =
      kHoles + kWhiteSky + "Material \"diffuse\" \"rgb reflectance\" [ .8 .8 .8 ]\n" +
      unit_square(0, "") + unit_square(0.5, R"("float alpha" 0.5)") +
      "Translate 0.1 0.1 0 Rotate 30 0 1 0 " + unit_square(0.8, R"("texture alpha" "holes")");
  const Picture one = render_text(seen_square(world, 8), {.threads = 1, .batch = 2048});
  const Picture other = render_text(seen_square(world, 8), {.threads = 3, .batch = 100});
  EXPECT_EQ(one.image.values, other.image.values);
}

}  // namespace
}  // namespace freepath::testing
