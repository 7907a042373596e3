// Lamps seen from within spheres of glass, with and without draws of them.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <string>

#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

const std::string kLook =
    kUnlimited + film(8) +
    "LookAt 0.5 0.4 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 26\nWorldBegin\n";

/// A lamp that shines down, a ball that shines, and one that no glass refracts.
const std::string kLamps =
    R"(LightSource "point" "rgb I" [ 1 1 1 ] "point3 from" [ -2 1 -2 ]
AttributeBegin AreaLightSource "diffuse" "rgb L" [ 9 8 7 ] Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  Translate 0.6 2.2 0.2 Rotate 90 1 0 0 Shape "disk" "float radius" 1.6 AttributeEnd
AttributeBegin AreaLightSource "diffuse" "rgb L" [ 7 9 4 ] Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  Translate -2.4 0.2 0.9 Shape "sphere" "float radius" 1 AttributeEnd
)";

std::string juice(double sigma_s, double sigma_a, double g) {
  return fmt::format(R"(MakeNamedMedium "juice" "string type" "homogeneous" "float g" {} )"
                     R"("rgb sigma_s" [ {} {} {} ] "rgb sigma_a" [ {} {} {} ])"
                     "\n",
                     g, sigma_s, sigma_s, sigma_s * 0.5, sigma_a, sigma_a * 2, sigma_a);
}

std::string ball(const std::string& medium, double eta, double radius = 1) {
  return fmt::format(
      "AttributeBegin MediumInterface \"{}\" \"\" Material \"dielectric\" \"float eta\" {}\n"
      "Shape \"sphere\" \"float radius\" {} AttributeEnd\n",
      medium, eta, radius);
}

void expect_same_by_chance(const std::string& name, const std::string& scene, uint32_t samples,
                           uint32_t by_chance) {
  for (const ColorMode mode : kColorModes) {
    expect_alike(
        fmt::format("{} {}", name, name_of(mode)),
        render_text(scene, {.mode = mode, .samples = samples}),
        render_text(scene,
                    {.mode = mode, .samples = by_chance, .seed = 6, .light_through_glass = false}),
        {.largest_relative_error = 0.012});
  }
}

TEST(GlassSpheres, LampsBringWhatPathsFindByChance) {
  for (const double eta : {1.5, 0.8}) {
    expect_same_by_chance(fmt::format("eta {}", eta),
                          kLook + kLamps + juice(1.5, 0.2, 0.6) + ball("juice", eta), 3072, 9216);
  }
}

// What lies in the ball and around it has its shadow, and a ball in the ball sees no lamp.
TEST(GlassSpheres, WhatIsInTheWayIsSeen) {
  const std::string fog =
      R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ 0.2 0.1 0.2 ] )"
      R"("rgb sigma_a" [ 0 0.1 0 ])"
      "\n";
  const std::string things =
      R"(AttributeBegin MediumInterface "" "juice" Material "diffuse" "rgb reflectance" [ 0.8 0.4 0.4 ]
  Translate 0.3 0.4 0 Shape "sphere" "float radius" 0.3 AttributeEnd
AttributeBegin MediumInterface "juice" "juice" Material "dielectric" "float eta" 1.3
  Translate -0.3 -0.3 0 Shape "sphere" "float radius" 0.4 AttributeEnd
AttributeBegin MediumInterface "" "fog" Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
  Translate 0.4 1.6 0 Rotate 90 1 0 0 Shape "disk" "float radius" 0.3 AttributeEnd
)";
  std::string glass = ball("juice", 1.5);
  glass.replace(glass.find("\"\" Material"), 2, "\"fog\"");
  const std::string scene = kLook + kLamps + juice(1.5, 0.1, 0) + fog + glass + things +
                            medium_box("fog", Vec3d(-1.3), Vec3d(1.4, 2, 1.3));
  expect_same_by_chance("things", scene, 2048, 6144);
}

TEST(GlassSpheres, SeeLessVarianceThanChance) {
  const std::string scene = kLook + kLamps + juice(1.5, 0.2, 0.6) + ball("juice", 1.5);
  const Picture drawn = render_text(scene, {.samples = 256});
  const Picture chance = render_text(scene, {.samples = 256, .light_through_glass = false});
  EXPECT_LT(drawn.error[1], 0.7 * chance.error[1]);
}

// Rough, cut, distorted and dispersive balls are not drawn through.
TEST(GlassSpheres, OthersAreLeftToChance) {
  for (const std::string& shape :
       {std::string(R"(Material "dielectric" "float roughness" 0.1 Shape "sphere")"),
        std::string(R"(Material "dielectric" Shape "sphere" "float zmax" 0.5)"),
        std::string(R"(Material "dielectric" Scale 1 1.2 1 Shape "sphere")"),
        std::string(R"(Material "dielectric" "spectrum eta" "glass-BK7" Shape "sphere")"),
        std::string(R"(Material "dielectric" ReverseOrientation Shape "sphere")")}) {
    const std::string begin = kLook + kLamps + juice(1.5, 0.2, 0);
    const std::string scene = fmt::format(
        "{}AttributeBegin MediumInterface \"juice\" \"\"\n{}\nAttributeEnd\n", begin, shape);
    const Picture on = render_text(scene, {.samples = 4});
    const Picture off = render_text(scene, {.samples = 4, .light_through_glass = false});
    EXPECT_EQ(on.image.values, off.image.values) << shape;
  }
}

}  // namespace
}  // namespace freepath::testing
