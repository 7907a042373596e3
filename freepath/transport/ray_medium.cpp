#include "freepath/transport/ray_medium.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "freepath/media/brick_map.h"
#include "freepath/media/density_function.h"

namespace freepath {
namespace {

/// Lengths and inverse directions stay below this, as in the lanes' entry.
constexpr double kHuge = 1e30;

/// Where voxel centres stand in their cells.
double centre_offset(Interpolation interpolation) {
  return interpolation == Interpolation::kNearest ? 0.0 : 0.5;
}

double inverse_of(double direction) {
  return 1 / (std::abs(direction) < 1 / kHuge ? 1 / kHuge : direction);
}

Vec3i floor(const Vec3d& point) {
  return {static_cast<int>(std::floor(point.x)), static_cast<int>(std::floor(point.y)),
          static_cast<int>(std::floor(point.z))};
}

bool is_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

RayMedium::RayMedium(const MediumView& view, int channels) : view_(view) {
  for (int k = 0; k < view.component_count; ++k) {
    const ComponentView& component = view.components[k];
    double sum = 0;
    for (int channel = 0; channel < channels; ++channel) {
      sum += double(component.sigma_a[channel]) + component.sigma_s[channel];
    }
    if (sum > 0) numbers_.push_back(k);
  }
}

RayMedium::Path RayMedium::enter(const Vec3d& origin, const Vec3d& direction, double t_max) const {
  const AffineMap& map = view_.world_to_walk;
  Path path;
  Vec3d low;
  Vec3d high;
  double reach = 0;
  for (int to = 0; to < 3; ++to) {
    path.origin[to] = map.offset[to];
    path.direction[to] = 0;
    for (int from = 0; from < 3; ++from) {
      path.origin[to] += origin[from] * map.linear[from][to];
      path.direction[to] += direction[from] * map.linear[from][to];
    }
    reach = std::max(reach, std::abs(path.direction[to]));
    path.origin[to] *= view_.cell_size;
    path.direction[to] *= view_.cell_size;
    low[to] = double(view_.bounds_min[to]) * view_.cell_size;
    high[to] = double(view_.bounds_max[to]) * view_.cell_size;
  }
  if (!(t_max > 0) || !is_finite(path.origin) || !is_finite(path.direction) || !(reach > 1 / kHuge))
    return path;
  const auto exit_along = [&](int axis) {
    const double inverse = inverse_of(path.direction[axis]);
    return std::max((low[axis] - path.origin[axis]) * inverse,
                    (high[axis] - path.origin[axis]) * inverse);
  };
  double end = std::min(kHuge, t_max);
  for (int axis = 0; axis < 3; ++axis) {
    const double inverse = inverse_of(path.direction[axis]);
    path.begin = std::max(path.begin, std::min((low[axis] - path.origin[axis]) * inverse,
                                               (high[axis] - path.origin[axis]) * inverse));
    end = std::min(end, exit_along(axis));
  }
  if (!(path.begin < end)) return path;
  path.length = end - path.begin;
  // Far away rounding may miss the bounds by any number of voxels: from here on it cannot.
  for (int axis = 0; axis < 3; ++axis) {
    const double entry = path.origin[axis] + path.direction[axis] * path.begin;
    path.origin[axis] = std::clamp(entry, low[axis], high[axis]);
    path.length = std::min(path.length, exit_along(axis));
  }
  path.length = std::max(path.length, 0.0);
  path.voxel_length = 1 / path.direction.length();
  return path;
}

RayMedium::Path RayMedium::path_in(int k, const Path& path) const {
  if (view_.aligned) return path;
  const AffineMap& map = component(k).walk_to_voxels;
  Path result = path;
  for (int to = 0; to < 3; ++to) {
    result.origin[to] = map.offset[to];
    result.direction[to] = 0;
    for (int from = 0; from < 3; ++from) {
      const double factor = double{map.linear[from][to]} / view_.cell_size;
      result.origin[to] += path.origin[from] * factor;
      result.direction[to] += path.direction[from] * factor;
    }
  }
  return result;
}

double RayMedium::voxel(int k, const Vec3i& coord) const {
  const ComponentView& component = view_.components[numbers_[k]];
  const auto& counts = component.brick_counts;
  const int entry = ((coord.x >> 3) * counts[1] + (coord.y >> 3)) * counts[2] + (coord.z >> 3);
  const int within = (coord.x & 7) << 6 | (coord.y & 7) << 3 | (coord.z & 7);
  return component
      .voxels[std::size_t{component.index[entry]} * BrickMap::kBrickVoxels + std::size_t(within)];
}

Vec3i RayMedium::inside(int k, Vec3i voxel) const {
  for (int axis = 0; axis < 3; ++axis) {
    const int last = component(k).brick_counts[axis] * BrickMap::kBrickSize - 2;
    voxel[axis] = std::clamp(voxel[axis], 0, last);
  }
  return voxel;
}

std::array<double, 4> RayMedium::cubic(int k, const Vec3i& base, const Vec3d& fraction,
                                       const Vec3d& step) const {
  // As a polynomial of the position: Σ a[i][j][l] x^i y^j z^l, each power 0 or 1.
  double a[2][2][2];
  for (int x = 0; x < 2; ++x) {
    for (int y = 0; y < 2; ++y) {
      for (int z = 0; z < 2; ++z) a[x][y][z] = voxel(k, base + Vec3i(x, y, z));
    }
  }
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) a[1][i][j] -= a[0][i][j];
  }
  for (auto& plane : a) {
    for (int j = 0; j < 2; ++j) plane[1][j] -= plane[0][j];
    for (auto& row : plane) row[1] -= row[0];
  }
  const auto& [x, y, z] = fraction;
  const auto& [dx, dy, dz] = step;
  const double yz = a[1][1][0] + a[1][1][1] * z;  // of x y, at this z
  const double xz = a[1][0][1] + a[1][1][1] * y;  // of x z, at this y
  const double xy = a[0][1][1] + a[1][1][1] * x;  // of y z, at this x
  const double slope_x = a[1][0][0] + a[1][1][0] * y + xz * z;
  const double slope_y = a[0][1][0] + a[0][1][1] * z + yz * x;
  const double slope_z = a[0][0][1] + a[1][0][1] * x + xy * y;
  const double here = a[0][0][0] + a[0][1][0] * y + (a[0][0][1] + a[0][1][1] * y) * z + slope_x * x;
  return {here, slope_x * dx + slope_y * dy + slope_z * dz,
          yz * dx * dy + xz * dx * dz + xy * dy * dz, a[1][1][1] * dx * dy * dz};
}

RayMedium::Densities RayMedium::computed(const Vec3d& point) const {
  Vec3f position;
  for (int axis = 0; axis < 3; ++axis) {
    position[axis] = view_.cell_origin[axis] +
                     static_cast<float>(point[axis] / view_.cell_size) * view_.cell_edge[axis];
  }
  Densities result{};
  for (int k = 0; k < component_count(); ++k) {
    float density = 0;
    component(k).function->evaluate({&position, 1}, {&density, 1});
    result[k] = density;
  }
  return result;
}

RayMedium::Densities RayMedium::densities(const Path& path, double t, RandomStream& random) const {
  if (view_.components[0].function != nullptr) return computed(path.origin + path.direction * t);
  Vec3d uniform(0.0);
  if (view_.interpolation == Interpolation::kStochastic) {
    for (int axis = 0; axis < 3; ++axis) uniform[axis] = random.uniform();
  }
  Densities result{};
  for (int k = 0; k < component_count(); ++k) {
    const Path own = path_in(k, path);
    const Vec3d position =
        own.origin + own.direction * t - Vec3d(centre_offset(view_.interpolation));
    Vec3i base = inside(k, floor(position));
    Vec3d fraction = position - Vec3d(base);
    for (int axis = 0; axis < 3; ++axis) fraction[axis] = std::clamp(fraction[axis], 0.0, 1.0);
    if (view_.interpolation == Interpolation::kTrilinear) {
      result[k] = std::max(0.0, cubic(k, base, fraction, Vec3d(0.0))[0]);
      continue;
    }
    if (view_.interpolation == Interpolation::kStochastic) {
      for (int axis = 0; axis < 3; ++axis) base[axis] += uniform[axis] < fraction[axis] ? 1 : 0;
    }
    result[k] = voxel(k, base);
  }
  return result;
}

RayMedium::Segments::Segments(const RayMedium& medium, const Path& path)
    : medium_(medium),
      steps_(path.origin / medium.view_.cell_size, path.direction / medium.view_.cell_size, 0,
             path.length) {}

bool RayMedium::Segments::next(Segment& segment) {
  const MediumView& view = medium_.view_;
  const Vec3i cell = steps_.cell();
  for (int axis = 0; axis < 3; ++axis) {
    if (cell[axis] < 0 || cell[axis] >= view.cell_counts[axis]) return false;
  }
  if (steps_.done()) return false;
  const std::size_t record =
      ((std::size_t(cell.x) * view.cell_counts[1] + cell.y) * view.cell_counts[2] + cell.z) *
      view.component_count;
  const float head = view.cells[record];  // where all densities are 0, minus the empty radius
  segment.empty = true;
  for (int k = 0; k < medium_.component_count(); ++k) {
    const std::size_t entry = record + medium_.number(k);
    segment.minimum[k] = view.minima[entry];
    segment.maximum[k] = std::max(0.0F, view.cells[entry]);
    if (segment.maximum[k] > 0) segment.empty = false;
  }
  segment.begin = steps_.begin();
  segment.end = steps_.leave(std::max(1, static_cast<int>(-head)));
  return true;
}

RayMedium::Cells::Cells(const RayMedium& medium, const Path& path, double begin, double end)
    : medium_(medium),
      begin_(begin),
      end_(end),
      track_count_(medium.view_.aligned ? std::min(1, medium.component_count())
                                        : medium.component_count()) {
  const Vec3d offset(centre_offset(medium.view_.interpolation));
  for (int i = 0; i < track_count_; ++i) {
    Track& track = tracks_[i];
    track.path = medium.path_in(i, path);
    track.steps = GridSteps(track.path.origin - offset, track.path.direction, begin, end);
    track.base = track.steps.cell();
    track.exit = track.steps.done() ? end : track.steps.leave(1);
  }
}

bool RayMedium::Cells::next(Cell& cell) {
  if (!(begin_ < end_)) return false;
  cell.begin = begin_;
  cell.end = end_;
  for (int i = 0; i < track_count_; ++i) cell.end = std::min(cell.end, tracks_[i].exit);
  const bool nearest = medium_.view_.interpolation == Interpolation::kNearest;
  for (int k = 0; k < medium_.component_count(); ++k) {
    const Track& track = tracks_[track_count_ == 1 ? 0 : k];
    const Vec3i base = medium_.inside(k, track.base);
    if (nearest) {
      cell.density[k][0] = medium_.voxel(k, base);
      continue;
    }
    Vec3d fraction =
        track.path.origin + track.path.direction * cell.begin - Vec3d(0.5) - Vec3d(base);
    for (int axis = 0; axis < 3; ++axis) fraction[axis] = std::clamp(fraction[axis], 0.0, 1.0);
    const Vec3d step = track.path.direction * (cell.end - cell.begin);
    cell.density[k] = medium_.cubic(k, base, fraction, step);
  }
  begin_ = cell.end;
  for (int i = 0; i < track_count_; ++i) {
    Track& track = tracks_[i];
    if (track.exit > begin_ || track.steps.done()) continue;
    track.base = track.steps.cell();
    track.exit = track.steps.leave(1);
  }
  return true;
}

}  // namespace freepath
