#pragma once
/// @file A camera that takes the place of a scene's own.

#include <optional>

#include "freepath/base/up_axis.h"
#include "freepath/base/vector.h"
#include "freepath/scene/volume_camera.h"
#include "freepath/sensors/camera.h"

namespace freepath {

/// What is said of a camera from outside of a scene's file; all else is as its own has it. It is a
/// pinhole.
struct CameraChange {
  CameraKind kind = CameraKind::kPerspective;
  std::optional<double> fov = {};  ///< Vertical [degrees]; 40 where the scene's camera has none.
  std::optional<Vec3d> from = {};  ///< [world]
  /// [world]; where only `from` is given, the middle of the shapes.
  std::optional<Vec3d> at = {};
  std::optional<UpAxis> up = {};
};

/// The camera that a change makes of a scene's own.
/// @param shapes bounds of all shapes [world], empty where there are none
/// @throws Error as Camera; where there is nothing to look at
Camera changed_camera(const CameraChange& change, const Camera& own, const Box3d& shapes);

}  // namespace freepath
