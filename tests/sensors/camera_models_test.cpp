#include "freepath/sensors/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "freepath/scene/pbrt/transform.h"
#include "tests/expect_near.h"
#include "tests/statistics.h"

namespace freepath {
namespace {

using testing::check_chi_square;
using testing::chi_square_test;
using testing::expect_near;

const Matrix4d kIdentity;

/// Where a ray is at a depth z [camera space = world].
Vec3d at_depth(const CameraRay& ray, double z) {
  return ray.origin + Vec3d(ray.direction) * ((z - ray.origin.z) / ray.direction.z);
}

Vec3f direction(const Camera& camera, float x, float y) {
  return camera.ray(x, y, 0.5F, 0.5F).direction;
}

Vec3f unit(float x, float y, float z) { return Vec3f(x, y, z).normalized(); }

TEST(PerspectiveCamera, LooksAheadInTheMiddleOfTheFilm) {
  for (const auto& [width, height] : {std::pair{640, 480}, std::pair{3, 7}}) {
    const Camera camera(PerspectiveCamera{}, kIdentity, width, height);
    const CameraRay ray = camera.ray(0.5F * width, 0.5F * height, 0.3F, 0.9F);
    EXPECT_EQ(ray.origin, Vec3d(0));
    expect_near(ray.direction, {0, 0, 1});
    EXPECT_FALSE(camera.has_lens());
    EXPECT_EQ(camera.width(), width);
    EXPECT_EQ(camera.height(), height);
  }
}

TEST(PerspectiveCamera, SpansTheAngleOfViewInTheShorterDirection) {
  const auto t = static_cast<float>(std::tan(std::numbers::pi / 6));
  const Camera landscape(PerspectiveCamera{.fov = 60}, kIdentity, 200, 100);
  expect_near(direction(landscape, 100, 0), unit(0, t, 1));
  expect_near(direction(landscape, 0, 0), unit(-2 * t, t, 1));
  expect_near(direction(landscape, 200, 0), unit(2 * t, t, 1));
  expect_near(direction(landscape, 0, 100), unit(-2 * t, -t, 1));
  expect_near(direction(landscape, 150, 75), unit(t, -0.5F * t, 1));
  const Camera portrait(PerspectiveCamera{.fov = 60}, kIdentity, 100, 200);
  expect_near(direction(portrait, 0, 100), unit(-t, 0, 1));
  expect_near(direction(portrait, 100, 200), unit(t, -2 * t, 1));
}

TEST(PerspectiveCamera, TakesTheShapeOfTheScreenFromTheFrame) {
  const auto shape = [](double aspect) {
    return Camera(PerspectiveCamera{.frame_aspect_ratio = aspect}, kIdentity, 100, 100);
  };
  expect_near(direction(shape(2), 100, 0), unit(2, 1, 1));
  expect_near(direction(shape(0.5), 100, 0), unit(1, 2, 1));
}

TEST(PerspectiveCamera, ShowsTheScreenWindow) {
  const Camera camera(PerspectiveCamera{.fov = 90, .screen_window = {{-0.5, 1, 0.25, 0.75}}},
                      kIdentity, 30, 10);
  expect_near(direction(camera, 0, 0), unit(-0.5F, 0.75F, 1));
  expect_near(direction(camera, 30, 10), unit(1, 0.25F, 1));
  const Camera mirrored(PerspectiveCamera{.screen_window = {{1, -1, -1, 1}}}, kIdentity, 8, 8);
  expect_near(direction(mirrored, 0, 0), unit(1, 1, 1));
}

TEST(PerspectiveCamera, FocusesTheRaysOfAPointOfTheFilmInAPlane) {
  const PerspectiveCamera pinhole{.fov = 50};
  PerspectiveCamera model = pinhole;
  model.lens = {.radius = 0.3, .focal_distance = 7};
  const Camera sharp(pinhole, kIdentity, 60, 40);
  const Camera camera(model, kIdentity, 60, 40);
  EXPECT_TRUE(camera.has_lens());
  RandomStream random(1, 0, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    const float x = 60 * random.uniform();
    const float y = 40 * random.uniform();
    const CameraRay ray = camera.ray(x, y, random.uniform(), random.uniform());
    EXPECT_NEAR(ray.direction.length(), 1, 1e-6);
    EXPECT_LE(ray.origin.length(), 0.3 + 1e-6);
    EXPECT_EQ(ray.origin.z, 0);
    EXPECT_LE((at_depth(ray, 7) - at_depth(sharp.ray(x, y, 0, 0), 7)).length(), 1e-5);
  }
}

/// Chi-square test of points on a disk in rings and sectors of the same area.
void expect_uniform_on_disk(const Camera& camera, float film_x, float film_y, const Vec3d& centre,
                            double radius) {
  constexpr int kRings = 8;
  constexpr int kSectors = 12;
  constexpr int kPoints = 200'000;
  std::vector<uint64_t> counts(kRings * kSectors);
  RandomStream random(2, 0, 0, 0);
  for (int i = 0; i < kPoints; ++i) {
    const float u = random.uniform();
    const Vec3d point = (camera.ray(film_x, film_y, u, random.uniform()).origin - centre) / radius;
    const double share = point.x * point.x + point.y * point.y;
    ASSERT_LE(share, 1 + 1e-5);
    const double turn = std::atan2(point.y, point.x) / (2 * std::numbers::pi) + 0.5;
    const int ring = std::min(static_cast<int>(share * kRings), kRings - 1);
    const int sector = std::min(static_cast<int>(turn * kSectors), kSectors - 1);
    ++counts[ring * kSectors + sector];
  }
  const std::vector<double> expected(counts.size(), static_cast<double>(kPoints) / counts.size());
  EXPECT_TRUE(check_chi_square("points on the lens", chi_square_test(counts, expected)));
}

TEST(PerspectiveCamera, SamplesTheLensUniformly) {
  const Camera camera(PerspectiveCamera{.lens = {.radius = 0.2, .focal_distance = 3}}, kIdentity,
                      10, 10);
  expect_uniform_on_disk(camera, 2, 3, Vec3d(0), 0.2);
  expect_near(Vec3f(camera.ray(2, 3, 0.5F, 0.5F).origin), Vec3f(0));
}

TEST(OrthographicCamera, SendsParallelRaysFromTheScreen) {
  const Camera camera(OrthographicCamera{}, kIdentity, 200, 100);
  for (const auto& [x, y, position] :
       {std::tuple{0.0F, 0.0F, Vec3d(-2, 1, 0)}, std::tuple{200.0F, 100.0F, Vec3d(2, -1, 0)},
        std::tuple{150.0F, 50.0F, Vec3d(1, 0, 0)}}) {
    const CameraRay ray = camera.ray(x, y, 0.1F, 0.2F);
    EXPECT_LE((ray.origin - position).length(), 1e-6);
    expect_near(ray.direction, {0, 0, 1});
  }
  const Camera window(OrthographicCamera{.screen_window = {{3, 5, -1, 8}}}, kIdentity, 4, 4);
  EXPECT_LE((window.ray(0, 4, 0, 0).origin - Vec3d(3, -1, 0)).length(), 1e-6);
}

TEST(OrthographicCamera, FocusesOnThePointsThatItShowsWithoutALens) {
  const Camera camera(OrthographicCamera{.lens = {.radius = 0.4, .focal_distance = 5}}, kIdentity,
                      20, 20);
  const Vec3d position(0.5, -0.5, 0);
  RandomStream random(3, 0, 0, 0);
  for (int i = 0; i < 200; ++i) {
    const float u = random.uniform();
    const Vec3d hit = at_depth(camera.ray(15, 15, u, random.uniform()), 5);
    EXPECT_LE((hit - Vec3d(0.5, -0.5, 5)).length(), 1e-5);
  }
  expect_uniform_on_disk(camera, 15, 15, position, 0.4);
}

TEST(SphericalCamera, LaysLongitudeAndLatitudeOnTheFilm) {
  const Camera camera(SphericalCamera{SphericalMapping::kEquirectangular}, kIdentity, 400, 200);
  expect_near(direction(camera, 123, 0), {0, 1, 0});
  expect_near(direction(camera, 321, 200), {0, -1, 0});
  expect_near(direction(camera, 0, 100), {1, 0, 0});
  expect_near(direction(camera, 100, 100), {0, 0, 1});
  expect_near(direction(camera, 200, 100), {-1, 0, 0});
  expect_near(direction(camera, 300, 50), unit(0, 1, -1));
}

TEST(SphericalCamera, LaysTheOctahedronOnTheFilm) {
  const Camera camera(SphericalCamera{}, kIdentity, 100, 100);
  expect_near(direction(camera, 50, 50), {0, 1, 0});
  expect_near(direction(camera, 100, 50), {1, 0, 0});
  expect_near(direction(camera, 0, 50), {-1, 0, 0});
  expect_near(direction(camera, 50, 100), {0, 0, 1});
  expect_near(direction(camera, 50, 0), {0, 0, -1});
  for (const float x : {0.0F, 100.0F}) {
    for (const float y : {0.0F, 100.0F}) expect_near(direction(camera, x, y), {0, -1, 0}, 1e-3F);
  }
  expect_near(direction(camera, 75, 75), unit(1, 0, 1));
}

TEST(SphericalCamera, GivesEachPixelTheSameSolidAngle) {
  const Camera camera(SphericalCamera{}, kIdentity, 100, 100);
  RandomStream random(4, 0, 0, 0);
  for (int i = 0; i < 10'000; ++i) {
    const float x = 1 + 98 * random.uniform();
    const float y = 1 + 98 * random.uniform();
    constexpr float kStep = 0.125F;
    // The map has creases on the lines through the middle and on the diamond of the horizon.
    const float u = std::abs(x - 50);
    const float v = std::abs(y - 50);
    if (std::min({u, v, std::abs(u + v - 50)}) < 3 * kStep) continue;
    const Vec3d across(direction(camera, x + kStep, y) - direction(camera, x - kStep, y));
    const Vec3d down(direction(camera, x, y + kStep) - direction(camera, x, y - kStep));
    const double solid_angle = across.cross(down).length() / (4 * kStep * kStep);
    EXPECT_NEAR(solid_angle / (4 * std::numbers::pi / 10'000), 1, 2e-3) << x << ", " << y;
  }
}

TEST(SphericalCamera, CoversTheSphereUniformly) {
  constexpr int kBands = 10;
  constexpr int kSectors = 16;
  constexpr int kPoints = 500'000;
  const Camera camera(SphericalCamera{}, kIdentity, 64, 32);
  std::vector<uint64_t> counts(kBands * kSectors);
  RandomStream random(5, 0, 0, 0);
  for (int i = 0; i < kPoints; ++i) {
    const float x = 64 * random.uniform();
    const Vec3f d = direction(camera, x, 32 * random.uniform());
    const double turn = std::atan2(d.x, d.z) / (2 * std::numbers::pi) + 0.5;
    const int band = std::min(static_cast<int>((d.y + 1) / 2 * kBands), kBands - 1);
    ++counts[band * kSectors + std::min(static_cast<int>(turn * kSectors), kSectors - 1)];
  }
  const std::vector<double> expected(counts.size(), static_cast<double>(kPoints) / counts.size());
  EXPECT_TRUE(check_chi_square("directions", chi_square_test(counts, expected)));
}

TEST(SphericalCamera, GoesOnBeyondTheEdgesOfTheFilm) {
  const Camera octahedral(SphericalCamera{}, kIdentity, 64, 64);
  const Camera globe(SphericalCamera{SphericalMapping::kEquirectangular}, kIdentity, 64, 64);
  for (const Camera* camera : {&octahedral, &globe}) {
    constexpr float kOff = 0.01F;
    for (float along = 0.5F; along < 64; along += 1) {
      for (const float edge : {0.0F, 64.0F}) {
        expect_near(direction(*camera, edge - kOff, along), direction(*camera, edge + kOff, along),
                    4e-3F);
        expect_near(direction(*camera, along, edge - kOff), direction(*camera, along, edge + kOff),
                    4e-3F);
      }
    }
  }
}

TEST(Camera, StandsWhereLookAtPutsIt) {
  // Looking along -x with z up; in a left-handed world y is to the left then.
  const Vec3d from(3, 1, 2);
  const Matrix4d world_from_camera = look_at(from, {0, 1, 2}, {0, 0, 1}).inverse();
  const CameraModel models[] = {PerspectiveCamera{.fov = 90}, OrthographicCamera{}};
  for (const CameraModel& model : models) {
    const Camera camera(model, world_from_camera, 90, 90);
    // The point of the world 4 ahead, 2 to the right and 1 up; the screen's edge is 4 or 1 away.
    const bool is_perspective = std::holds_alternative<PerspectiveCamera>(model);
    const float scale = is_perspective ? 45.0F / 4 : 45.0F / 1;
    const CameraRay ray = camera.ray(45 + 2 * scale, 45 - 1 * scale, 0, 0);
    const Vec3d point(-1, -1, 3);
    const Vec3d offset = point - ray.origin;
    EXPECT_LE(offset.cross(Vec3d(ray.direction)).length(), 1e-5);
    EXPECT_GT(offset.dot(Vec3d(ray.direction)), 0);
  }
  const Camera simple(PerspectiveCamera{}, look_at(Vec3d(0), {0, 0, 1}, {0, 1, 0}).inverse(), 8, 8);
  EXPECT_GT(direction(simple, 8, 4).x, 0);
  EXPECT_GT(direction(simple, 4, 0).y, 0);
}

TEST(Camera, SeesTheWorldMirroredThroughAMirroringTransform) {
  const Camera camera(PerspectiveCamera{}, scaling({-1, 1, 1}), 8, 8);
  expect_near(direction(camera, 8, 0), unit(-1, 1, 1));
}

TEST(Camera, KeepsThePositionInDoublePrecisionAndDirectionsOfUnitLength) {
  const Vec3d far(1e9 + 0.25, -3, 1e-3);
  const CameraModel models[] = {PerspectiveCamera{}, OrthographicCamera{}, SphericalCamera{}};
  for (const double scale : {1e-25, 0.01, 1.0, 300.0, 1e25}) {
    for (const CameraModel& model : models) {
      const Matrix4d matrix = scaling(Vec3d(scale)) * translation(far);
      const Camera camera(model, matrix, 20, 20);
      const CameraRay middle = camera.ray(10, 10, 0.5F, 0.5F);
      EXPECT_LE((middle.origin - far).length(), 1e-15 * scale);
      expect_near(camera.ray(3, 4, 0.5F, 0.5F).direction,
                  Camera(model, kIdentity, 20, 20).ray(3, 4, 0.5F, 0.5F).direction);
    }
  }
}

TEST(Camera, ScalesTheLensWithTheTransform) {
  const Matrix4d matrix = scaling(Vec3d(10)) * translation({0, 0, 1});
  const Camera camera(PerspectiveCamera{.lens = {.radius = 0.1, .focal_distance = 2}}, matrix, 20,
                      20);
  const CameraRay ray = camera.ray(20, 10, 0.999F, 0.5F);
  EXPECT_NEAR(ray.origin.x, 0.998, 1e-3);
  EXPECT_LE((at_depth(ray, 21) - Vec3d(20, 0, 21)).length(), 1e-4);
}

TEST(Camera, RefusesWhatMakesNoPicture) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto refuses = [](const CameraModel& model, const Matrix4d& matrix = kIdentity,
                          int width = 10, int height = 10) {
    EXPECT_THROW(Camera(model, matrix, width, height), Error);
  };
  for (const double fov : {0.0, -30.0, 180.0, kNan}) refuses(PerspectiveCamera{.fov = fov});
  for (const double aspect : {0.0, -1.0, kNan}) {
    refuses(PerspectiveCamera{.frame_aspect_ratio = aspect});
    refuses(OrthographicCamera{.frame_aspect_ratio = aspect});
  }
  for (const ScreenWindow& window :
       {ScreenWindow{1, 1, 0, 1}, ScreenWindow{0, 1, 2, 2}, ScreenWindow{0, kNan, 0, 1}}) {
    refuses(PerspectiveCamera{.screen_window = window});
    refuses(OrthographicCamera{.screen_window = window});
  }
  for (const Lens& lens : {Lens{-1, 1}, Lens{1, 0}, Lens{1, -2}, Lens{kNan, 1}, Lens{1, kNan}}) {
    refuses(PerspectiveCamera{.lens = lens});
    refuses(OrthographicCamera{.lens = lens});
  }
  const CameraModel models[] = {PerspectiveCamera{}, OrthographicCamera{}, SphericalCamera{}};
  for (const CameraModel& model : models) {
    refuses(model, kIdentity, 0, 10);
    refuses(model, kIdentity, 10, -1);
    refuses(model, scaling({1, 0, 1}));
    refuses(model, translation({1e31, 0, 0}));
    refuses(model, translation({kNan, 0, 0}));
    Matrix4d projection;
    projection[2][3] = 1;
    refuses(model, projection);
  }
  EXPECT_NO_THROW(Camera(PerspectiveCamera{.lens = {0, 0}}, kIdentity, 1, 1));
}

}  // namespace
}  // namespace freepath
