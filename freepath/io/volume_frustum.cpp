#include "freepath/io/volume_frustum.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "freepath/base/box.h"
#include "freepath/base/error.h"

namespace freepath::io {
namespace {

using BrickValues = std::array<float, BrickMap::kBrickVoxels>;

/// Voxels of one size in the frustum's space.
struct LinearGrid {
  Vec3d origin;  ///< Centre of the first voxel.
  Vec3d edges;
  Vec3i counts;
  Vec3d point(const Vec3d& index) const { return origin + index * edges; }
};

/// The grid around a box of index points.
LinearGrid linear_grid(const FrustumMap& map, const Vec3d& low, const Vec3d& high) {
  Box3d box;
  for (const Vec3d& corner : corners_of({low, high})) box.extendBy(map.to_frustum(corner));
  double edge = std::numeric_limits<double>::infinity();
  for (const double z : {(low.z - map.origin.z) * map.step, (high.z - map.origin.z) * map.step}) {
    const double here = map.edge(z);
    if (here > 0) edge = std::min(edge, here / 2);  // halves, since voxels don't meet the source's
  }
  if (!std::isfinite(edge)) fail("its frustum lies behind the camera; set another transform");
  // From one plane to the next a line of sight aside crosses voxels: a plane between them halves
  // what is lost, where density begins or ends.
  LinearGrid grid{box.min, Vec3d(edge, edge, std::abs(map.step) / 2), Vec3i(0)};
  const Vec3d size = box.max - box.min, voxels = high - low;
  constexpr double kFinest = 16, kFew = 1 << 22, kMost = 1 << 26;
  const double most = std::clamp(kFinest * voxels.x * voxels.y * voxels.z, kFew, kMost);
  const double many = size.x / edge * (size.y / edge) * (size.z / grid.edges.z);
  if (many > most) {
    grid.edges.x *= std::sqrt(many / most);
    grid.edges.y = grid.edges.x;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double count = std::ceil(size[axis] / grid.edges[axis] - 1e-6) + 1;
    if (!(count < 1 << 24)) fail("its frustum is too wide to be resampled; crop the grid");
    grid.counts[axis] = static_cast<int>(count);
  }
  return grid;
}

/// The bricks of a row along z that are not 0, with their places.
std::vector<std::pair<Vec3i, BrickValues>> resample_row(const FrustumMap& map,
                                                        const LinearGrid& grid,
                                                        const BrickMap& source, int row_x,
                                                        int row_y) {
  std::vector<std::pair<Vec3i, BrickValues>> row;
  for (int row_z = 0; row_z * BrickMap::kBrickSize < grid.counts.z; ++row_z) {
    const Vec3i brick(row_x, row_y, row_z);
    BrickValues values{};
    bool empty = true;
    for (int offset = 0; offset < BrickMap::kBrickVoxels; ++offset) {
      const Vec3i voxel =
          brick * BrickMap::kBrickSize + Vec3i(offset >> 6, offset >> 3 & 7, offset & 7);
      if (voxel.x >= grid.counts.x || voxel.y >= grid.counts.y || voxel.z >= grid.counts.z)
        continue;
      const auto index = map.to_index(grid.point(Vec3d(voxel)));
      if (!index) continue;
      values[offset] = static_cast<float>(source.interpolate(*index));
      empty = empty && values[offset] == 0;
    }
    if (!empty) row.emplace_back(brick, values);
  }
  return row;
}

BrickMap resample(const FrustumMap& map, const LinearGrid& grid, const BrickMap& source) {
  const Vec3i bricks = (grid.counts + Vec3i(BrickMap::kBrickSize - 1)) / BrickMap::kBrickSize;
  std::vector<std::vector<std::pair<Vec3i, BrickValues>>> rows(std::size_t(bricks.x) * bricks.y);
  oneapi::tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t i) {
    rows[i] = resample_row(map, grid, source, static_cast<int>(i / bricks.y),
                           static_cast<int>(i % bricks.y));
  });
  std::size_t count = 0;
  for (const auto& row : rows) count += row.size();
  BrickMapBuilder builder(Vec3i(0), grid.counts - Vec3i(1), count, count);
  for (const auto& row : rows) {
    for (const auto& [brick, values] : row) {
      std::copy(values.begin(), values.end(), builder.add_brick(brick).begin());
    }
  }
  return std::move(builder).finish();
}

/// The largest difference of the interpolants at points of the grid's box.
double largest_difference(const FrustumMap& map, const LinearGrid& grid, const BrickMap& source,
                          const BrickMap& resampled) {
  constexpr int kPoints = 4096;
  // Multiples of powers of the root of x^4 = x + 1 fill the cube evenly.
  constexpr double kRoot = 1.2207440846057596;
  double largest = 0;
  const Vec3d low(source.active_min()), size(source.active_max() - source.active_min());
  for (int i = 1; i <= kPoints; ++i) {
    Vec3d share;
    double step = 1;
    for (int axis = 0; axis < 3; ++axis) {
      step /= kRoot;
      share[axis] = i * step - std::floor(i * step);
    }
    const Vec3d index = low + share * size;
    const Vec3d linear = (map.to_frustum(index) - grid.origin) / grid.edges;
    largest =
        std::max(largest, std::abs(source.interpolate(index) - resampled.interpolate(linear)));
  }
  return largest;
}

}  // namespace

void resample_frustum(const std::string& label, const FrustumMap& map,
                      std::vector<LoadedField>& fields) {
  Vec3i low = fields[0].field.voxels.active_min(), high = fields[0].field.voxels.active_max();
  for (const LoadedField& loaded : fields) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], loaded.field.voxels.active_min()[axis]);
      high[axis] = std::max(high[axis], loaded.field.voxels.active_max()[axis]);
    }
  }
  // The filter reaches a voxel further than the outermost centres.
  const LinearGrid grid = linear_grid(map, Vec3d(low - Vec3i(1)), Vec3d(high + Vec3i(1)));
  Matrix4d index_to_frustum;
  for (int axis = 0; axis < 3; ++axis) {
    index_to_frustum[axis][axis] = grid.edges[axis];
    index_to_frustum[3][axis] = grid.origin[axis];
  }
  for (LoadedField& loaded : fields) {
    BrickMap resampled = resample(map, grid, loaded.field.voxels);
    const double difference = largest_difference(map, grid, loaded.field.voxels, resampled);
    loaded.warnings.push_back(fmt::format(
        "{}: its transform is a frustum: resampled to {} x {} x {} voxels of one size; the "
        "largest difference at 4096 points is {:.2g}, of densities up to {:.4g}",
        label, grid.counts.x, grid.counts.y, grid.counts.z, difference, loaded.maximum));
    loaded.field.voxels = std::move(resampled);
    loaded.field.index_to_world = index_to_frustum * map.frustum_to_world;
  }
}

}  // namespace freepath::io
