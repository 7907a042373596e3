#pragma once
/// @file Cameras by what they look at, and how to see all of a volume.

#include <optional>

#include "freepath/base/up_axis.h"
#include "freepath/base/vector.h"
#include "freepath/media/medium.h"
#include "freepath/sensors/camera.h"
#include "freepath/sensors/framing.h"

namespace freepath {

/// The kinds of camera that need no more than a view.
enum class CameraKind {
  kPerspective,
  kOrthographic,  ///< Parallel rays, over the perspective camera's extent where it looks at.
  kSpherical      ///< Everything around, the target in the middle, the horizon level.
};

/// Where the camera stands; frames the whole volume where nothing is said.
struct CameraOptions {
  CameraKind kind = CameraKind::kPerspective;
  int width = 640;
  int height = 360;
  double fov = 40;  ///< Vertical [degrees].
  /// Elevation of the camera as seen from what it frames [degrees].
  double elevation = kFramingElevation;
  std::optional<Vec3d> from = {};  ///< [world]
  std::optional<Vec3d> at = {};    ///< [world]
};

/// Upwards in a picture whose line of sight this is: where it is vertical, no horizon tells, and
/// north is.
Vec3d picture_up(const Vec3d& line_of_sight, UpAxis up);

/// The camera of a kind that has a view; a spherical one stands upright.
/// @param is_mirrored as Camera::is_mirrored
/// @throws Error as Camera
Camera view_camera(const View& view, CameraKind kind, UpAxis up, int width, int height,
                   bool is_mirrored = false);

/// @param medium what to frame where the options name no position
/// @throws Error as Camera and frame_points
Camera make_camera(const Medium& medium, const CameraOptions& options, UpAxis up);

}  // namespace freepath
