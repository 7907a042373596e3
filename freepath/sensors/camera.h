#pragma once
/// @file Cameras: perspective, orthographic and spherical, by what they look at or as the scene
/// language has them (pbrt-v4).
///
/// Camera space has x to the right, y up and z ahead; it is left-handed. A transform to the world
/// that keeps the handedness therefore shows the world mirrored, as it does in pbrt.

#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "freepath/base/vector.h"

namespace freepath {

/// Where a camera stands and what it sees.
struct View {
  Vec3d from{0, 0, 1};  ///< Position [world].
  Vec3d at{0, 0, 0};    ///< The point in the middle of the picture [world].
  Vec3d up{0, 1, 0};    ///< Upwards in the picture; any vector not parallel to the line of sight.
  double fov = 40;      ///< Vertical angle of view [degrees], in (0, 180).
};

/// The transform of a camera with these axes, to the right, up and ahead, at a position.
Matrix4d camera_matrix(const Vec3d& right, const Vec3d& up, const Vec3d& ahead,
                       const Vec3d& position);

/// The transform of a camera that has this view: rows are its axes and position.
/// @throws Error if `from` and `at` are the same or beyond 1e30, or `up` is parallel to the line of
///   sight
Matrix4d world_from_camera(const View& view);

/// A ray from the camera.
struct CameraRay {
  Vec3d origin;     ///< [world]
  Vec3f direction;  ///< Unit vector of travel, away from the camera [world].
};

/// Tangent of half an angle of view [degrees].
/// @throws Error for one that is not between 0 and 180
double half_extent(double fov);

/// The part of the screen that the film shows. The screen is 2 wide in its shorter direction, x to
/// the right and y up; a window whose limits are swapped shows the picture mirrored.
struct ScreenWindow {
  double x_min, x_max;
  double y_min, y_max;
};

/// A thin lens; with a radius of 0 everything is in focus.
struct Lens {
  double radius = 0;            ///< [camera space]
  double focal_distance = 1e6;  ///< Depth z of the plane in focus [camera space].
};

/// Rays through one point, or through a lens around it.
struct PerspectiveCamera {
  double fov = 90;  ///< Angle of view of the screen's shorter direction [degrees], in (0, 180).
  std::optional<double> frame_aspect_ratio = {};   ///< Width / height; otherwise the film's.
  std::optional<ScreenWindow> screen_window = {};  ///< Otherwise the whole screen.
  Lens lens = {};
};

/// Parallel rays; the screen lies in the plane z = 0 of camera space, in its units.
/// @note With a lens, rays leave from around the film's point, so that a point in focus is where it
///   is without a lens. pbrt-v4 has them leave from around the camera's origin.
struct OrthographicCamera {
  std::optional<double> frame_aspect_ratio = {};   ///< Width / height; otherwise the film's.
  std::optional<ScreenWindow> screen_window = {};  ///< Otherwise the whole screen.
  Lens lens = {};
};

/// How the film is laid around a spherical camera.
enum class SphericalMapping {
  kEqualArea,       ///< The octahedral map of [Clarberg08]: each pixel has the same solid angle.
  kEquirectangular  ///< Longitude from x to z to the right, latitude downwards from y.
};

/// Everything around a point.
struct SphericalCamera {
  SphericalMapping mapping = SphericalMapping::kEqualArea;
};

/// The camera of a view, without a lens and with square pixels: the angle of view is vertical,
/// whichever side of the film is the shorter one.
/// @throws Error for a film without pixels
PerspectiveCamera pinhole(const View& view, int width, int height);

using CameraModel = std::variant<PerspectiveCamera, OrthographicCamera, SphericalCamera>;

/// A camera. Immutable; threads share it.
class Camera {
 public:
  /// @param world_from_camera affine; points are rows
  /// @param width,height size of the whole film [pixels]
  /// @throws Error if the film is empty, the transform is not affine, has no inverse or puts the
  ///   camera beyond 1e30, the angle of view is not in (0, 180), the aspect ratio is not positive,
  ///   the screen window is empty, the lens' radius is negative, the distance of the plane in focus
  ///   is not positive, or a number is not finite
  Camera(const CameraModel& model, const Matrix4d& world_from_camera, int width, int height);
  /// A pinhole with square pixels.
  /// @throws Error, too, if `from` and `at` are the same or beyond 1e30, or `up` is parallel to the
  ///   line of sight
  Camera(const View& view, int width, int height);
  /// A sensor of one's own: a ray for each pixel, row by row, whatever point of the pixel is asked
  /// for. It has no direction that is up: (0, 0, 1) stands for one.
  /// @param rays as many as pixels; directions are unit vectors
  /// @throws Error for another number of rays, or a film without pixels
  static Camera of_rays(std::vector<CameraRay> rays, int width, int height);

  /// The ray through a point of the film and a point of the lens. (0, 0) is the upper left corner
  /// of the whole film, x runs to the right, y down, the centre of the first pixel is (0.5, 0.5)
  /// [pixels]. Points a little off the film are meaningful too: filters reach there.
  /// @param lens_u,lens_v uniform in [0, 1), for a point uniform on the lens; its middle otherwise
  CameraRay ray(float film_x, float film_y, float lens_u = 0.5F, float lens_v = 0.5F) const;

  /// Where the ray through the middle of the film begins [world].
  Vec3d position() const {
    return ray(0.5F * static_cast<float>(width_), 0.5F * static_cast<float>(height_)).origin;
  }

  /// Upwards in the picture, from any point of it [world].
  Vec3d up() const;

  /// Whether what it shows is that of a world whose axes are left-handed, as pbrt's are: to its
  /// right, upwards and ahead are a right-handed system.
  bool is_mirrored() const;

  /// The angle that rays through the middle column of the film fill, if they leave from one point
  /// and not to all sides [degrees].
  std::optional<double> vertical_angle() const;

  /// World space to camera space, for points as rows.
  Matrix4d camera_from_world() const { return world_from_camera_.inverse(); }

  /// World space to normalised device coordinates, for points as rows of homogeneous coordinates:
  /// x from -1 at the left of the film to 1, y from -1 at its bottom to 1, z the reciprocal of the
  /// depth (of parallel rays, the depth). Nothing for a camera that looks to all sides.
  std::optional<Matrix4d> ndc_from_world() const;

  /// Whether rays depend on the point of the lens.
  bool has_lens() const;

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  /// The film stands at depth 1 of a perspective camera, and at depth 0 of an orthographic one.
  /// Vectors are images of those of camera space; directions are over the length of the image of
  /// depth 1 [world].
  struct Projective {
    Projective(const PerspectiveCamera& camera, const Matrix4d& matrix, int width, int height);
    Projective(const OrthographicCamera& camera, const Matrix4d& matrix, int width, int height);
    CameraRay ray(float film_x, float film_y, float lens_u, float lens_v) const;

    bool is_parallel;
    bool has_lens;
    float focus;   // 1 / distance of the plane in focus [1/world]
    Vec3d origin;  // of the camera
    Vec3f ahead;
    // Parallel rays begin at points of the film; of others it is the direction through them.
    Vec3d corner;          // of the film, from its point on the axis
    Vec3d step_x, step_y;  // from one pixel to the next
    Vec3f corner_direction;
    Vec3f direction_x, direction_y;
    Vec3f lens_x, lens_y;  // radii of the lens

   private:
    Projective(const ScreenWindow& screen, double screen_scale, const Lens& lens, bool parallel,
               const Matrix4d& matrix, int width, int height);
  };
  struct Spherical {
    CameraRay ray(float film_x, float film_y) const;

    SphericalMapping mapping;
    Vec3d origin;
    Vec3f right, up, ahead;
    float per_width, per_height;
  };
  struct Given {
    CameraRay ray(float film_x, float film_y) const;

    std::shared_ptr<const std::vector<CameraRay>> rays;
    int width, height;
  };
  using Rays = std::variant<Projective, Spherical, Given>;
  explicit Camera(Given given)
      : width_(given.width), height_(given.height), rays_(std::move(given)) {}
  static Rays make_rays(const CameraModel& model, const Matrix4d& matrix, int width, int height);

  int width_, height_;
  Matrix4d world_from_camera_;
  Rays rays_;
};

}  // namespace freepath
