#include "freepath/media/super_voxels.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "freepath/base/error.h"

namespace freepath {
namespace {

constexpr std::size_t kMaxFineCells = std::size_t{4} << 20;  // 4³ cells only where they are few

struct Range {
  float minimum = std::numeric_limits<float>::infinity();
  float maximum = -std::numeric_limits<float>::infinity();
  void add(float value) {
    minimum = std::min(minimum, value);
    maximum = std::max(maximum, value);
  }
};

/// Range of the voxels of one brick inside [begin, end), both local to the brick.
void add_brick_part(const float* voxels, const Vec3i& begin, const Vec3i& end, Range& range) {
  for (int x = begin.x; x < end.x; ++x) {
    for (int y = begin.y; y < end.y; ++y) {
      const float* row = voxels + (x << 6 | y << 3);
      for (int z = begin.z; z < end.z; ++z) range.add(row[z]);
    }
  }
}

/// Range of the voxels [begin, end) of a map, counted from its first voxel; outside it is 0.
Range range_of_voxels(const BrickMap& map, const Vec3i& begin, const Vec3i& end) {
  Range range;
  const Vec3i& counts = map.brick_counts();
  for (int axis = 0; axis < 3; ++axis) {
    if (begin[axis] < 0 || end[axis] > counts[axis] * BrickMap::kBrickSize) range.add(0.0F);
  }
  const Vec3i first(begin.x >> 3, begin.y >> 3, begin.z >> 3);
  const Vec3i last((end.x - 1) >> 3, (end.y - 1) >> 3, (end.z - 1) >> 3);
  for (int bx = std::max(first.x, 0); bx <= std::min(last.x, counts.x - 1); ++bx) {
    for (int by = std::max(first.y, 0); by <= std::min(last.y, counts.y - 1); ++by) {
      for (int bz = std::max(first.z, 0); bz <= std::min(last.z, counts.z - 1); ++bz) {
        const std::size_t entry = (static_cast<std::size_t>(bx) * counts.y + by) * counts.z + bz;
        const std::size_t brick = map.index()[entry];
        if (brick == 0) {
          range.add(0.0F);
          continue;
        }
        const Vec3i corner = Vec3i(bx, by, bz) * BrickMap::kBrickSize;
        Vec3i part_begin;
        Vec3i part_end;
        for (int axis = 0; axis < 3; ++axis) {
          part_begin[axis] = std::max(begin[axis] - corner[axis], 0);
          part_end[axis] = std::min(end[axis] - corner[axis], BrickMap::kBrickSize);
        }
        add_brick_part(map.voxels().data() + brick * BrickMap::kBrickVoxels, part_begin, part_end,
                       range);
      }
    }
  }
  return range;
}

std::size_t cell_index(const Vec3i& counts, int x, int y, int z) {
  return (static_cast<std::size_t>(x) * counts.y + y) * counts.z + z;
}

SuperVoxels empty_cells(const Vec3i& brick_counts, int cell_size, std::size_t components) {
  SuperVoxels cells;
  cells.cell_size = cell_size;
  cells.components = static_cast<int>(components);
  for (int axis = 0; axis < 3; ++axis) {
    cells.counts[axis] = (brick_counts[axis] * BrickMap::kBrickSize + cell_size - 1) / cell_size;
  }
  const std::size_t total =
      std::size_t(cells.counts.x) * std::size_t(cells.counts.y) * std::size_t(cells.counts.z);
  cells.minima.resize(total * components);
  cells.maxima.resize(total * components);
  return cells;
}

SuperVoxels finest_cells(std::span<const BrickMap* const> densities, int cell_size) {
  SuperVoxels cells = empty_cells(densities[0]->brick_counts(), cell_size, densities.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, cells.counts.x), [&](const auto& slab) {
    for (int x = slab.begin(); x < slab.end(); ++x) {
      for (int y = 0; y < cells.counts.y; ++y) {
        for (int z = 0; z < cells.counts.z; ++z) {
          const Vec3i corner = Vec3i(x, y, z) * cell_size;
          const std::size_t cell = cell_index(cells.counts, x, y, z);
          for (std::size_t k = 0; k < densities.size(); ++k) {
            const Range range =
                range_of_voxels(*densities[k], corner - Vec3i(1), corner + Vec3i(cell_size + 1));
            cells.minima[cell * densities.size() + k] = range.minimum;
            cells.maxima[cell * densities.size() + k] = range.maximum;
          }
        }
      }
    }
  });
  return cells;
}

/// Cells of twice the edge. The dilated voxels of a cell are the union of its children's.
SuperVoxels coarser_cells(const SuperVoxels& fine, const Vec3i& brick_counts) {
  const std::size_t components = fine.components;
  SuperVoxels cells = empty_cells(brick_counts, fine.cell_size * 2, components);
  std::fill(cells.minima.begin(), cells.minima.end(), std::numeric_limits<float>::infinity());
  std::fill(cells.maxima.begin(), cells.maxima.end(), -std::numeric_limits<float>::infinity());
  for (int x = 0; x < fine.counts.x; ++x) {
    for (int y = 0; y < fine.counts.y; ++y) {
      for (int z = 0; z < fine.counts.z; ++z) {
        const std::size_t child = cell_index(fine.counts, x, y, z) * components;
        const std::size_t parent = cell_index(cells.counts, x / 2, y / 2, z / 2) * components;
        for (std::size_t k = 0; k < components; ++k) {
          cells.minima[parent + k] = std::min(cells.minima[parent + k], fine.minima[child + k]);
          cells.maxima[parent + k] = std::max(cells.maxima[parent + k], fine.maxima[child + k]);
        }
      }
    }
  }
  return cells;
}

/// Expected cost of a voxel's length, the mean over the volume that is not empty. The volume counts
/// in voxels, so that sizes can be compared: what a coarse cell adds to it is paid for.
double expected_cost(const SuperVoxels& cells, std::span<const float> extinction,
                     const SuperVoxelCost& cost) {
  const std::size_t components = cells.components;
  double lookups = 0;
  double steps = 0;
  for (std::size_t cell = 0; cell < cells.maxima.size() / components; ++cell) {
    double majorant = 0;
    for (std::size_t k = 0; k < components; ++k) {
      majorant += double(cells.maxima[cell * components + k]) * extinction[k];
    }
    if (majorant <= 0) continue;
    lookups += majorant;
    steps += 1.5 / cells.cell_size;
  }
  const double volume = double(cells.cell_size) * cells.cell_size * cells.cell_size;
  return volume * (cost.lookup * lookups + cost.step * steps);
}

/// Chebyshev distance to the nearest cell that is not empty, by one pass along each axis: the
/// distance is the maximum over the axes, so it separates.
void fill_empty_radius(SuperVoxels& cells) {
  constexpr int kFar = 1 << 20;
  const Vec3i& counts = cells.counts;
  const std::size_t components = cells.components;
  std::vector<int32_t>& radius = cells.empty_radius;
  radius.assign(cells.maxima.size() / components, kFar);
  for (std::size_t cell = 0; cell < radius.size(); ++cell) {
    for (std::size_t k = 0; k < components; ++k) {
      if (cells.maxima[cell * components + k] > 0) radius[cell] = 0;
    }
  }
  const std::size_t strides[3] = {std::size_t(counts.y) * counts.z, std::size_t(counts.z), 1};
  for (int axis = 0; axis < 3; ++axis) {
    const int length = counts[axis];
    const int other1 = counts[(axis + 1) % 3];
    const int other2 = counts[(axis + 2) % 3];
    const std::size_t stride = strides[axis];
    tbb::parallel_for(tbb::blocked_range<int>(0, other1), [&](const auto& rows) {
      std::vector<int32_t> line(length);
      std::vector<int32_t> result(length);
      for (int a = rows.begin(); a < rows.end(); ++a) {
        for (int b = 0; b < other2; ++b) {
          int32_t* first =
              radius.data() + a * strides[(axis + 1) % 3] + b * strides[(axis + 2) % 3];
          for (int i = 0; i < length; ++i) line[i] = first[i * stride];
          // min over j of max(|i-j|, line[j]); lines are short and the search stops early.
          for (int i = 0; i < length; ++i) {
            int32_t best = line[i];
            for (int reach = 1; reach < best; ++reach) {
              if (i >= reach) best = std::min(best, std::max(reach, line[i - reach]));
              if (i + reach < length) best = std::min(best, std::max(reach, line[i + reach]));
              if (i < reach && i + reach >= length) break;
            }
            result[i] = best;
          }
          for (int i = 0; i < length; ++i) first[i * stride] = result[i];
        }
      }
    });
  }
}

}  // namespace

std::size_t SuperVoxels::memory_bytes() const {
  return (minima.capacity() + maxima.capacity()) * sizeof(float) +
         empty_radius.capacity() * sizeof(int32_t);
}

SuperVoxelSummary summarize(const SuperVoxels& cells, int component) {
  SuperVoxelSummary summary;
  summary.cells = cells.cell_count();
  for (std::size_t cell = 0; cell < summary.cells; ++cell) {
    const std::size_t entry = cell * cells.components + component;
    if (cells.maxima[entry] <= 0) continue;
    ++summary.occupied;
    summary.mean_maximum += cells.maxima[entry];
    summary.mean_minimum += cells.minima[entry];
  }
  const auto occupied = static_cast<double>(std::max<std::size_t>(summary.occupied, 1));
  summary.mean_maximum /= occupied;
  summary.mean_minimum /= occupied;
  return summary;
}

SuperVoxels build_super_voxels(std::span<const BrickMap* const> densities,
                               std::span<const float> extinction, int cell_size,
                               const SuperVoxelCost& cost) {
  if (cell_size != 0 && std::find(std::begin(kSuperVoxelSizes), std::end(kSuperVoxelSizes),
                                  cell_size) == std::end(kSuperVoxelSizes)) {
    fail(
        "a super-voxel of {} voxels is not possible: choose 4, 8, 16, 32 or 64, or 0 for automatic",
        cell_size);
  }
  const Vec3i brick_counts = densities[0]->brick_counts();
  const std::size_t fine_cells =
      8 * std::size_t(brick_counts.x) * std::size_t(brick_counts.y) * std::size_t(brick_counts.z);
  const bool fine = cell_size == 4 || (cell_size == 0 && fine_cells <= kMaxFineCells);
  SuperVoxels cells = finest_cells(densities, fine ? 4 : 8);
  std::optional<SuperVoxels> best;
  double best_cost = std::numeric_limits<double>::infinity();
  while (true) {
    if (cells.cell_size == cell_size) {
      best = std::move(cells);
      break;
    }
    const double this_cost = expected_cost(cells, extinction, cost);
    const bool last = cells.cell_size == kSuperVoxelSizes[std::size(kSuperVoxelSizes) - 1];
    SuperVoxels coarse = last ? SuperVoxels{} : coarser_cells(cells, brick_counts);
    if (cell_size == 0 && (this_cost < best_cost || !best)) {
      best = std::move(cells);
      best_cost = this_cost;
    }
    if (last) break;
    cells = std::move(coarse);
  }
  fill_empty_radius(*best);
  return std::move(*best);
}

}  // namespace freepath
