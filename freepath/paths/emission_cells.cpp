#include "freepath/paths/emission_cells.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "freepath/base/box.h"
#include "freepath/media/density_function.h"
#include "freepath/media/voxel_range.h"

namespace freepath {
namespace {

/// Points along each axis of a cell at which emission is evaluated.
constexpr int kPoints = 5;

/// What a cell has at least of the most that it could emit: the points may have missed it.
constexpr float kLeastShare = 0.01F;

/// Of the grid in which the box around all that can emit is sought.
constexpr int kCellsOfSearch = 32 * 32 * 32;

/// How far rounding may move a position [voxels].
constexpr double kSlack = 1e-2;

Matrix4d to_matrix(const AffineMap& map) {
  Matrix4d matrix;
  for (int to = 0; to < 3; ++to) {
    for (int from = 0; from < 3; ++from) matrix[from][to] = map.linear[from][to];
    matrix[3][to] = map.offset[to];
  }
  return matrix;
}

AffineMap to_map(const Matrix4d& matrix) {
  AffineMap map;
  for (int to = 0; to < 3; ++to) {
    for (int from = 0; from < 3; ++from) {
      map.linear[from][to] = static_cast<float>(matrix[from][to]);
    }
    map.offset[to] = static_cast<float>(matrix[3][to]);
  }
  return map;
}

/// A field, to be read at points of the grid.
class PlacedField {
 public:
  /// @param to_voxels grid → position in the field's voxels; unused for functions
  /// @param to_world grid → world; for functions alone
  PlacedField(const Field& field, const Matrix4d& to_voxels, const Matrix4d& to_world)
      : field_(&field), to_world_(to_world), to_voxels_(to_voxels) {
    if (!field.function) ranges_ = std::make_unique<VoxelRanges>(field.voxels);
  }

  double at(const Vec3d& point) const {
    if (field_->function) {
      const Vec3f position(point * to_world_);
      float density = 0;
      field_->function->evaluate(std::span(&position, 1), std::span(&density, 1));
      return density;
    }
    return field_->voxels.interpolate(point * to_voxels_ + Vec3d(field_->voxels.origin()) -
                                      Vec3d(0.5));
  }

  /// What any interpolation can read in a box of the grid.
  ValueRange range(const Box3d& box) const {
    ValueRange range;
    if (field_->function) {
      const Box3d world = Imath::transform(box, to_world_);
      Box3f part = field_->function->box;
      for (int axis = 0; axis < 3; ++axis) {
        part.min[axis] = std::max(part.min[axis], static_cast<float>(world.min[axis]));
        part.max[axis] = std::min(part.max[axis], static_cast<float>(world.max[axis]));
      }
      const auto [low, high] = field_->function->bounds(part);
      range.add({low, high});
      return range;
    }
    const Box3d voxels = Imath::transform(box, to_voxels_);
    Vec3i begin;
    Vec3i end;
    for (int axis = 0; axis < 3; ++axis) {
      begin[axis] = static_cast<int>(std::floor(voxels.min[axis] - 0.5 - kSlack));
      end[axis] = static_cast<int>(std::floor(voxels.max[axis] - 0.5 + kSlack)) + 2;
    }
    return ranges_->of_box(begin, end);
  }

 private:
  const Field* field_;
  Matrix4d to_world_;
  Matrix4d to_voxels_;
  std::unique_ptr<VoxelRanges> ranges_;
};

/// The radiance that a field's value stands for: as the walk has it.
float radiance_of(const RadianceField& radiance, double value) {
  if (!radiance.table) return static_cast<float>(value);
  const std::vector<float>& table = *radiance.table;
  const auto last = static_cast<double>(table.size() - 1);
  const double position = std::clamp((value - radiance.first) / radiance.step, 0.0, last);
  const double base = std::floor(std::min(position, std::max(last - 1, 0.0)));
  const auto i = static_cast<std::size_t>(base);
  const float after = table[std::min(i + 1, table.size() - 1)];
  return table[i] + static_cast<float>(position - base) * (after - table[i]);
}

/// The largest radiance that a range of values stands for.
float largest_radiance(const RadianceField& radiance, const ValueRange& range) {
  float largest =
      std::max(radiance_of(radiance, range.minimum), radiance_of(radiance, range.maximum));
  if (!radiance.table) return largest;
  const auto& table = *radiance.table;
  const auto last = static_cast<double>(table.size() - 1);
  const auto node = [&](double value) {
    return static_cast<std::size_t>(
        std::clamp((value - radiance.first) / radiance.step, 0.0, last));
  };
  for (std::size_t i = node(range.minimum); i <= node(range.maximum); ++i) {
    largest = std::max(largest, table[i]);
  }
  return largest;
}

/// What one component emits, at points of the grid.
class Emitter {
 public:
  Emitter(const BoundMedium& bound, std::size_t component, const Matrix4d& grid_to_walk,
          const Matrix4d& grid_to_world)
      : channels_(bound.channels.components[component]),
        count_(bound.channels.count),
        density_(*bound.medium->components()[component].density,
                 grid_to_walk * to_matrix(bound.medium->walk_to_component(component)),
                 grid_to_world) {
    for (int c = 0; c < count_; ++c) {
      const Field* const field = channels_.radiance[c].field.get();
      if (field == nullptr || factor(c) == 0) continue;
      if (c > 0 && field == channels_.radiance[c - 1].field.get() && radiance_[c - 1]) {
        radiance_[c] = radiance_[c - 1];
      } else {
        radiance_[c] = std::make_shared<const PlacedField>(
            *field, grid_to_walk * to_matrix(bound.medium->walk_to_field(*field)), grid_to_world);
      }
    }
  }

  bool emits() const {
    float sum = 0;
    for (int c = 0; c < count_; ++c) sum += factor(c);
    return sum > 0;
  }

  /// Mean over the channels [radiance/m].
  double at(const Vec3d& point) const {
    const double density = density_.at(point);
    if (!(density > 0)) return 0;
    double sum = 0;
    double value = 0;
    for (int c = 0; c < count_; ++c) {
      if (radiance_[c] && (c == 0 || radiance_[c] != radiance_[c - 1])) {
        value = radiance_[c]->at(point);
      }
      const float radiance = radiance_[c] ? radiance_of(channels_.radiance[c], value) : 1.0F;
      sum += factor(c) * std::max(radiance, 0.0F);
    }
    return density * sum / count_;
  }

  /// No point of the box emits more.
  double bound(const Box3d& box) const {
    const double density = density_.range(box).maximum;
    if (!(density > 0)) return 0;
    double sum = 0;
    for (int c = 0; c < count_; ++c) {
      if (factor(c) == 0) continue;
      const float radiance =
          radiance_[c] ? largest_radiance(channels_.radiance[c], radiance_[c]->range(box)) : 1.0F;
      sum += factor(c) * std::max(radiance, 0.0F);
    }
    return density * sum / count_;
  }

 private:
  float factor(int c) const { return channels_.sigma_a[c] * channels_.emission[c]; }

  const ComponentChannels& channels_;
  int count_;
  PlacedField density_;
  std::array<std::shared_ptr<const PlacedField>, kMaxChannels> radiance_;  // null: 1
};

/// The middles of as many equal parts of a cell.
template <class Function>
double mean_over_cell(const Vec3i& cell, const Function& function) {
  double sum = 0;
  for (int i = 0; i < kPoints * kPoints * kPoints; ++i) {
    const Vec3d sub_cell(Vec3i(i / (kPoints * kPoints), i / kPoints % kPoints, i % kPoints));
    sum += function(Vec3d(cell) + (sub_cell + Vec3d(0.5)) / kPoints);
  }
  return sum / (kPoints * kPoints * kPoints);
}

double bound_of(std::span<const Emitter> emitters, const Vec3i& cell) {
  double bound = 0;
  for (const Emitter& emitter : emitters) {
    bound += emitter.bound({Vec3d(cell), Vec3d(cell + Vec3i(1))});
  }
  return bound;
}

/// Calls a function for every cell, on all threads.
template <class Function>
void for_each_cell(const CellGrid& grid, const Function& function) {
  tbb::parallel_for(std::size_t{0}, grid.size(), [&](std::size_t i) { function(i, grid.cell(i)); });
}

/// What grids of a medium are made from.
struct GridMaker {
  const BoundMedium& bound;
  Matrix4d walk_to_world;  // relative to the origin
  Matrix4d from_origin;

  Matrix4d grid_to_walk(const Box3d& box, const Vec3i& counts) const {
    Matrix4d matrix;
    matrix.setScale(box.size() / Vec3d(counts));
    for (int axis = 0; axis < 3; ++axis) matrix[3][axis] = box.min[axis];
    return matrix;
  }

  CellGrid make(const Box3d& box, const Vec3i& counts) const {
    const Matrix4d grid_to_world = grid_to_walk(box, counts) * walk_to_world;
    return {to_map(grid_to_world.inverse()), to_map(grid_to_world), counts};
  }

  std::vector<Emitter> emitters(const Box3d& box, const Vec3i& counts) const {
    std::vector<Emitter> result;
    const Matrix4d to_walk = grid_to_walk(box, counts);
    for (std::size_t k = 0; k < bound.channels.components.size(); ++k) {
      result.emplace_back(bound, k, to_walk, to_walk * walk_to_world * from_origin);
      if (!result.back().emits()) result.pop_back();
    }
    return result;
  }

  /// Cells as near to cubes of the world as they can be.
  Vec3i choose_counts(const Box3d& box, int most_cells) const {
    const Medium& medium = *bound.medium;
    const Vec3d size = box.size();
    Vec3d edges;
    for (int axis = 0; axis < 3; ++axis) {
      const double* const row = walk_to_world[axis];
      edges[axis] = size[axis] * Vec3d(row[0], row[1], row[2]).length();
    }
    const double longest = std::max({edges.x, edges.y, edges.z});
    const bool computed = medium.components()[0].density->function != nullptr;
    Vec3i counts(1);
    for (int resolution = 1; resolution <= most_cells; ++resolution) {
      Vec3i finer;
      for (int axis = 0; axis < 3; ++axis) {
        const double voxels = std::ceil(size[axis] * medium.super_voxels().cell_size);
        const double wanted = std::ceil(edges[axis] / longest * resolution - 1e-3);
        finer[axis] = static_cast<int>(std::max(1.0, computed ? wanted : std::min(wanted, voxels)));
      }
      if (static_cast<double>(finer.x) * finer.y * finer.z > most_cells) break;
      counts = finer;
    }
    return counts;
  }

  /// The part of a box that can emit, to within a cell; empty if nothing can.
  Box3d emitting_part(const Box3d& box) const {
    const Vec3i counts = choose_counts(box, kCellsOfSearch);
    const std::vector<Emitter> all = emitters(box, counts);
    const CellGrid grid = make(box, counts);
    std::vector<char> emits(grid.size());
    for_each_cell(grid, [&](std::size_t i, const Vec3i& cell) {
      emits[i] = static_cast<char>(bound_of(all, cell) > 0);
    });
    Box3d cells;
    for (std::size_t i = 0; i < emits.size(); ++i) {
      if (emits[i] == 0) continue;
      cells.extendBy(Vec3d(grid.cell(i)));
      cells.extendBy(Vec3d(grid.cell(i) + Vec3i(1)));
    }
    return cells.isEmpty() ? cells : Imath::transform(cells, grid_to_walk(box, counts));
  }
};

}  // namespace

double CellGrid::cell_volume() const { return std::abs(to_matrix(grid_to_world).determinant()); }

EmissionCells estimate_emission(const BoundMedium& bound, const Vec3d& origin, int most_cells) {
  EmissionCells cells;
  const Medium& medium = *bound.medium;
  const Matrix4d world_to_walk = to_matrix(medium.world_to_walk(origin));
  const double determinant = world_to_walk.determinant();
  if (!bound.channels.emits() || determinant == 0 || !std::isfinite(1 / determinant)) return cells;
  GridMaker maker{bound, world_to_walk.inverse(), Matrix4d()};
  maker.from_origin.setTranslation(origin);
  const Box3f walk_box = medium.walk_bounds(Interpolation::kTrilinear);
  const Box3d whole(Vec3d(walk_box.min), Vec3d(walk_box.max));
  const Box3d glowing = maker.emitting_part(whole);
  if (glowing.isEmpty()) return cells;

  cells.grid = maker.make(glowing, maker.choose_counts(glowing, most_cells));
  const auto emitters = maker.emitters(glowing, cells.grid.counts);
  cells.power.resize(cells.grid.size());
  for_each_cell(cells.grid, [&](std::size_t i, const Vec3i& cell) {
    const double most = bound_of(emitters, cell);
    if (!(most > 0)) return;
    const double mean = mean_over_cell(cell, [&](const Vec3d& point) {
      double sum = 0;
      for (const Emitter& emitter : emitters) sum += emitter.at(point);
      return sum;
    });
    cells.power[i] = static_cast<float>(std::max(mean, kLeastShare * most));
  });
  return cells;
}

}  // namespace freepath
