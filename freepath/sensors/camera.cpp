#include "freepath/sensors/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/base/octahedral.h"

namespace freepath {
namespace {

Vec3d row_of(const Matrix4d& matrix, int row) {
  return {matrix[row][0], matrix[row][1], matrix[row][2]};
}

/// Walks take no longer lengths for finite (transport/entry-inl.h).
constexpr double kLargestCoordinate = 1e30;

void check_transform(const Matrix4d& matrix) {
  constexpr double kLargest = kLargestCoordinate;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      if (!(std::abs(matrix[i][j]) <= kLargest)) {
        fail("the camera's transform has the entry {}; it must be a number up to {}", matrix[i][j],
             kLargest);
      }
    }
    if (matrix[i][3] != (i == 3 ? 1 : 0)) {
      fail("the camera's transform is a projection; it must be affine");
    }
  }
  // The volume between the images of the axes, whatever their lengths.
  const Vec3d x = row_of(matrix, 0).normalized();
  const Vec3d y = row_of(matrix, 1).normalized();
  const Vec3d z = row_of(matrix, 2).normalized();
  constexpr double kSmallestVolume = 1e-12;
  if (!(std::abs(x.dot(y.cross(z))) > kSmallestVolume)) {
    fail("the camera's transform has no inverse: it makes space flat");
  }
}

void check_film(int width, int height) {
  if (width < 1 || height < 1) {
    fail("the film has {}x{} pixels; it needs at least 1x1", width, height);
  }
}

void check_lens(const Lens& lens) {
  if (!(lens.radius >= 0) || !std::isfinite(lens.radius)) {
    fail("the lens has the radius {}; it must be 0 or more", lens.radius);
  }
  if (lens.radius > 0 && !(lens.focal_distance > 0)) {
    fail("the plane in focus is {} ahead of the camera; it must be more than 0",
         lens.focal_distance);
  }
}

/// What the film shows: the window if there is one, else the whole screen.
ScreenWindow screen_of(const std::optional<double>& frame_aspect_ratio,
                       const std::optional<ScreenWindow>& window, int width, int height) {
  if (window) {
    const double x = window->x_max - window->x_min;
    const double y = window->y_max - window->y_min;
    if (!std::isfinite(x) || !std::isfinite(y) || x == 0 || y == 0) {
      fail("the screen window is {}..{} by {}..{}; it must be finite and not empty", window->x_min,
           window->x_max, window->y_min, window->y_max);
    }
    return *window;
  }
  const double aspect = frame_aspect_ratio.value_or(static_cast<double>(width) / height);
  if (!(aspect > 0) || !std::isfinite(aspect)) {
    fail("the frame's aspect ratio is {}; it must be more than 0", aspect);
  }
  return aspect > 1 ? ScreenWindow{-aspect, aspect, -1, 1}
                    : ScreenWindow{-1, 1, -1 / aspect, 1 / aspect};
}

struct Point2 {
  float x, y;
};

/// Uniform on the unit disk: Shirley and Chiu's map [Shirley97] of squares around the centre to
/// circles, which keeps areas and neighbours together.
Point2 sample_disk(float u, float v) {
  const float a = 2 * u - 1;
  const float b = 2 * v - 1;
  if (a == 0 && b == 0) return {0, 0};
  constexpr float kEighth = 0.25F * std::numbers::pi_v<float>;
  const bool is_beside = std::abs(a) > std::abs(b);
  const float radius = is_beside ? a : b;
  const float angle = is_beside ? kEighth * (b / a) : kEighth * (2 - a / b);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// The point of the unit square that the octahedral map joins to one beyond an edge: on the same
/// edge, mirrored at its middle, and as far within.
Point2 wrap_octahedral(Point2 p) {
  if (p.x < 0 || p.x > 1) p = {p.x < 0 ? -p.x : 2 - p.x, 1 - p.y};
  if (p.y < 0 || p.y > 1) p = {1 - p.x, p.y < 0 ? -p.y : 2 - p.y};
  return p;
}

bool is_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void check_distance(const char* what, const Vec3d& point) {
  if (std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)}) > kLargestCoordinate) {
    fail("the camera's {} ({}, {}, {}) is further away than {}; choose one nearer to the volume",
         what, point.x, point.y, point.z, kLargestCoordinate);
  }
}

}  // namespace

Matrix4d camera_matrix(const Vec3d& right, const Vec3d& up, const Vec3d& ahead,
                       const Vec3d& position) {
  Matrix4d matrix;
  for (int axis = 0; axis < 3; ++axis) {
    matrix[0][axis] = right[axis];
    matrix[1][axis] = up[axis];
    matrix[2][axis] = ahead[axis];
    matrix[3][axis] = position[axis];
  }
  return matrix;
}

Matrix4d world_from_camera(const View& view) {
  if (!is_finite(view.from) || !is_finite(view.at) || !is_finite(view.up)) {
    fail("the camera's position, target and up vector must be finite numbers");
  }
  check_distance("position", view.from);
  check_distance("target", view.at);
  const Vec3d sight = view.at - view.from;
  // Below this the line of sight would be made of rounding errors.
  constexpr double kSmallest = 1e-12;
  if (sight.length() <= kSmallest * std::max(view.from.length(), view.at.length())) {
    fail("the camera stands at ({}, {}, {}) and looks at the same point; move one of them",
         view.from.x, view.from.y, view.from.z);
  }
  const Vec3d forward = sight.normalized();
  constexpr double kSmallestSine = 1e-6;
  if (forward.cross(view.up).length() <= kSmallestSine * view.up.length()) {
    fail("the camera looks along its up vector ({}, {}, {}); choose another up axis or target",
         view.up.x, view.up.y, view.up.z);
  }
  const Vec3d right = forward.cross(view.up).normalized();
  return camera_matrix(right, right.cross(forward), forward, view.from);
}

PerspectiveCamera pinhole(const View& view, int width, int height) {
  check_film(width, height);
  const double aspect = static_cast<double>(width) / height;
  PerspectiveCamera camera;
  camera.fov = view.fov;
  camera.screen_window = {-aspect, aspect, -1, 1};
  return camera;
}

double half_extent(double fov) {
  if (!(fov > 0 && fov < 180)) {
    fail("the angle of view is {} degrees; it must lie between 0 and 180", fov);
  }
  return std::tan(0.5 * fov * std::numbers::pi / 180);
}

Camera::Projective::Projective(const PerspectiveCamera& camera, const Matrix4d& matrix, int width,
                               int height)
    : Projective(screen_of(camera.frame_aspect_ratio, camera.screen_window, width, height),
                 half_extent(camera.fov), camera.lens, false, matrix, width, height) {}

Camera::Projective::Projective(const OrthographicCamera& camera, const Matrix4d& matrix, int width,
                               int height)
    : Projective(screen_of(camera.frame_aspect_ratio, camera.screen_window, width, height), 1,
                 camera.lens, true, matrix, width, height) {}

Camera::Projective::Projective(const ScreenWindow& screen, double screen_scale, const Lens& lens,
                               bool parallel, const Matrix4d& matrix, int width, int height)
    : is_parallel(parallel), has_lens(lens.radius > 0), origin(row_of(matrix, 3)) {
  check_lens(lens);
  const Vec3d x = row_of(matrix, 0);
  const Vec3d y = row_of(matrix, 1);
  const Vec3d z = row_of(matrix, 2);
  // Directions in units of the depth's image, lest a scale overflow when they are made unit
  // vectors.
  const double unit = z.length();
  ahead = Vec3f(z / unit);
  focus = static_cast<float>(1 / (unit * lens.focal_distance));
  const double film_scale = parallel ? screen_scale : screen_scale / unit;
  corner = x * (film_scale * screen.x_min) + y * (film_scale * screen.y_max);
  step_x = x * (film_scale * (screen.x_max - screen.x_min) / width);
  step_y = y * (film_scale * (screen.y_min - screen.y_max) / height);
  corner_direction = Vec3f(corner);
  direction_x = Vec3f(step_x);
  direction_y = Vec3f(step_y);
  lens_x = Vec3f(x * lens.radius);
  lens_y = Vec3f(y * lens.radius);
}

CameraRay Camera::Projective::ray(float film_x, float film_y, float lens_u, float lens_v) const {
  Vec3d start = origin;
  Vec3f direction = ahead;
  if (is_parallel) {
    start += corner + step_x * static_cast<double>(film_x) + step_y * static_cast<double>(film_y);
  } else {
    direction += corner_direction + direction_x * film_x + direction_y * film_y;
  }
  if (has_lens) {
    // The ray still meets the plane in focus where the one through the lens' centre does.
    const Point2 point = sample_disk(lens_u, lens_v);
    const Vec3f lens = lens_x * point.x + lens_y * point.y;
    start += Vec3d(lens);
    direction -= lens * focus;
  }
  return {start, direction * (1.0F / std::sqrt(direction.length2()))};
}

CameraRay Camera::Spherical::ray(float film_x, float film_y) const {
  const Point2 p{film_x * per_width, film_y * per_height};
  if (mapping == SphericalMapping::kEqualArea) {
    const Point2 within = wrap_octahedral(p);
    const Vec3f local = direction_from_octahedral({within.x, within.y});
    return {origin, (right * local.x + up * local.z + ahead * local.y).normalized()};
  }
  const float polar = std::numbers::pi_v<float> * p.y;
  const float azimuth = 2 * std::numbers::pi_v<float> * p.x;
  const Vec3f level = right * std::cos(azimuth) + ahead * std::sin(azimuth);
  return {origin, (level * std::sin(polar) + up * std::cos(polar)).normalized()};
}

Camera::Rays Camera::make_rays(const CameraModel& model, const Matrix4d& matrix, int width,
                               int height) {
  check_film(width, height);
  check_transform(matrix);
  if (const auto* camera = std::get_if<PerspectiveCamera>(&model)) {
    return Projective(*camera, matrix, width, height);
  }
  if (const auto* camera = std::get_if<OrthographicCamera>(&model)) {
    return Projective(*camera, matrix, width, height);
  }
  const double unit = row_of(matrix, 2).length();
  return Spherical{std::get<SphericalCamera>(model).mapping, row_of(matrix, 3),
                   Vec3f(row_of(matrix, 0) / unit),          Vec3f(row_of(matrix, 1) / unit),
                   Vec3f(row_of(matrix, 2) / unit),          1.0F / static_cast<float>(width),
                   1.0F / static_cast<float>(height)};
}

Camera::Camera(const CameraModel& model, const Matrix4d& world_from_camera, int width, int height)
    : width_(width),
      height_(height),
      world_from_camera_(world_from_camera),
      rays_(make_rays(model, world_from_camera, width, height)) {}

Camera::Camera(const View& view, int width, int height)
    : Camera(pinhole(view, width, height), world_from_camera(view), width, height) {}

Camera Camera::of_rays(std::vector<CameraRay> rays, int width, int height) {
  check_film(width, height);
  if (rays.size() != static_cast<std::size_t>(width) * height) {
    fail("there are {} rays for {} x {} pixels; give one for each", rays.size(), width, height);
  }
  return Camera(
      Given{std::make_shared<const std::vector<CameraRay>>(std::move(rays)), width, height});
}

CameraRay Camera::Given::ray(float film_x, float film_y) const {
  const int column = std::clamp(static_cast<int>(film_x), 0, width - 1);
  const int row = std::clamp(static_cast<int>(film_y), 0, height - 1);
  return (*rays)[static_cast<std::size_t>(row) * width + column];
}

Vec3d Camera::up() const {
  if (std::holds_alternative<Given>(rays_)) return {0, 0, 1};
  if (const auto* camera = std::get_if<Projective>(&rays_)) return -camera->step_y;
  return Vec3d(std::get<Spherical>(rays_).up);
}

bool Camera::is_mirrored() const {
  if (const auto* camera = std::get_if<Projective>(&rays_)) {
    return camera->step_x.cross(-camera->step_y).dot(Vec3d(camera->ahead)) > 0;
  }
  if (std::holds_alternative<Given>(rays_)) return false;
  const auto& camera = std::get<Spherical>(rays_);
  return camera.right.cross(camera.up).dot(camera.ahead) > 0;
}

std::optional<Matrix4d> Camera::ndc_from_world() const {
  const auto* const camera = std::get_if<Projective>(&rays_);
  if (camera == nullptr) return std::nullopt;
  // A point is origin + depth · (x right + y up + middle), or origin + x right + y up + middle +
  // depth · ahead where rays are parallel.
  const Vec3d right = camera->step_x * (0.5 * width_);
  const Vec3d up = camera->step_y * (-0.5 * height_);
  const Vec3d middle = camera->corner + right - up;
  const Vec3d ahead(camera->ahead);
  if (camera->is_parallel) {
    return camera_matrix(right, up, ahead, camera->origin + middle).inverse();
  }
  const Matrix4d planes = camera_matrix(right, up, middle + ahead, camera->origin).inverse();
  const Matrix4d divide(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0);
  return planes * divide;
}

std::optional<double> Camera::vertical_angle() const {
  const auto* const camera = std::get_if<Projective>(&rays_);
  if (camera == nullptr || camera->is_parallel) return std::nullopt;
  const float middle = 0.5F * static_cast<float>(width_);
  const Vec3d top(ray(middle, 0).direction);
  const Vec3d bottom(ray(middle, static_cast<float>(height_)).direction);
  return std::atan2(top.cross(bottom).length(), top.dot(bottom)) * 180 / std::numbers::pi;
}

CameraRay Camera::ray(float film_x, float film_y, float lens_u, float lens_v) const {
  if (const auto* camera = std::get_if<Projective>(&rays_)) {
    return camera->ray(film_x, film_y, lens_u, lens_v);
  }
  if (const auto* camera = std::get_if<Given>(&rays_)) return camera->ray(film_x, film_y);
  return std::get_if<Spherical>(&rays_)->ray(film_x, film_y);
}

bool Camera::has_lens() const {
  const auto* camera = std::get_if<Projective>(&rays_);
  return camera != nullptr && camera->has_lens;
}

}  // namespace freepath
