#include "freepath/sensors/framing.h"

#include <algorithm>
#include <cmath>

#include "freepath/base/error.h"

namespace freepath {
namespace {

/// Right, up and backwards of a camera.
struct CameraAxes {
  Vec3d right, up, back;
};

CameraAxes camera_axes(const Vec3d& forward, const Vec3d& up) {
  const Vec3d right = forward.cross(up).normalized();
  return {right, right.cross(forward), -forward};
}

}  // namespace

View frame_points(std::span<const Vec3d> points, UpAxis up, double fov, double aspect,
                  double elevation) {
  Box3d bounds;
  for (const Vec3d& point : points) {
    bounds.extendBy(point);
    if (!std::isfinite(point.x + point.y + point.z)) bounds.makeInfinite();
  }
  if (bounds.isEmpty() || bounds.isInfinite() || !(bounds.size().length() > 0)) {
    fail("can't place the camera: the volume has no finite extent; give a view with --look-at");
  }
  if (!(aspect > 0) || !std::isfinite(aspect)) {
    fail("can't place the camera: the film's aspect ratio is {}", aspect);
  }
  constexpr double kMargin = 0.05;  // of the picture, on each side
  const double extent_y = half_extent(fov) * (1 - 2 * kMargin);
  const double extent_x = extent_y * aspect;
  const Vec3d back(sky_direction(elevation, kFramingAzimuth, up));
  const Vec3d up_world(up_vector(up));
  const CameraAxes axes = camera_axes(-back, up_world);
  const Vec3d centre = bounds.center();
  // A point (x, y, z) in the camera's axes is seen from (cx, cy, d) if |x - cx| <= (d - z) e, with
  // e the film's extent at distance 1; so the two sides bound d e + cx and d e - cx, as do the
  // other two for cy.
  double right = -HUGE_VAL;
  double left = -HUGE_VAL;
  double top = -HUGE_VAL;
  double bottom = -HUGE_VAL;
  for (const Vec3d& point : points) {
    const Vec3d offset = point - centre;
    const double x = offset.dot(axes.right);
    const double y = offset.dot(axes.up);
    const double z = offset.dot(axes.back);
    right = std::max(right, x + z * extent_x);
    left = std::max(left, -x + z * extent_x);
    top = std::max(top, y + z * extent_y);
    bottom = std::max(bottom, -y + z * extent_y);
  }
  const double distance =
      std::max((right + left) / (2 * extent_x), (top + bottom) / (2 * extent_y));
  const Vec3d at = centre + axes.right * ((right - left) / 2) + axes.up * ((top - bottom) / 2);
  return {at + axes.back * distance, at, up_world, fov};
}

}  // namespace freepath
