// Paths that split towards a sun: against quadrature, and paths that do not.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "freepath/io/image.h"
#include "tests/scene/image_file.h"
#include "tests/scene/rendered_scenes.h"
#include "tests/scene/scattered_twice.h"

namespace freepath::testing {
namespace {

TEST(LobeSplitting, LayerUnderASunIsThatOfQuadrature) {
  for (const LitLayer& layer : {LitLayer{0.05, 1.2, 0.8, Vec3d(0.5, 0, 0.75).normalized()},
                                LitLayer{0.3, 2, 0.6, Vec3d(0, 0.3, 0.9).normalized()},
                                LitLayer{0, 1, -0.7, Vec3d(0.3, 0, -0.8).normalized()}}) {
    const double expected = layer.once() + layer.twice();
    for (const ColorMode mode : kColorModes) {
      expect_mean(fmt::format("{} g {}", name_of(mode), layer.g),
                  render_text(layer.scene(16), {.mode = mode, .samples = 4096}),
                  {expected, expected, expected}, {.absolute = 0, .largest_relative_error = 0.001});
    }
  }
}

// Without branches of much weight that test would say little of them.
TEST(LobeSplitting, BranchesBringMuchOfTheLightAndOfThePeaks) {
  const LitLayer layer{0.05, 1.2, 0.8, Vec3d(0.5, 0, 0.75).normalized()};
  const Picture on = render_text(layer.scene(16), {.samples = 256});
  const Picture off = render_text(layer.scene(16), {.samples = 256, .lobe_splitting = false});
  EXPECT_LT(on.error[1], 0.85 * off.error[1]);
}

TEST(LobeSplitting, EveryTrackerFliesBranches) {
  const std::string world =
      R"(LightSource "distant" "rgb L" [ 2 3 4 ] "point3 from" [ 0.4 0.3 1 ] "point3 to" [ 0 0 0 ]
MakeNamedMedium "cloud" "string type" "uniformgrid" "rgb sigma_a" [ 0.1 0.4 0.9 ] "rgb sigma_s" [ 4 2 1 ]
  "integer nx" 3 "integer ny" 2 "integer nz" 1 "float density" [ 1 0.3 0.6 0.5 1 0.8 ] "float g" 0.75
  "point3 p0" [ -1 -1 -1 ] "point3 p1" [ 1 1 1 ]
)" + medium_box("cloud", Vec3d(-1), Vec3d(1));
  for (const char* const tracker : {"delta", "weighted-delta", "decomposition", "spectral",
                                    "hero-wavelength", "spectral-decomposition"}) {
    const std::string text =
        fmt::format("Integrator \"volpath\" \"integer maxdepth\" 50 \"string tracker\" \"{}\"\n",
                    tracker) +
        film(8) + "LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 16\n" +
        "WorldBegin\n" + world;
    expect_alike(tracker, render_text(text, {.samples = 1024}),
                 render_text(text, {.samples = 2048, .lobe_splitting = false}),
                 {.largest_relative_error = 0.02});
  }
}

/// Bodies, overlapping media with lobes of their own, of which one glows, two suns, of which paths
/// split towards the brighter, and lamps outside and within media.
const std::string kSunAndManyThings =
    kUnlimited + film(12) +
    R"(LookAt 0 0.3 -4  0 0 0  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
LightSource "distant" "rgb L" [ 6 5 4 ] "point3 from" [ 0.3 0.5 1 ] "point3 to" [ 0 0 0 ]
LightSource "distant" "rgb L" [ 0.5 0.5 1 ] "point3 from" [ -1 0.2 0 ] "point3 to" [ 0 0 0 ]
LightSource "point" "rgb I" [ 1 2 1 ] "point3 from" [ 0.9 1.2 3 ]
LightSource "point" "rgb I" [ 0.2 0.1 0.1 ] "point3 from" [ 0.6 0.8 0.1 ]
LightSource "infinite" "rgb L" [ 0.1 0.1 0.2 ]
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 0.1 0.2 0.1 ] "rgb sigma_s" [ 0.7 0.7 0.8 ] "float g" 0.6
MakeNamedMedium "cloud" "string type" "uniformgrid" "rgb sigma_a" [ 0.1 0.2 0 ] "rgb sigma_s" [ 2 2 1 ] "float g" 0.8 "rgb Le" [ 0.5 0.2 0 ]
  "integer nx" 3 "integer ny" 2 "integer nz" 1 "float density" [ 1 0.3 0 0.5 1 0.8 ] "point3 p0" [ -0.7 -0.7 -0.7 ] "point3 p1" [ 0.6 0.7 0.7 ]
)" + medium_box("fog", Vec3d(-1), Vec3d(1)) +
    medium_box("cloud", Vec3d(-0.7), Vec3d(0.6, 0.7, 0.7), "fog") +
    R"(AttributeBegin Material "diffuse" "rgb reflectance" [ 0.7 0.5 0.3 ]
  Shape "bilinearmesh" "point3 P" [ -2 -0.8 -2  2 -0.8 -2  -2 -0.8 2  2 -0.8 2 ] AttributeEnd
AttributeBegin Material "conductor" "float roughness" 0.3 Translate 0 0.1 -0.3
  Shape "sphere" "float radius" 0.2 AttributeEnd
AttributeBegin Material "dielectric" Translate 0.4 0.1 -0.5
  Shape "sphere" "float radius" 0.2 AttributeEnd
)";

TEST(LobeSplitting, AgreesWithPathsAloneAmongSurfacesAndOverlappingMedia) {
  for (const ColorMode mode : kColorModes) {
    const Picture on = render_text(kSunAndManyThings, {.mode = mode, .samples = 1024});
    const Picture off =
        render_text(kSunAndManyThings, {.mode = mode, .samples = 1024, .lobe_splitting = false});
    expect_alike(name_of(mode), on, off, {.largest_relative_error = 0.03});
  }
}

/// A sun of an image, of some 5 degrees, in a weak sky.
class ImageSun {
 public:
  std::string light() const { return "LightSource \"infinite\" " + image_.parameter() + "\n"; }

 private:
  ImageFile image_{"sun.exr", 64, 64, [](int column, int row) {
                     const bool is_sun = column >= 40 && column < 43 && row >= 30 && row < 33;
                     return is_sun ? Vec3f(90, 80, 60) : Vec3f(0.1F, 0.1F, 0.2F);
                   }};
};

// Paths find such a sun by chance too, and so do branches.
TEST(LobeSplitting, AgreesWithPathsAloneUnderAnImageWithASun) {
  const ImageSun sun;
  const std::string text =
      kUnlimited + film(12) +
      "LookAt 1 0.5 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 25\nWorldBegin\n" +
      sun.light() +
      R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ 2 3 1 ] )"
      R"("rgb sigma_a" [ 0.02 0 0.1 ] "float g" 0.85)"
      "\n" +
      medium_box("fog", Vec3d(-1), Vec3d(1));
  for (const ColorMode mode : kColorModes) {
    const Picture on = render_text(text, {.mode = mode, .samples = 1024});
    const Picture off = render_text(text, {.mode = mode, .samples = 2048, .lobe_splitting = false});
    expect_alike(name_of(mode), on, off, {.largest_relative_error = 0.015});
    for (int c = 0; c < 3; ++c) EXPECT_LT(on.error[c], 1.2 * off.error[c]);
  }
}

// Density and length of what is drawn depend on the place there, which splitting need not know.
TEST(LobeSplitting, AgreesWithPathsAloneInHazeAndUnderAPortal) {
  const std::string haze =
      "MakeNamedMedium \"haze\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.1 0.1 0.1 ] "
      "\"rgb sigma_s\" [ 0.05 0.05 0.05 ]\nMediumInterface \"\" \"haze\"\n";
  const std::string sun =
      R"(LightSource "distant" "rgb L" [ 1 1 1 ] "point3 from" [ 0 1 1 ] "point3 to" [ 0 0 0 ])"
      "\n";
  const ImageSun image;
  std::string portal = image.light();
  portal.insert(portal.size() - 1, R"( "point3 portal" [ -9 -9 3  -9 9 3  9 9 3  9 -9 3 ])");
  const auto expect_agreement = [](const std::string& before, const std::string& light) {
    const std::string text =
        kUnlimited + film(8) + "LookAt 0 0 -4  0 0 0  0 1 0\n" + before +
        "Camera \"perspective\" \"float fov\" 20\nWorldBegin\n" + light +
        R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 0 0 0 ]
  "rgb sigma_s" [ 2 2 2 ] "float g" 0.8)"
        "\n" +
        medium_box("fog", Vec3d(-1), Vec3d(1));
    expect_alike(light, render_text(text, {.samples = 2048}),
                 render_text(text, {.samples = 4096, .lobe_splitting = false}),
                 {.absolute = 1e-6, .largest_relative_error = 0.03});
  };
  expect_agreement(haze, sun);
  expect_agreement("", portal);
}

TEST(LobeSplitting, PictureDependsOnNoCutOfTheWork) {
  for (const ColorMode mode : kColorModes) {
    const Picture whole = render_text(kSunAndManyThings, {.mode = mode, .samples = 4});
    const Picture parts =
        render_text(kSunAndManyThings, {.mode = mode, .samples = 4, .threads = 1, .batch = 7});
    EXPECT_EQ(whole.image.values, parts.image.values) << name_of(mode);
  }
}

// Where no light from outside outshines others, or phase functions have no lobes.
TEST(LobeSplitting, IsLeftOutWhereItCantHelp) {
  const std::string sun =
      R"(LightSource "distant" "rgb L" [ 1 1 1 ] "point3 from" [ 0 1 1 ] "point3 to" [ 0 0 0 ])"
      "\n";
  const auto scene = [](const std::string& light, double g) {
    return kUnlimited + film(8) +
           "LookAt 0 0 -4  0 0 0  0 1 0\n"
           "Camera \"perspective\" \"float fov\" 20\nWorldBegin\n" +
           light +
           fmt::format(R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 0 0 0 ]
  "rgb sigma_s" [ 1 1 1 ] "float g" {})"
                       "\n",
                       g) +
           medium_box("fog", Vec3d(-1), Vec3d(1));
  };
  const auto expect_same = [](const std::string& text) {
    const Picture on = render_text(text, {.samples = 4});
    const Picture off = render_text(text, {.samples = 4, .lobe_splitting = false});
    EXPECT_EQ(on.image.values, off.image.values) << text;
  };
  expect_same(scene(sun, 0.2));
  expect_same(scene("LightSource \"point\" \"point3 from\" [ 0 3 0 ]\n", 0.8));
}

// What is scattered once is in the layer of that.
TEST(LobeSplitting, LayersTellWhatWasScatteredOnce) {
  const LitLayer layer{0.05, 1.2, 0.8, Vec3d(0.5, 0, 0.75).normalized()};
  const Image image = image_with_layers(layer.scene(16), 512);
  EXPECT_TRUE(check_mean("direct", statistics_of(image, "direct.R"), layer.once(),
                         {.largest_relative_error = 0.01}));
  EXPECT_TRUE(check_mean("indirect", statistics_of(image, "indirect.R"), layer.twice(),
                         {.largest_relative_error = 0.01}));
}

}  // namespace
}  // namespace freepath::testing
