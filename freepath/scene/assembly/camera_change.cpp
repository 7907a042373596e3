#include "freepath/scene/assembly/camera_change.h"

#include <cmath>

#include "freepath/base/error.h"

namespace freepath {
namespace {

/// Of the axes that point up in scenes, the one that a direction is nearer to.
UpAxis nearest_up(const Vec3d& up) {
  return std::abs(up.z) > std::abs(up.y) ? UpAxis::kZ : UpAxis::kY;
}

/// On the camera's line of sight, as far as the middle of what there is to see.
Vec3d seen_by(const Camera& camera, const Box3d& shapes) {
  const CameraRay middle = camera.ray(0.5F * static_cast<float>(camera.width()),
                                      0.5F * static_cast<float>(camera.height()));
  const Vec3d ahead(middle.direction);
  const double distance = shapes.isEmpty() ? 0 : (shapes.center() - middle.origin).dot(ahead);
  return middle.origin + ahead * (distance > 0 ? distance : 1.0);
}

}  // namespace

Camera changed_camera(const CameraChange& change, const Camera& own, const Box3d& shapes) {
  constexpr double kUsualAngle = 40;
  View view;
  view.from = change.from.value_or(own.position());
  view.fov = change.fov ? *change.fov : own.vertical_angle().value_or(kUsualAngle);
  if (change.at) {
    view.at = *change.at;
  } else if (!change.from) {
    view.at = seen_by(own, shapes);
  } else if (!shapes.isEmpty()) {
    view.at = shapes.center();
  } else {
    fail("--look-at: the scene has no shapes that the camera could look at; give its target, too");
  }
  const UpAxis axis = change.up.value_or(nearest_up(own.up()));
  view.up = change.up ? picture_up(view.at - view.from, axis) : own.up();
  if ((view.at - view.from).normalized().cross(view.up).length() < 1e-4) {
    view.up = picture_up(view.at - view.from, axis);
  }
  return view_camera(view, change.kind, axis, own.width(), own.height(), own.is_mirrored());
}

}  // namespace freepath
