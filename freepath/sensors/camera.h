#pragma once
/// @file The perspective camera, and where to put it for a bare volume.

#include <cmath>
#include <span>

#include "freepath/base/up_axis.h"
#include "freepath/base/vector.h"

namespace freepath {

/// Where a camera stands and what it sees.
struct View {
  Vec3d from{0, 0, 1};  ///< Position [world].
  Vec3d at{0, 0, 0};    ///< The point in the middle of the picture [world].
  Vec3d up{0, 1, 0};    ///< Upwards in the picture; any vector not parallel to the line of sight.
  double fov = 40;      ///< Vertical angle of view [degrees], in (0, 180).
};

/// A ray from the camera.
struct CameraRay {
  Vec3d origin;     ///< [world]
  Vec3f direction;  ///< Unit vector of travel, away from the camera [world].
};

/// Tangent of half an angle of view [degrees].
/// @throws Error for one that is not between 0 and 180
double half_extent(double fov);

/// A pinhole camera with square pixels.
class Camera {
 public:
  /// @param width,height size of the film [pixels]
  /// @throws Error if `from` and `at` are the same or beyond 1e30, `up` is parallel to the line of
  ///   sight, the angle of view is not in (0, 180), the film is empty, or a number is not finite
  Camera(const View& view, int width, int height);

  /// The ray through a point of the film. (0, 0) is the upper left corner of the film, x runs to
  /// the right, y down, the centre of the first pixel is (0.5, 0.5) [pixels].
  CameraRay ray(float film_x, float film_y) const {
    const Vec3f direction = corner_ + step_x_ * film_x + step_y_ * film_y;
    return {origin_, direction * (1.0F / std::sqrt(direction.length2()))};
  }

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  Vec3d origin_;
  Vec3f corner_;  // direction through the upper left corner, 1 deep along the line of sight
  Vec3f step_x_, step_y_;  // change of the direction from one pixel to the next
  int width_, height_;
};

/// The line of sight that frame_box chooses: the camera stands in the south-south-east (the
/// azimuths are those of sky_direction) and a little below the middle of the box, so that it looks
/// up to it as one does to a cloud.
inline constexpr double kFramingAzimuth = 150;    // [degrees]
inline constexpr double kFramingElevation = -12;  // [degrees]

/// A view of all the points, as close as that allows but for a margin of 5 % of the picture.
/// @param points what to show [world]
/// @param fov vertical angle of view [degrees]
/// @param aspect width / height of the film
/// @throws Error for no points, points that are all one or infinite, an angle not in (0, 180), an
///   aspect that is not positive
View frame_points(std::span<const Vec3d> points, UpAxis up, double fov, double aspect);

/// A view of the whole box, as close as that allows but for a margin of 5 % of the picture.
/// @param bounds what to show [world]
/// @param fov vertical angle of view [degrees]
/// @param aspect width / height of the film
/// @throws Error for an empty or infinite box, an angle not in (0, 180), an aspect that is not
///   positive
View frame_box(const Box3d& bounds, UpAxis up, double fov, double aspect);

}  // namespace freepath
