// Transforms against matrices worked out by hand. Points are rows: the last row is the translation.

#include "freepath/scene/pbrt/transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/scene/scenes_in_memory.h"

namespace freepath::testing {
namespace {

PbrtShape shape_after(const std::string& directives) {
  return parse("WorldBegin " + directives + R"( Shape "sphere")").shapes.at(0);
}

Matrix4d transform_after(const std::string& directives) {
  const TransformPair transform = shape_after(directives).world_from_object;
  EXPECT_FALSE(transform.is_animated()) << directives;
  return transform.start;
}

void expect_near(const Matrix4d& actual, const Matrix4d& expected) {
  EXPECT_TRUE(actual.equalWithAbsError(expected, 1e-14)) << actual << "instead of\n" << expected;
}

TEST(Transforms, OfEachDirective) {
  expect_near(transform_after(""), Matrix4d());
  expect_near(transform_after("Translate 1 2 3"), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1});
  expect_near(transform_after("Scale 2 -3 4"), {2, 0, 0, 0, 0, -3, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1});
  // 90 degrees around z take x to y and y to -x; around x, y to z and z to -y.
  expect_near(transform_after("Rotate 90 0 0 5"),
              {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  expect_near(transform_after("Rotate 90 1 0 0"),
              {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1});
  // 30 degrees around y take z to (sin 30, 0, cos 30).
  const double c = std::sqrt(3.0) / 2;
  expect_near(transform_after("Rotate 30 0 1 0"),
              {c, 0, -0.5, 0, 0, 1, 0, 0, 0.5, 0, c, 0, 0, 0, 0, 1});
  expect_near(transform_after("Rotate 30 0 1 0 Identity"), Matrix4d());
  // The sixteen numbers are the images of the axes and of the origin, one after the other.
  expect_near(transform_after("Translate 9 9 9 Transform [ 0 2 0 0  0 0 3 0  4 0 0 0  5 6 7 1 ]"),
              {0, 2, 0, 0, 0, 0, 3, 0, 4, 0, 0, 0, 5, 6, 7, 1});
}

TEST(Transforms, ApplyTheLastDirectiveToPointsFirst) {
  // (1, 0, 0) is scaled to (2, 0, 0) and then moved to (3, 2, 3).
  const Matrix4d matrix = transform_after("Translate 1 2 3 Scale 2 2 2");
  expect_near(matrix, {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 2, 3, 1});
  EXPECT_EQ(Vec3d(1, 0, 0) * matrix, Vec3d(3, 2, 3));
  expect_near(transform_after("Scale 2 2 2 Translate 1 2 3"),
              {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 2, 4, 6, 1});
  expect_near(transform_after("Translate 1 2 3 ConcatTransform [2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1]"),
              matrix);
}

TEST(Transforms, LookAtGivesCoordinatesThatACameraSees) {
  // From (4, 2, 0) towards -x with z up: ahead is -x, right is up × ahead = z × -x = -y.
  const PbrtScene scene = parse(R"(LookAt 4 2 0  0 2 0  0 0 1 Camera "perspective" WorldBegin)");
  const Matrix4d camera_from_world = scene.camera->camera_from_world.start;
  expect_near(camera_from_world, {0, 0, -1, 0, -1, 0, 0, 0, 0, 1, 0, 0, 2, 0, 4, 1});
  EXPECT_TRUE((Vec3d(4, 2, 0) * camera_from_world).equalWithAbsError(Vec3d(0), 1e-14));
  EXPECT_TRUE((Vec3d(0, 2, 0) * camera_from_world).equalWithAbsError(Vec3d(0, 0, 4), 1e-14));
  EXPECT_TRUE((Vec3d(4, 2, 1) * camera_from_world).equalWithAbsError(Vec3d(0, 1, 0), 1e-14));
}

TEST(Transforms, BeforeTheCameraStackUp) {
  const PbrtScene scene = parse(R"(Scale -1 1 1 Translate 0 0 5 Camera "perspective" WorldBegin)");
  expect_near(scene.camera->camera_from_world.start,
              {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1});
}

TEST(Transforms, OfCameraAndWorldHaveNames) {
  const std::string view = R"(LookAt 4 2 0  0 2 0  0 0 1 Camera "perspective" WorldBegin )";
  const PbrtScene scene = parse(view + R"(CoordSysTransform "camera" Shape "sphere" )"
                                       R"(CoordSysTransform "world" Shape "sphere")");
  // The inverse of the matrix above: rows are right, up and ahead, then the position.
  expect_near(scene.shapes.at(0).world_from_object.start,
              {0, -1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 4, 2, 0, 1});
  expect_near(scene.shapes.at(1).world_from_object.start, Matrix4d());
}

TEST(Transforms, CanBeNamedAndFetched) {
  expect_near(transform_after(R"(Translate 1 2 3 CoordinateSystem "here" Scale 2 2 2 )"
                              R"(CoordSysTransform "here")"),
              {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1});
}

TEST(Transforms, MoveWhereOnlyOneTimeIsActive) {
  const PbrtShape moving = shape_after(
      "Translate 1 0 0 ActiveTransform StartTime Translate 0 1 0 "
      "ActiveTransform EndTime Scale 2 2 2 ActiveTransform All Translate 0 0 1");
  EXPECT_TRUE(moving.world_from_object.is_animated());
  expect_near(moving.world_from_object.start, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 1, 1, 1});
  expect_near(moving.world_from_object.end, {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 0, 2, 1});
  const PbrtScene scene = parse(
      "TransformTimes 0.25 0.75 ActiveTransform EndTime WorldBegin "
      R"(Translate 1 0 0 Shape "sphere")");
  EXPECT_EQ(scene.start_time, 0.25);
  EXPECT_EQ(scene.end_time, 0.75);
  EXPECT_FALSE(scene.shapes.at(0).world_from_object.is_animated());
}

TEST(Transforms, AreUsableAtAnyScaleUnlessFlat) {
  EXPECT_TRUE(is_usable(scaling(Vec3d(1e-12))));
  EXPECT_TRUE(is_usable(scaling(Vec3d(1e-12, 1, 1e12))));
  EXPECT_FALSE(is_usable(scaling(Vec3d(1, 1, 0))));
  EXPECT_FALSE(is_usable(scaling(Vec3d(1e31, 1, 1))));
  EXPECT_FALSE(is_usable({1, 2, 3, 0, 2, 4, 6, 0, 0, 0, 1, 0, 0, 0, 0, 1}));
  EXPECT_FALSE(is_usable({1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}));
}

}  // namespace
}  // namespace freepath::testing
