#pragma once
/// @file A level plane under a scene.

#include <optional>

#include "freepath/base/rgb.h"
#include "freepath/base/up_axis.h"
#include "freepath/base/vector.h"
#include "freepath/geometry/shape_geometry.h"
#include "freepath/paths/path_scene.h"

namespace freepath {

/// A level plane that reflects the same radiance to all directions.
struct Ground {
  Rgb albedo{0.0F};
  /// Height along the axis that points up [world]; none: the bottom of all else.
  std::optional<double> height = {};
  UpAxis up = UpAxis::kY;
};

/// @throws Error for an albedo not in [0, 1] or a height that is not finite
void check(const Ground& ground);

/// The height that a ground has under something [world].
/// @throws Error where neither has one
double height_under(const Box3d& extent, const Ground& ground);

/// Adds the plane to a scene whose surfaces are still to be made. It reaches 1e5 times as far as
/// all else.
/// @param extent of all else but the camera [world]
/// @param camera its place [world]
/// @throws Error as check and height_under
void add_ground(const Ground& ground, const Box3d& extent, const Vec3d& camera, PathScene& scene,
                SurfaceScene& surfaces);

}  // namespace freepath
