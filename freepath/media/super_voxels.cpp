#include "freepath/media/super_voxels.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "freepath/base/error.h"

namespace freepath {
namespace {

constexpr std::size_t kMaxNumbers = std::size_t{1} << 30;  // lanes address them by 32 bits

std::size_t cell_index(const Vec3i& counts, int x, int y, int z) {
  return (static_cast<std::size_t>(x) * counts.y + y) * counts.z + z;
}

Vec3i cell_counts(const Vec3i& voxel_counts, int cell_size) {
  return (voxel_counts + Vec3i(cell_size - 1)) / cell_size;
}

std::size_t cell_count(const Vec3i& voxel_counts, int cell_size) {
  const Vec3i counts = cell_counts(voxel_counts, cell_size);
  return std::size_t(counts.x) * std::size_t(counts.y) * std::size_t(counts.z);
}

SuperVoxels empty_cells(const Vec3i& voxel_counts, int cell_size, std::size_t components) {
  SuperVoxels cells;
  cells.cell_size = cell_size;
  cells.components = static_cast<int>(components);
  cells.counts = cell_counts(voxel_counts, cell_size);
  const std::size_t total = cell_count(voxel_counts, cell_size);
  cells.minima.resize(total * components);
  cells.maxima.resize(total * components);
  return cells;
}

/// Half-open box of the voxels that bound a component in a cell.
struct VoxelBox {
  Vec3i begin;
  Vec3i end;
};

/// @param corner first position of the cell in the grid
VoxelBox voxels_of_cell(const PlacedVoxels& density, const Vec3i& corner, int cell_size) {
  constexpr double kRounding = 1e-6;  // of maps that are whole numbers of voxels
  const Matrix4d& map = density.to_component;
  const Vec3d first = Vec3d(corner) * map;
  VoxelBox box;
  for (int axis = 0; axis < 3; ++axis) {
    double low = first[axis];
    double high = first[axis];
    for (int from = 0; from < 3; ++from) {
      const double along = map[from][axis] * cell_size;
      (along < 0 ? low : high) += along;
    }
    const double beyond = density.window.brick_counts[axis] * BrickMap::kBrickSize + 1.0;
    const auto inside = [&](double voxel) {
      return static_cast<int>(std::clamp(voxel, -1.0, beyond));
    };
    box.begin[axis] = inside(std::floor(low + kRounding) - 1);
    box.end[axis] = inside(std::ceil(high - kRounding) + 1);
  }
  return box;
}

SuperVoxels finest_cells(std::span<const PlacedVoxels> densities, const Vec3i& voxel_counts,
                         int cell_size) {
  SuperVoxels cells = empty_cells(voxel_counts, cell_size, densities.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, cells.counts.x), [&](const auto& slab) {
    for (int x = slab.begin(); x < slab.end(); ++x) {
      for (int y = 0; y < cells.counts.y; ++y) {
        for (int z = 0; z < cells.counts.z; ++z) {
          const std::size_t cell = cell_index(cells.counts, x, y, z) * densities.size();
          for (std::size_t k = 0; k < densities.size(); ++k) {
            const VoxelBox box =
                voxels_of_cell(densities[k], Vec3i(x, y, z) * cell_size, cell_size);
            const ValueRange range =
                densities[k].ranges->of_box(densities[k].window, box.begin, box.end);
            cells.minima[cell + k] = range.minimum;
            cells.maxima[cell + k] = range.maximum;
          }
        }
      }
    }
  });
  return cells;
}

/// Cells of twice the edge. The dilated voxels of a cell are the union of its children's.
SuperVoxels coarser_cells(const SuperVoxels& fine, const Vec3i& voxel_counts) {
  const std::size_t components = fine.components;
  SuperVoxels cells = empty_cells(voxel_counts, fine.cell_size * 2, components);
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

/// min over j of max(|i - j|, line[j]) for all i, in a time that is linear in the line.
///
/// Of the positions up to i, one counts only while no later one has a smaller value: the rest wait
/// in a queue, older ones with smaller values. Its front is the best until a later position is as
/// good, and from then on never again. The other half is the same from the other end.
class NearestInLine {
 public:
  void replace(std::vector<int32_t>& line) {
    result_ = line;
    waiting_.resize(line.size());
    for (const bool backward : {false, true}) {
      front_ = back_ = 0;
      for (std::size_t step = 0; step < line.size(); ++step) {
        const std::size_t i = backward ? line.size() - 1 - step : step;
        result_[i] = std::min(result_[i], best_of(static_cast<int32_t>(step), line[i]));
      }
    }
    line.swap(result_);
  }
  /// Positions looked at so far.
  std::size_t steps() const { return steps_; }

 private:
  struct Step {
    int32_t step;
    int32_t value;
    int32_t at(int32_t here) const { return std::max(here - step, value); }
  };

  /// Takes the place of a step, and gives the least of those up to it.
  int32_t best_of(int32_t step, int32_t value) {
    for (; back_ > front_ && waiting_[back_ - 1].value >= value; ++steps_) --back_;
    waiting_[back_++] = {step, value};
    ++steps_;
    for (; back_ - front_ > 1 && waiting_[front_ + 1].at(step) <= waiting_[front_].at(step);
         ++steps_) {
      ++front_;
    }
    return waiting_[front_].at(step);
  }

  std::vector<Step> waiting_;
  std::size_t front_ = 0;  ///< Of the queue,
  std::size_t back_ = 0;   ///< and one past its last.
  std::vector<int32_t> result_;
  std::size_t steps_ = 0;
};

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
  std::atomic<std::size_t> steps = 0;
  const std::size_t strides[3] = {std::size_t(counts.y) * counts.z, std::size_t(counts.z), 1};
  for (int axis = 0; axis < 3; ++axis) {
    const int length = counts[axis];
    const int other1 = counts[(axis + 1) % 3];
    const int other2 = counts[(axis + 2) % 3];
    const std::size_t stride = strides[axis];
    tbb::parallel_for(tbb::blocked_range<int>(0, other1), [&](const auto& rows) {
      std::vector<int32_t> line(length);
      NearestInLine nearest;
      for (int a = rows.begin(); a < rows.end(); ++a) {
        for (int b = 0; b < other2; ++b) {
          int32_t* first =
              radius.data() + a * strides[(axis + 1) % 3] + b * strides[(axis + 2) % 3];
          for (int i = 0; i < length; ++i) line[i] = first[i * stride];
          if (*std::min_element(line.begin(), line.end()) == kFar) continue;
          nearest.replace(line);
          for (int i = 0; i < length; ++i) first[i * stride] = line[i];
        }
      }
      steps += nearest.steps();
    });
  }
  cells.radius_steps = steps;
}

void check_size(int wanted) {
  if (wanted == 0 || std::find(std::begin(kSuperVoxelSizes), std::end(kSuperVoxelSizes), wanted) !=
                         std::end(kSuperVoxelSizes)) {
    return;
  }
  fail("a super-voxel of {} voxels is not possible: choose 4, 8, 16, 32 or 64, or 0 for automatic",
       wanted);
}

/// The size that the others are made from: 4 where it is asked for or makes few cells, else 8, or
/// more where that would make too many.
int finest_size(const Vec3i& voxel_counts, int wanted, const CellLimits& limits) {
  if (wanted == 4 || (wanted == 0 && cell_count(voxel_counts, 4) <= limits.few)) return 4;
  int size = 8;
  while (size != wanted && cell_count(voxel_counts, size) > limits.most) size *= 2;
  return size;
}

void check_memory(std::size_t cells, std::size_t components, int size) {
  if (cells * components <= kMaxNumbers) return;
  fail(
      "{} super-voxels of {} voxels are more than can be walked through: choose larger ones, or 0 "
      "for automatic",
      cells, size);
}

}  // namespace

std::size_t SuperVoxels::memory_bytes() const {
  return (minima.capacity() + maxima.capacity()) * sizeof(float) +
         empty_radius.capacity() * sizeof(int32_t);
}

void SuperVoxelSummary::merge(const SuperVoxelSummary& other) {
  cells += other.cells;
  occupied += other.occupied;
  const double share = occupied == 0 ? 0 : double(other.occupied) / double(occupied);
  mean_maximum += share * (other.mean_maximum - mean_maximum);
  mean_minimum += share * (other.mean_minimum - mean_minimum);
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

SuperVoxels build_super_voxels(std::span<const PlacedVoxels> densities, const Vec3i& voxel_counts,
                               std::span<const float> extinction, int cell_size,
                               const CellLimits& limits, const SuperVoxelCost& cost) {
  check_size(cell_size);
  const int finest = finest_size(voxel_counts, cell_size, limits);
  check_memory(cell_count(voxel_counts, finest), densities.size(), finest);
  SuperVoxels cells = finest_cells(densities, voxel_counts, finest);
  std::optional<SuperVoxels> best;
  double best_cost = std::numeric_limits<double>::infinity();
  while (true) {
    if (cells.cell_size == cell_size) {
      best = std::move(cells);
      break;
    }
    const double this_cost = expected_cost(cells, extinction, cost);
    const bool last = cells.cell_size >= kSuperVoxelSizes[std::size(kSuperVoxelSizes) - 1];
    SuperVoxels coarse = last ? SuperVoxels{} : coarser_cells(cells, voxel_counts);
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

SuperVoxels build_super_voxels(std::span<const BrickMap* const> densities,
                               std::span<const float> extinction, int cell_size,
                               const SuperVoxelCost& cost) {
  std::vector<VoxelRanges> ranges;
  ranges.reserve(densities.size());
  std::vector<PlacedVoxels> placed;
  for (const BrickMap* map : densities) {
    ranges.emplace_back(*map);
    placed.push_back({&ranges.back(), map->window(), Matrix4d()});
  }
  const CellLimits limits{CellLimits::kFew,
                          std::max(CellLimits::kFew, placed[0].window.entry_count())};
  return build_super_voxels(placed, densities[0]->brick_counts() * BrickMap::kBrickSize, extinction,
                            cell_size, limits, cost);
}

}  // namespace freepath
