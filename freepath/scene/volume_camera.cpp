#include "freepath/scene/volume_camera.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "freepath/base/box.h"
#include "freepath/base/error.h"
#include "freepath/media/brick_map.h"

namespace freepath {
namespace {

/// Adds corners of the bricks that hold something, of each row along z only the first and the last:
/// all that their convex hull needs [world].
void add_occupied_corners(const Field& field, std::vector<Vec3d>& corners) {
  const BrickMap& map = field.voxels;
  const auto add_brick = [&](const Vec3i& coord) {
    const Vec3i first = coord * BrickMap::kBrickSize;
    Box3d bounds;
    for (int axis = 0; axis < 3; ++axis) {
      const int end = first[axis] + BrickMap::kBrickSize - 1;
      bounds.min[axis] = std::max(first[axis], map.active_min()[axis]) - 0.5;
      bounds.max[axis] = std::min(end, map.active_max()[axis]) + 0.5;
    }
    for (const Vec3d& corner : corners_of(bounds)) corners.push_back(corner * field.index_to_world);
  };
  std::optional<Vec3i> last;  // of the row so far
  map.for_each_brick([&](const PlacedBrick& placed) {
    const Vec3i& coord = placed.coord;
    if (!last || last->x != coord.x || last->y != coord.y) {
      if (last) add_brick(*last);
      add_brick(coord);
    }
    last = coord;
  });
  if (last) add_brick(*last);
}

/// The film of a parallel camera is as large as what the perspective one sees where it looks at.
CameraModel model_of(const View& view, CameraKind kind, int width, int height) {
  const double aspect = static_cast<double>(width) / height;
  switch (kind) {
    case CameraKind::kPerspective:
      break;
    case CameraKind::kOrthographic: {
      const double extent = half_extent(view.fov) * (view.at - view.from).length();
      OrthographicCamera camera;
      camera.screen_window = {-extent * aspect, extent * aspect, -extent, extent};
      return camera;
    }
    case CameraKind::kSpherical:
      return SphericalCamera{SphericalMapping::kEquirectangular};
  }
  return pinhole(view, width, height);
}

/// The middle of the picture is where the equirectangular map has -x.
Matrix4d upright_matrix(const View& view, UpAxis up) {
  const Vec3d above(up_vector(up));
  Vec3d ahead = view.at - view.from;
  ahead -= above * above.dot(ahead);
  if (!(ahead.length() > 1e-6 * (view.at - view.from).length())) {
    ahead = Vec3d(sky_direction(0, 0, up));
  }
  ahead.normalize();
  return camera_matrix(-ahead, above, -ahead.cross(above), view.from);
}

Camera camera_of(std::span<const Vec3d> points, const CameraOptions& options, UpAxis up) {
  const double aspect = static_cast<double>(options.width) / options.height;
  View view = frame_points(points, up, options.fov, aspect, options.elevation);
  if (options.from) view.from = *options.from;
  if (options.at) view.at = *options.at;
  view.up = picture_up(view.at - view.from, up);
  return view_camera(view, options.kind, up, options.width, options.height);
}

}  // namespace

Vec3d picture_up(const Vec3d& line_of_sight, UpAxis up) {
  const Vec3d world_up(up_vector(up));
  const Vec3d sight = line_of_sight.normalized();
  const bool vertical = sight.cross(world_up).length() < 1e-4;
  return vertical ? Vec3d(sky_direction(0, 0, up)) : world_up;
}

Camera view_camera(const View& view, CameraKind kind, UpAxis up, int width, int height,
                   bool is_mirrored) {
  const CameraModel model = model_of(view, kind, width, height);
  Matrix4d matrix =
      kind == CameraKind::kSpherical ? upright_matrix(view, up) : world_from_camera(view);
  if (is_mirrored) {
    // To the right: what a spherical camera has a quarter behind its edge.
    const int right = kind == CameraKind::kSpherical ? 2 : 0;
    for (int axis = 0; axis < 3; ++axis) matrix[right][axis] = -matrix[right][axis];
  }
  return {model, matrix, width, height};
}

Camera make_camera(const Medium& medium, const CameraOptions& options, UpAxis up) {
  std::vector<Vec3d> corners;
  for (const Component& component : medium.components()) {
    add_occupied_corners(*component.density, corners);
  }
  if (corners.empty()) {  // an empty medium
    const Box3d box = medium.world_bounds();
    corners = {box.min, box.max};
  }
  return camera_of(corners, options, up);
}

}  // namespace freepath
