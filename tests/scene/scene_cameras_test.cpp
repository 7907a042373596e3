// How much of a film every camera shows of a light of known shape, and how its lens blurs an edge.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

/// A camera that looks along z from the origin, and something of radiance 1.
std::string seen(const std::string& camera, const std::string& light, int film_size = 16) {
  return "Integrator \"volpath\" \"integer maxdepth\" 1\n" + film(film_size) + camera +
         "\nWorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
         R"(AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] "bool twosided" true )" +
         light;
}

void expect_share(const std::string& name, const std::string& scene, double share,
                  uint32_t samples = 1024) {
  expect_mean(name, render_text(scene, {.samples = samples}), {share, share, share},
              {.absolute = 1e-4 * share, .largest_relative_error = 0.0025});
}

TEST(Camera, PerspectiveShowsADiskAsItsAreaOverThatOfTheScreen) {
  const std::string disk =
      "Translate .2 -.1 0 Shape \"disk\" \"float height\" 4 \"float radius\" 1.2\n";
  const double edge = 2 * std::tan(50 * std::numbers::pi / 360);
  const double area = std::numbers::pi * 0.3 * 0.3;
  expect_share("angle", seen(R"(Camera "perspective" "float fov" 50)", disk), area / (edge * edge));
  // A screen of x from -1 to 1 and y from -1/2 to 1/2 of the angle of view; pixels are stretched.
  expect_share(
      "window",
      seen(R"(Camera "perspective" "float fov" 90 "float screenwindow" [ -1 1 -.5 .5 ])", disk),
      area / 2);
  expect_share("frame",
               seen(R"(Camera "perspective" "float fov" 50 "float frameaspectratio" 2)", disk),
               area / (2 * edge * edge), 1536);
}

TEST(Camera, OrthographicShowsADiskAsItsAreaOverThatOfTheScreen) {
  const std::string disk =
      "Translate .2 -.1 0 Shape \"disk\" \"float height\" 4 \"float radius\" .7\n";
  expect_share("screen", seen(R"(Camera "orthographic")", disk), std::numbers::pi * 0.49 / 4);
  expect_share("scaled", seen(R"(Scale .5 .5 .5 Camera "orthographic")", disk),
               std::numbers::pi * 0.49 / 16);
}

// The cone around a sphere.
TEST(Camera, SphericalOfEqualAreaShowsASphereAsItsSolidAngle) {
  const std::string sphere = "Translate .3 1.1 -.4 Shape \"sphere\" \"float radius\" .9\n";
  const double sine_2 = 0.81 / (0.09 + 1.21 + 0.16);
  expect_share("sphere", seen(R"(Camera "spherical")", sphere), (1 - std::sqrt(1 - sine_2)) / 2);
}

TEST(Camera, EquirectangularShowsASphereAboveAsARangeOfLatitudes) {
  const std::string sphere = "Translate 0 2 0 Shape \"sphere\" \"float radius\" 1\n";
  expect_share("sphere", seen(R"(Camera "spherical" "string mapping" "equirectangular")", sphere),
               (std::numbers::pi / 6) / std::numbers::pi);
}

/// The part of a unit disk where x is above a number in [-1, 1].
double part_above(double x) { return (std::acos(x) - x * std::sqrt(1 - x * x)) / std::numbers::pi; }

/// A light whose edge is at x = 0, half as far away as what is in focus, seen in one direction.
std::string blurred_edge(const std::string& camera, double x, double focus) {
  return seen(fmt::format(R"({} "float lensradius" .5 "float focaldistance" {} )"
                          R"("float screenwindow" [ {} {} -1e-4 1e-4 ])",
                          camera, focus, x - 1e-4, x + 1e-4),
              "Shape \"bilinearmesh\" \"point3 P\" [ 0 -90 4  90 -90 4  0 90 4  90 90 4 ]\n");
}

// From (lens, 0) to (8 x, 8) of the camera's space, at half the way: (lens + 8 x) / 2 > 0.
TEST(Camera, LensOfAPerspectiveBlursAnEdgeAsItsDisk) {
  const std::string camera = R"(Camera "perspective" "float fov" 90)";
  for (const double x : {-0.01, 0.0, 0.04}) {
    expect_share(fmt::format("at {}", x), blurred_edge(camera, x, 8), part_above(-8 * x / 0.5),
                 2048);
  }
  EXPECT_EQ(render_text(blurred_edge(camera, -0.03, 4)).mean[0], 0) << "in focus";
  EXPECT_NEAR(render_text(blurred_edge(camera, 0.03, 4)).mean[0], 1, 1e-6) << "in focus";
}

// From (x + lens, 0) to (x, 8), at half the way: x + lens / 2 > 0.
TEST(Camera, LensOfAnOrthographicBlursAnEdgeAsItsDisk) {
  for (const double x : {-0.03, 0.0, 0.12}) {
    expect_share(fmt::format("at {}", x), blurred_edge(R"(Camera "orthographic")", x, 8),
                 part_above(-2 * x / 0.5), 1024);
  }
}

TEST(Camera, IsoAndShutterScaleThePicture) {
  const std::string text =
      "Integrator \"volpath\"\nFilm \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4 "
      "\"float iso\" 250\nPixelFilter \"box\"\n"
      R"(Camera "perspective" "float shutteropen" .25 "float shutterclose" 1 )"
      "WorldBegin LightSource \"infinite\" \"rgb L\" [ .8 .8 .8 ]\n";
  for (const ColorMode mode : kColorModes) {
    expect_mean(name_of(mode), render_text(text, {.mode = mode, .samples = 256}),
                {2.5 * 0.75 * 0.8, 2.5 * 0.75 * 0.8, 2.5 * 0.75 * 0.8},
                {.absolute = 2e-4, .largest_relative_error = 0.0025});
  }
}

}  // namespace
}  // namespace freepath::testing
