// Cameras that take the place of a scene's own: what they show, and which media they stand in.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "freepath/scene/assembly/camera_change.h"
#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

Picture changed_picture(const std::string& text, const CameraChange& change,
                        uint32_t samples = 64) {
  Diagnostics diagnostics;
  const PbrtScene pbrt = parse(text, diagnostics);
  Picture picture =
      picture_of(build_scene(pbrt, diagnostics, {.camera = change}), {.samples = samples});
  picture.warnings = diagnostics.warnings();
  return picture;
}

void expect_share_lit(const std::string& name, const Picture& picture, double share) {
  expect_mean(name, picture, {share, share, share},
              {.absolute = 1e-4 * share, .largest_relative_error = 0.004});
}

/// A disk of radiance 1 at (0.2, -0.1, 4), of radius 1.2, seen by a camera of the file.
std::string disk_before(const std::string& camera) {
  return "Integrator \"volpath\" \"integer maxdepth\" 1\n" + film() + camera +
         "\nWorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
         R"(AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] "bool twosided" true )"
         "Translate .2 -.1 0 Shape \"disk\" \"float height\" 4 \"float radius\" 1.2\n";
}

constexpr double kDiskArea = std::numbers::pi * 0.3 * 0.3;  // at a distance of 1

TEST(ChangedCamera, KeepsTheAngleOfViewThatIsNotGiven) {
  const double edge = 2 * std::tan(50 * std::numbers::pi / 360);
  const std::string scene = disk_before(R"(Camera "perspective" "float fov" 50)");
  const CameraChange same_position{.from = Vec3d(0), .at = Vec3d(0, 0, 1)};
  expect_share_lit("own", changed_picture(scene, same_position, 1024), kDiskArea / (edge * edge));
  const double wide = 2 * std::tan(70 * std::numbers::pi / 360);
  expect_share_lit("wide", changed_picture(scene, {.fov = 70}, 1024), kDiskArea / (wide * wide));
}

// As wide as the perspective camera where the middle of the shapes is, 4 ahead.
TEST(ChangedCamera, OrthographicIsAsWideAsItsOwnWasWhereItLooksAt) {
  const double edge = 8 * std::tan(50 * std::numbers::pi / 360);
  const Picture picture = changed_picture(disk_before(R"(Camera "perspective" "float fov" 50)"),
                                          {.kind = CameraKind::kOrthographic}, 1024);
  expect_share_lit("parallel", picture, std::numbers::pi * 1.44 / (edge * edge));
}

// Also where a scene has made pbrt's axes right-handed.
TEST(ChangedCamera, ShowsRightAndUpAsItsOwnDid) {
  const std::string light =
      "\nWorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
      R"(AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] "bool twosided" true )"
      "Translate 1 1 0 Shape \"disk\" \"float height\" 4 \"float radius\" .8\n";
  const std::string one = "Integrator \"volpath\" \"integer maxdepth\" 1\n" + film();
  for (const std::string look :
       {"LookAt 0 0 -1 0 0 4 0 1 0\n", "LookAt 0 0 -1 0 0 4 1 0 0\n",
        "LookAt 0 0 9 0 0 4 .3 .9 0\n", "Scale -1 1 1 LookAt 0 0 -1 0 0 4 .3 .9 0\n"}) {
    const std::string scene =
        fmt::format(R"({}{}Camera "perspective" "float fov" 50{})", one, look, light);
    const Image own = render_text(scene).image;
    const Image changed = changed_picture(scene, {.fov = 50}).image;
    double difference = 0;
    double sum = 0;
    for (std::size_t i = 0; i < own.pixel_count(); ++i) {
      const std::size_t red = i * own.channels.size() + *find_channel(own, "R");
      difference += std::abs(own.values[red] - changed.values[red]);
      sum += own.values[red];
    }
    EXPECT_GT(sum, 8) << look;
    EXPECT_LT(difference, 0.02 * sum) << look;  // some samples of the edge
  }
}

/// A shell of absorption 0.4 from radius 1 to 3 in white light; the camera's statement is given.
std::string shell(const std::string& camera) {
  return film(4) +
         R"(MakeNamedMedium "fog" "string type" "homogeneous" )"
         R"("rgb sigma_a" [ .4 .4 .4 ] "rgb sigma_s" [ 0 0 0 ])"
         "\n" +
         camera +
         "\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\nMaterial \"interface\"\n"
         "AttributeBegin\nMediumInterface \"fog\" \"\"\nShape \"sphere\" \"float radius\" 3\n"
         "AttributeEnd\nAttributeBegin\nMediumInterface \"\" \"fog\"\n"
         "Shape \"sphere\" \"float radius\" 1\nAttributeEnd\n";
}

TEST(ChangedCamera, StandsInTheMediaOfItsPlace) {
  constexpr uint32_t kManySamples = 20000;
  struct Position {
    const char* name;
    std::string camera;
  };
  const Position positions[] = {
      {"outside", "LookAt 0 0 -9 0 0 0 0 1 0 Camera \"perspective\""},
      {"within", R"(MediumInterface "" "fog" LookAt 0 0 -2 0 0 0 0 1 0 Camera "perspective")"},
      {"middle", "Camera \"perspective\""},
  };
  for (const Position& own : positions) {
    const std::string scene = shell(own.camera);
    // From the middle it is the same way out in all directions.
    expect_share_lit(
        std::string(own.name) + " to the middle",
        changed_picture(scene,
                        {.kind = CameraKind::kSpherical, .from = Vec3d(0), .at = Vec3d(1, 0, 0)},
                        kManySamples),
        std::exp(-0.8));
    expect_share_lit(
        std::string(own.name) + " to the fog",
        changed_picture(
            scene, {.fov = 0.1, .from = Vec3d(0, 2, 0), .at = Vec3d(0, 9, 0), .up = UpAxis::kY},
            kManySamples),
        std::exp(-0.4));
    expect_share_lit(std::string(own.name) + " to the outside",
                     changed_picture(scene, {.fov = 0.1, .from = Vec3d(7, 0, 0)}, kManySamples),
                     std::exp(-1.6));
  }
}

// A disk to the right of the picture's middle, whatever the handedness.
TEST(ChangedCamera, SphericalHasRightToTheRight) {
  const std::string light =
      "\nWorldBegin\nAreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ] \"bool twosided\" true\n"
      "Translate 3 0 0 Shape \"sphere\" \"float radius\" 1\n";
  for (const bool is_right_handed : {false, true}) {
    // Behind pbrt's own axes x is to the right of one who looks along z.
    const std::string scene = film() + std::string(is_right_handed ? "Scale -1 1 1\n" : "") +
                              "LookAt 0 0 0 0 0 1 0 1 0 Camera \"perspective\"" + light;
    const Image image = changed_picture(scene, {.kind = CameraKind::kSpherical}).image;
    const int red = *find_channel(image, "R");
    const float right = image.pixel(12, 8)[red];
    const float left = image.pixel(3, 8)[red];
    EXPECT_GT(is_right_handed ? left : right, 0.3F);
    EXPECT_EQ(is_right_handed ? right : left, 0);
  }
}

TEST(ChangedCamera, NeedsSomethingToLookAt) {
  Diagnostics diagnostics;
  const PbrtScene pbrt =
      parse(film() + "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n", diagnostics);
  EXPECT_THROW(build_scene(pbrt, diagnostics, {.camera = CameraChange{.from = Vec3d(1)}}), Error);
  EXPECT_NO_THROW(build_scene(pbrt, diagnostics, {.camera = CameraChange{.fov = 20}}));
}

}  // namespace
}  // namespace freepath::testing
