// White furnaces: where nothing absorbs and light of radiance 1 comes from everywhere, everything
// has the radiance 1.

#include <gtest/gtest.h>

#include <string>

#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

const std::string kCamera =
    "LookAt 0.4 0.7 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 38\n";
const std::string kLight = "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n";

std::string furnace(const std::string& world, const std::string& settings = kUnlimited) {
  return settings + film() + kCamera + "WorldBegin\n" + kLight + world;
}

void expect_white(const std::string& scene, uint32_t samples) {
  for (const ColorMode mode : kColorModes) {
    SCOPED_TRACE(name_of(mode));
    expect_mean("furnace", render_text(scene, {.mode = mode, .samples = samples}), {1, 1, 1},
                {.absolute = 3e-5, .largest_relative_error = 0.004});
  }
}

/// A medium that only scatters.
std::string white_medium(const std::string& name, double sigma_s, double g) {
  return fmt::format(R"(MakeNamedMedium "{}" "string type" "homogeneous" "rgb sigma_a" [ 0 0 0 ] )"
                     "\"rgb sigma_s\" [ {} {} {} ] \"float g\" {}\n",
                     name, sigma_s, sigma_s, sigma_s, g);
}

TEST(SceneFurnace, HomogeneousBox) {
  expect_white(furnace(white_medium("fog", 2.5, 0.4) + medium_box("fog", Vec3d(-1), Vec3d(1))),
               256);
}

TEST(SceneFurnace, UniformGrid) {
  std::string voxels;
  for (int i = 0; i < 60; ++i) voxels += std::to_string(i * 7 % 5) + " ";
  expect_white(furnace(R"(MakeNamedMedium "cloud" "string type" "uniformgrid" )"
                       R"("rgb sigma_a" [ 0 0 0 ] "rgb sigma_s" [ 2 2 2 ] "float g" -0.3 )"
                       R"("point3 p0" [ -1 -1 -1 ] "point3 p1" [ 1 1 1 ] )"
                       R"("integer nx" 3 "integer ny" 4 "integer nz" 5 )"
                       R"("float density" [ )" +
                       voxels + "]\n" + medium_box("cloud", Vec3d(-1.01), Vec3d(1.01))),
               256);
}

// A grid that is not given would be 1.
TEST(SceneFurnace, GridOfColours) {
  expect_white(furnace(R"(MakeNamedMedium "cloud" "string type" "rgbgrid" )"
                       R"("point3 p0" [ -1 -1 -1 ] "point3 p1" [ 1 1 1 ] )"
                       R"("integer nx" 2 "integer ny" 1 "integer nz" 2 )"
                       R"("rgb sigma_a" [ 0 0 0  0 0 0  0 0 0  0 0 0 ] )"
                       "\"rgb sigma_s\" [ 1 2 3  2 2 .5  0 1 0  3 3 3 ]\n" +
                       medium_box("cloud", Vec3d(-1.01), Vec3d(1.01))),
               2048);
}

TEST(SceneFurnace, DiffuseSphere) {
  expect_white(furnace("Material \"diffuse\" \"rgb reflectance\" [ 1 1 1 ] Shape \"sphere\"\n"),
               256);
}

TEST(SceneFurnace, DielectricSphere) {
  expect_white(furnace("Material \"dielectric\" \"float eta\" 1.5 Shape \"sphere\"\n"), 128);
}

// Dispersion: after the first refraction a path carries its hero alone.
TEST(SceneFurnace, SphereOfDispersingGlass) {
  expect_white(furnace("Material \"dielectric\" \"spectrum eta\" \"glass-F11\" Shape \"sphere\"\n"),
               1024);
}

TEST(SceneFurnace, EmissionFillsWhatAbsorptionTakes) {
  expect_white(
      furnace(R"(MakeNamedMedium "fire" "string type" "homogeneous" "rgb sigma_a" [ 2 1 .5 ] )"
              "\"rgb sigma_s\" [ 1 1.5 2 ] \"rgb Le\" [ 1 1 1 ] \"float scale\" 0.8\n" +
              medium_box("fire", Vec3d(-1), Vec3d(1))),
      512);
}

TEST(SceneFurnace, CameraInsideTheMedium) {
  const std::string medium = white_medium("fog", 2, 0.2);
  expect_white(kUnlimited + film() + medium +
                   "LookAt 0 0 0  0 0.3 1  0 1 0\nMediumInterface \"\" \"fog\"\n"
                   "Camera \"perspective\" \"float fov\" 80\nWorldBegin\n" +
                   kLight + medium_box("fog", Vec3d(-1), Vec3d(1)),
               256);
}

/// Media that overlap and lie within each other, two of them grids.
std::string white_media() {
  std::string voxels;
  for (int i = 0; i < 27; ++i) voxels += std::to_string(i * 7 % 5) + " ";
  const std::string grid =
      R"("integer nx" 3 "integer ny" 3 "integer nz" 3 "rgb sigma_a" [ 0 0 0 ] "float density" [ )" +
      voxels + "]\n";
  const std::string colours =
      R"("integer nx" 2 "rgb sigma_a" [ 0 0 0  0 0 0 ] "rgb sigma_s" [ 1 2 3  3 1 .5 ])";
  return white_medium("fog", 1.5, 0.6) + white_medium("mist", 0.7, -0.2) +
         white_medium("milk", 6, 0) +
         R"(MakeNamedMedium "cloud" "string type" "uniformgrid" "rgb sigma_s" [ 1 1 1 ] )"
         R"("string phase" "0.6*droplets:diameter=10+0.4*rayleigh" )"
         R"("point3 p0" [ -1.3 .5 -.3 ] "point3 p1" [ -.3 1.3 .9 ] )" +
         grid +
         R"(MakeNamedMedium "dye" "string type" "rgbgrid" "point3 p0" [ .2 -1.1 -.8 ] )"
         R"("point3 p1" [ .8 -.4 .3 ] )" +
         colours + medium_box("fog", Vec3d(-1.2), Vec3d(0.9, 1, 0.7)) +
         medium_box("mist", Vec3d(-0.3), Vec3d(1.4, 0.8, 1)) +                 // overlaps
         medium_box("milk", Vec3d(-1, -1, -1), Vec3d(-0.6, -0.4, 0), "fog") +  // nested
         medium_box("cloud", Vec3d(-1.3, 0.5, -0.3), Vec3d(-0.3, 1.3, 0.9)) +
         medium_box("dye", Vec3d(0.2, -1.1, -0.8), Vec3d(0.8, -0.4, 0.3), "fog");
}

/// Every shape and every material that can be white, some within the media.
std::string white_things() {
  return R"(
      MakeNamedMaterial "mirror" "string type" "conductor" "spectrum eta" [ 300 0 900 0 ]
        "spectrum k" [ 300 1.5 900 1.5 ]
      MakeNamedMaterial "chalk" "string type" "diffuse" "rgb reflectance" [ 1 1 1 ]
      AttributeBegin
        Translate -0.6 0.5 -0.2 NamedMaterial "chalk" Shape "sphere" "float radius" 0.4
      AttributeEnd
      AttributeBegin
        Translate 0.7 0.4 -1.4 Material "dielectric" "float eta" 1.33 MediumInterface "milk" ""
        Shape "sphere" "float radius" 0.45
      AttributeEnd
      AttributeBegin
        Translate 0.5 -0.7 -1.3 Material "dielectric" "float eta" 1.5 "float roughness" 1e-7
        Shape "sphere" "float radius" 0.4
      AttributeEnd
      AttributeBegin
        Translate -0.4 -0.2 -2 Rotate 30 0 1 0 Material "thindielectric"
        Shape "disk" "float radius" 0.3
      AttributeEnd
      AttributeBegin
        Translate -0.9 -0.5 -1.6 Rotate 70 1 0.3 0 NamedMaterial "chalk"
        Shape "cylinder" "float radius" 0.2 "float zmin" -0.3 "float zmax" 0.3
      AttributeEnd
      AttributeBegin
        Translate -0.8 0.9 -1.2
        Material "mix" "string materials" [ "mirror" "chalk" ] "float amount" 0.4
        Shape "bilinearmesh" "point3 P" [ -.3 -.3 0  .3 -.3 .2  -.3 .3 -.1  .3 .3 .1 ]
      AttributeEnd
      AttributeBegin
        Translate 0.1 1 -1 Scale 0.35 0.35 0.35
        Material "coateddiffuse" "rgb reflectance" [ 1 1 1 ] "float thickness" 0
          "integer maxdepth" 10000
        Shape "loopsubdiv" "integer levels" 2
          "point3 P" [ 1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1 ]
          "integer indices" [ 0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5 ]
      AttributeEnd
      ObjectBegin "stone"
        NamedMaterial "chalk"
        Shape "trianglemesh" "point3 P" [ 0 0 0  .5 0 0  0 .5 0  0 0 .5 ]
          "integer indices" [ 0 2 1  0 1 3  0 3 2  1 2 3 ]
      ObjectEnd
      AttributeBegin Translate 0.9 -0.2 -0.2 ObjectInstance "stone" AttributeEnd
      AttributeBegin Translate -0.2 -1 -1.2 Scale -.8 .8 .8 ObjectInstance "stone" AttributeEnd)";
}

std::string everything() { return white_media() + white_things(); }

// Nearly: what a rough surface scatters twice within itself it loses, and so it must be smooth.
TEST(SceneFurnace, EverythingAtOnce) { expect_white(furnace(everything()), 512); }

// The power of these tests: an albedo of 0.99 must fail them.
TEST(SceneFurnace, LossOfOnePercentIsNoticed) {
  const std::string grey =
      R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ .025 .025 .025 ] )"
      "\"rgb sigma_s\" [ 2.475 2.475 2.475 ] \"float g\" 0.4\n";
  const Picture picture =
      render_text(furnace(grey + medium_box("fog", Vec3d(-1), Vec3d(1))), {.samples = 256});
  EXPECT_LT(z_score(picture.mean[1], picture.error[1], 1.0), -6);
}

}  // namespace
}  // namespace freepath::testing
