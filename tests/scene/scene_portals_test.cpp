// Portals looked through: from the camera, in a mirror and across boundaries, wherever the scene
// has its centre.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <string>

#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

/// Places of a far small sphere, which moves the centre of the scene before, into and behind the
/// portal.
constexpr double kFarSpheres[] = {-3.3, -13, -1003, 1000};

/// A portal of 1.6 x 2.4 at z = 2, open towards -z, before a white sky; the camera is at z = -3.
std::string portal_scene(double look_at, double far_sphere, const std::string& world) {
  return kUnlimited + film(64) +
         fmt::format(R"(
    LookAt 0 0 -3  0 0 {}  0 1 0
    Camera "perspective" "float fov" 90
    WorldBegin
    LightSource "infinite" "rgb L" [ 1 1 1 ]
      "point3 portal" [ -.8 -1.2 2  -.8 1.2 2  .8 1.2 2  .8 -1.2 2 ]
    AttributeBegin
      Translate 0 50 {}
      Material "diffuse"
      Shape "sphere" "float radius" 0.1
    AttributeEnd
    )",
                     look_at, far_sphere) +
         world;
}

/// The window is a rectangle in the middle of the film, which reaches `x` and `y` pixels to all
/// sides; pixels at its edge are parts of it.
void expect_window(const Picture& picture, double x, double y, double radiance) {
  const auto share = [](double distance, double half) {  // of a pixel's width
    return std::clamp(half - (std::abs(distance) - 0.5), 0.0, 1.0);
  };
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 64; ++column) {
      const double covered = share(column - 31.5, x) * share(row - 31.5, y);
      const float seen = picture.image.pixel(column, row)[1];
      if (covered == 0 || covered == 1) {
        ASSERT_NEAR(seen, covered * radiance, 0.002) << column << ", " << row;
      } else {
        ASSERT_GE(seen, 0);
        ASSERT_LE(seen, radiance + 0.002);
      }
    }
  }
}

TEST(ScenePortals, AreSeenFromTheCamera) {
  for (const double far : kFarSpheres) {
    SCOPED_TRACE(far);
    const Picture picture = render_text(portal_scene(0, far, ""), {.samples = 4});
    expect_window(picture, 32 * 0.8 / 5, 32 * 1.2 / 5, 1);
  }
}

TEST(ScenePortals, AreSeenInAMirror) {
  // At z = -5, so that the camera's image is at z = -7.
  const std::string mirror = R"(
    Material "conductor" "rgb reflectance" [ .5 .5 .5 ] "float roughness" 0
    Shape "bilinearmesh" "point3 P" [ -9 -9 -5  9 -9 -5  -9 9 -5  9 9 -5 ]
  )";
  for (const double far : kFarSpheres) {
    SCOPED_TRACE(far);
    const Picture picture = render_text(portal_scene(-9, far, mirror), {.samples = 4});
    expect_window(picture, 32 * 0.8 / 9, 32 * 1.2 / 9, 0.5);
  }
}

// A ray that has crossed a boundary behind the portal has come through it all the same.
TEST(ScenePortals, AreSeenAcrossBoundaries) {
  const std::string boundary = R"(
    MakeNamedMedium "clear" "string type" "homogeneous" "rgb sigma_a" [ 0 0 0 ] "rgb sigma_s" [ 0 0 0 ]
    AttributeBegin
      Material "interface"
      MediumInterface "clear" ""
      Translate 0 0 6
      Shape "sphere" "float radius" 2
    AttributeEnd
  )";
  for (const ColorMode mode : kColorModes) {
    const Picture picture = render_text(portal_scene(0, -13, boundary), {.mode = mode});
    expect_window(picture, 32 * 0.8 / 5, 32 * 1.2 / 5, 1);
  }
}

}  // namespace
}  // namespace freepath::testing
