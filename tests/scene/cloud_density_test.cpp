// The procedural cloud of the scene language.

#include "freepath/scene/assembly/cloud_density.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/scene/rendered_scenes.h"

namespace freepath {
namespace {

TEST(CloudDensity, TheNoiseIsThatOfTheReferenceImplementation) {
  // What Perlin's program of 2002 prints for this point.
  EXPECT_NEAR(lattice_noise({3.14, 42, 7}), 0.13691995878400012, 1e-12);
  EXPECT_EQ(lattice_noise({-5, 12, 300}), 0);
  EXPECT_NEAR(lattice_noise({3.14 - 256, 42 + 256, 7}), lattice_noise({3.14, 42, 7}), 1e-9);
}

TEST(CloudDensity, IsSolidBelowAndClearAbove) {
  const CloudDensity cloud;
  for (int i = 0; i < 1000; ++i) {
    const double x = 0.0131 * i;
    const double z = 0.0297 * i;
    EXPECT_EQ(cloud.at({x, 0, z}), 1);
    EXPECT_EQ(cloud.at({x, 1, z}), 0);
    const double inside = cloud.at({x, 0.001 * i, z});
    EXPECT_GE(inside, 0);
    EXPECT_LE(inside, 1);
  }
}

/// exp(-sigma ∫ density) along z through the middle of the box, which is 2 wide in the world.
double transmittance(const CloudDensity& cloud, double sigma) {
  constexpr int kSteps = 20000;
  double depth = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double z = cloud.p0.z + (i + 0.5) / kSteps * (cloud.p1.z - cloud.p0.z);
    depth += cloud.at({0.5, 0.55, z}) * (cloud.p1.z - cloud.p0.z);
  }
  return std::exp(-sigma * 2 * depth / kSteps);
}

/// @param parameters of the medium that are those of the cloud
void expect_transmittance(const CloudDensity& cloud, const std::string& parameters) {
  // A pixel so narrow that all rays are one, through a box that stands doubled in the world.
  const testing::Picture picture = testing::render_text(R"(
    Film "rgb" "integer xresolution" 1 "integer yresolution" 1
    PixelFilter "box"
    LookAt 1 1.1 -10  1 1.1 0  0 1 0
    Camera "perspective" "float fov" 0.0001
    Integrator "volpath" "integer maxdepth" 100
    WorldBegin
    LightSource "infinite" "rgb L" [ 1 1 1 ]
    AttributeBegin
      Scale 2 2 2
      MakeNamedMedium "cloud" "string type" "cloud" "spectrum sigma_a" [ 300 0.7 900 0.7 ]
        "spectrum sigma_s" [ 300 0 900 0 ] )" + parameters +
                                                            R"(
      MediumInterface "cloud" ""
      Material "interface"
      Translate 0.5 0.5 0.5
      Shape "sphere" "float radius" 2
    AttributeEnd)",
                                                        {.samples = 40'000});
  testing::expect_sound(picture);
  const double expected = transmittance(cloud, 0.7);
  ASSERT_GT(expected, 0.2);
  ASSERT_LT(expected, 0.8);
  for (int c = 0; c < 3; ++c) {
    EXPECT_LT(picture.error[c], 0.005 * expected);
    EXPECT_NEAR(picture.mean[c], expected, 4 * picture.error[c]);
  }
}

TEST(CloudDensity, ARayThroughTheCloudSeesItsTransmittance) {
  expect_transmittance(CloudDensity(), "");
}

TEST(CloudDensity, ItsParametersAreThoseOfTheMedium) {
  expect_transmittance({.density = 3,
                        .wispiness = 0.6,
                        .frequency = 4,
                        .p0 = Vec3d(0, 0, 0.2),
                        .p1 = Vec3d(1, 1, 1.1)},
                       R"("float density" 3 "float wispiness" .6 "float frequency" 4 )"
                       R"("point3 p0" [ 0 0 .2 ] "point3 p1" [ 1 1 1.1 ])");
}

}  // namespace
}  // namespace freepath
