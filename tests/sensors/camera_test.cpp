#include "freepath/sensors/camera.h"
#include "freepath/sensors/framing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "freepath/base/box.h"
#include "freepath/base/error.h"
#include "tests/expect_near.h"

namespace freepath {
namespace {

using testing::expect_near;

constexpr double kRadians = std::numbers::pi / 180;

/// Where a point of the world appears on the film, in pixels, and how deep.
Vec3d project(const View& view, int width, int height, const Vec3d& point) {
  const Vec3d forward = (view.at - view.from).normalized();
  const Vec3d right = forward.cross(view.up).normalized();
  const Vec3d up = right.cross(forward);
  const Vec3d offset = point - view.from;
  const double depth = offset.dot(forward);
  const double extent = std::tan(0.5 * view.fov * kRadians);
  return {width * 0.5 + offset.dot(right) / depth / extent * height * 0.5,
          height * 0.5 - offset.dot(up) / depth / extent * height * 0.5, depth};
}

TEST(Camera, LooksAtItsTargetInTheMiddleOfTheFilm) {
  const View view{.from = {1, 2, 3}, .at = {-4, 0, 9}};
  const Camera camera(view, 640, 480);
  const CameraRay ray = camera.ray(320, 240);
  EXPECT_EQ(ray.origin, view.from);
  expect_near(ray.direction, Vec3f((view.at - view.from).normalized()));
}

TEST(Camera, HasXToTheRightYDownAndAVerticalAngleOfView) {
  // Looking along -z with y up, +x is to the right.
  const Camera camera({.from = {0, 0, 0}, .at = {0, 0, -1}, .fov = 60}, 200, 100);
  const auto extent = static_cast<float>(std::tan(30 * kRadians));
  expect_near(camera.ray(100, 0).direction, Vec3f(0, extent, -1).normalized());
  expect_near(camera.ray(100, 100).direction, Vec3f(0, -extent, -1).normalized());
  expect_near(camera.ray(200, 50).direction, Vec3f(2 * extent, 0, -1).normalized());
  expect_near(camera.ray(0, 0).direction, Vec3f(-2 * extent, extent, -1).normalized());
}

TEST(Camera, RefusesDegenerateViews) {
  const Vec3d o(0);
  EXPECT_THROW(Camera({.from = {1, 2, 3}, .at = {1, 2, 3}}, 10, 10), Error);
  EXPECT_THROW(Camera({.from = o, .at = {0, 5, 0}, .up = {0, -1, 0}}, 10, 10), Error);
  EXPECT_THROW(Camera({.from = o, .at = {0, 0, 5}, .up = o}, 10, 10), Error);
  EXPECT_THROW(Camera({.from = o, .at = {0, 0, 5}, .fov = 0}, 10, 10), Error);
  EXPECT_THROW(Camera({.from = o, .at = {0, 0, 5}, .fov = 180}, 10, 10), Error);
  EXPECT_THROW(Camera({.from = o, .at = {0, 0, 5}}, 0, 10), Error);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Camera({.from = o, .at = {0, nan, 5}}, 10, 10), Error);
}

TEST(Camera, RefusesToStandTooFarAway) {
  const auto complaint = [](const Vec3d& from, const Vec3d& at) -> std::string {
    try {
      const Camera camera({.from = from, .at = at, .up = {0, 1, 0.5}}, 10, 10);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_EQ(complaint({1e300, 0, 0}, {0, 0, 0}),
            "the camera's position (1e+300, 0, 0) is further away than 1e+30; choose one nearer to "
            "the volume");
  EXPECT_EQ(complaint({1, 0, 0}, {0, -1.1e30, 0}),
            "the camera's target (0, -1.1e+30, 0) is further away than 1e+30; choose one nearer to "
            "the volume");
  EXPECT_EQ(complaint({0, 0, 0.99e30}, {0, 0, 0}), "");
}

TEST(FramePoints, ShowsTheWholeBoxWithASmallMargin) {
  const Box3d boxes[] = {{{-1, -1, -1}, {1, 1, 1}},
                         {{100, 200, 300}, {104, 201, 302}},
                         {{0, 0, 0}, {0.1, 30, 0.1}},
                         {{-5e5, 1e6, 0}, {5e5, 1e6, 2e6}}};
  for (const UpAxis up : {UpAxis::kY, UpAxis::kZ}) {
    for (const Box3d& box : boxes) {
      for (const auto& [width, height] : {std::pair{640, 360}, std::pair{100, 300}}) {
        const View view =
            frame_points(corners_of(box), up, 35, static_cast<double>(width) / height);
        double nearest_edge = 1;
        for (const Vec3d& corner : corners_of(box)) {
          const Vec3d film = project(view, width, height, corner);
          EXPECT_GT(film.z, 0);
          nearest_edge = std::min({nearest_edge, film.x / width, 1 - film.x / width,
                                   film.y / height, 1 - film.y / height});
        }
        EXPECT_NEAR(nearest_edge, 0.05, 1e-6);
      }
    }
  }
}

TEST(FramePoints, IsTheSameViewForATurnedWorld) {
  const View y_up = frame_points(corners_of({{-1, -2, -3}, {1, 2, 3}}), UpAxis::kY, 40, 1.5);
  const View z_up = frame_points(corners_of({{-1, -3, -2}, {1, 3, 2}}), UpAxis::kZ, 40, 1.5);
  expect_near(to_y_up(Vec3f(z_up.from), UpAxis::kZ), Vec3f(y_up.from), 1e-5F);
  EXPECT_EQ(z_up.up, Vec3d(0, 0, 1));
  EXPECT_LT(y_up.from.y, 0);  // a little below the middle
  EXPECT_GT(y_up.from.z, 0);  // in the south
}

TEST(FramePoints, RefusesPointsWithoutExtent) {
  EXPECT_THROW(frame_points({}, UpAxis::kY, 40, 1), Error);
  EXPECT_THROW(frame_points(corners_of({{1, 1, 1}, {1, 1, 1}}), UpAxis::kY, 40, 1), Error);
  EXPECT_THROW(frame_points(corners_of({{0, 0, 0}, {1, 1, 1}}), UpAxis::kY, 200, 1), Error);
  EXPECT_THROW(frame_points(corners_of({{0, 0, 0}, {1, 1, 1}}), UpAxis::kY, 40, 0), Error);
}

TEST(Camera, OfGivenRaysHasOneForEachPixelWhateverThePoint) {
  std::vector<CameraRay> rays;
  rays.reserve(6);
  for (int i = 0; i < 6; ++i) rays.push_back({Vec3d(i, 0, 0), Vec3f(0, 0, 1)});
  const Camera camera = Camera::of_rays(rays, 3, 2);
  for (const float offset : {0.25F, 0.5F, 0.75F}) {
    EXPECT_EQ(camera.ray(2 + offset, 1 + offset).origin, Vec3d(5, 0, 0));
    EXPECT_EQ(camera.ray(0 + offset, 1 + offset).origin, Vec3d(3, 0, 0));
  }
  EXPECT_FALSE(camera.has_lens());
  EXPECT_FALSE(camera.vertical_angle());
  EXPECT_THROW(Camera::of_rays(rays, 2, 2), Error);
  EXPECT_THROW(Camera::of_rays({}, 0, 0), Error);
}

TEST(SkyDirection, IsACompass) {
  expect_near(sky_direction(0, 0, UpAxis::kY), {0, 0, -1});
  expect_near(sky_direction(0, 90, UpAxis::kY), {1, 0, 0});
  expect_near(sky_direction(90, 0, UpAxis::kY), {0, 1, 0});
  expect_near(sky_direction(0, 0, UpAxis::kZ), {0, 1, 0});
  expect_near(sky_direction(0, 90, UpAxis::kZ), {1, 0, 0});
  expect_near(sky_direction(90, 0, UpAxis::kZ), {0, 0, 1});
}

// A point on a ray is where the ray is on the film, in coordinates from -1 to 1.
TEST(Camera, CoordinatesOfPointsOnRaysAreThoseOfTheFilm) {
  const View view{{3, 2, 7}, {0.5, 1, -1}, {0.1, 1, 0}, 35};
  const Matrix4d world_from_view = world_from_camera(view);
  for (const CameraModel& model :
       {CameraModel(pinhole(view, 64, 40)), CameraModel(PerspectiveCamera{.fov = 50}),
        CameraModel(PerspectiveCamera{.fov = 50, .screen_window = ScreenWindow{-1, 0.5, -0.2, 2}}),
        CameraModel(OrthographicCamera{.screen_window = ScreenWindow{-1, 0.5, -0.2, 2}})}) {
    const Camera camera(model, world_from_view, 64, 40);
    const Matrix4d ndc = camera.ndc_from_world().value();
    for (const auto& [x, y] :
         {std::pair(0.0F, 0.0F), std::pair(64.0F, 40.0F), std::pair(20.0F, 5.0F)}) {
      const CameraRay ray = camera.ray(x, y);
      for (const double t : {2.0, 9.0}) {
        const Vec3d point = ray.origin + Vec3d(ray.direction) * t;
        Vec3d projected;
        ndc.multVecMatrix(point, projected);
        EXPECT_NEAR(projected.x, x / 32 - 1, 1e-5);
        EXPECT_NEAR(projected.y, 1 - y / 20, 1e-5);
        Vec3d seen;
        camera.camera_from_world().multVecMatrix(point, seen);
        EXPECT_GT(seen.z, 0);
        const bool is_parallel = std::holds_alternative<OrthographicCamera>(model);
        EXPECT_NEAR(projected.z, is_parallel ? seen.z : 1 / seen.z, 1e-5);
      }
    }
  }
  EXPECT_FALSE(Camera(SphericalCamera{}, world_from_view, 8, 4).ndc_from_world());
}

}  // namespace
}  // namespace freepath
