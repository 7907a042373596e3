#pragma once
/// @file Where to put a camera that is to see all of a volume.

#include <span>

#include "freepath/base/up_axis.h"
#include "freepath/base/vector.h"
#include "freepath/sensors/camera.h"

namespace freepath {

/// The line of sight that frame_points chooses: the camera stands in the south-south-east (the
/// azimuths are those of sky_direction) and a little below the middle of the points, so that it
/// looks up to it as one does to a cloud.
inline constexpr double kFramingAzimuth = 150;    // [degrees]
inline constexpr double kFramingElevation = -12;  // [degrees]

/// A view of all the points, as close as that allows but for a margin of 5 % of the picture.
/// @param points what to show [world]
/// @param fov vertical angle of view [degrees]
/// @param aspect width / height of the film
/// @param elevation of the camera as seen from the points [degrees]
/// @throws Error for no points, points that are all one or infinite, an angle not in (0, 180), an
///   aspect that is not positive
View frame_points(std::span<const Vec3d> points, UpAxis up, double fov, double aspect,
                  double elevation = kFramingElevation);

}  // namespace freepath
