#include "freepath/render/paths/emission_guide.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

namespace freepath {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The part of a ray in the box from 0 to a size.
struct Interval {
  float begin, end;
};

/// @param reciprocal of the direction's coordinates, which may be infinite
Interval clip(const Vec3f& origin, const Vec3f& direction, const Vec3f& reciprocal,
              const Vec3f& size) {
  Interval part{0, kInfinity};
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) {
      if (origin[axis] < 0 || origin[axis] > size[axis]) return {0, -1};
      continue;
    }
    const float a = -origin[axis] * reciprocal[axis];
    const float b = (size[axis] - origin[axis]) * reciprocal[axis];
    part.begin = std::max(part.begin, std::min(a, b));
    part.end = std::min(part.end, std::max(a, b));
  }
  return part;
}

/// What every cell has at least of the probability that its power alone would give it.
constexpr double kShareOfPower = 0.05;

/// Steps along the way that a transmittance is estimated over.
constexpr int kSteps = 12;

Vec3f center(const CellGrid& grid, std::size_t i) {
  return apply(grid.grid_to_world, Vec3f(grid.cell(i)) + Vec3f(0.5F));
}

/// Mean extinction between two points [1/m].
double extinction_between(const EmissionCells& cells, const Vec3f& from, const Vec3f& to) {
  const Vec3f a = apply(cells.receivers.world_to_grid, from);
  const Vec3f b = apply(cells.receivers.world_to_grid, to);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const Vec3f point = a + (b - a) * ((static_cast<float>(i) + 0.5F) / kSteps);
    Vec3i cell;
    for (int axis = 0; axis < 3; ++axis) {
      cell[axis] = std::clamp(static_cast<int>(point[axis]), 0, cells.receivers.counts[axis] - 1);
    }
    sum += cells.extinction[cells.receivers.index(cell)];
  }
  return sum / kSteps;
}

/// Radius of a ball of the same volume as a cell, squared [m²].
double squared_radius(const CellGrid& grid) {
  return std::pow(0.75 * grid.cell_volume() * std::numbers::inv_pi, 2.0 / 3);
}

/// A line's part in a cell of this optical thickness shines as if it were so much shorter.
double self_absorption(double thickness) {
  return thickness > 1e-3 ? -std::expm1(-thickness) / thickness : 1 - 0.5 * thickness;
}

}  // namespace

EmissionGuide::EmissionGuide(EmissionCells cells) : cells_(std::move(cells)) {
  const double sum = std::accumulate(cells_.power.begin(), cells_.power.end(), 0.0);
  if (!(sum > 0)) return;
  power_ = sum * cells_.emitters.cell_volume();
  const std::size_t rows = cells_.receivers.size() + 1;
  density_.resize(rows * cells_.emitters.size());
  table_.resize(density_.size());
  tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t row) { fill_row(row); });
}

void EmissionGuide::fill_row(std::size_t row) {
  const CellGrid& emitters = cells_.emitters;
  const CellGrid& receivers = cells_.receivers;
  std::vector<double> weights(emitters.size());
  double sum = 0;
  if (row < receivers.size()) {
    const Vec3f from = center(receivers, row);
    const double radius = std::sqrt(squared_radius(emitters));
    // The mean of 1/r² over a ball around its middle is 3 over its squared radius.
    const double near = (radius * radius + squared_radius(receivers)) / 6;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (!(cells_.power[i] > 0)) continue;
      const Vec3f to = center(emitters, i);
      const double squared = (to - from).length2();
      const double distance = std::max(0.0, std::sqrt(squared) - radius);
      const double opacity = extinction_between(cells_, from, to);
      weights[i] = cells_.power[i] / (squared + near) * std::exp(-opacity * distance) *
                   self_absorption(opacity * 2 * radius);
      sum += weights[i];
    }
  }
  const double scale = sum > 0 ? (1 - kShareOfPower) / sum : 0;
  const double volume = emitters.cell_volume();
  const double power_scale = (sum > 0 ? kShareOfPower : 1) / (power_ / volume);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = weights[i] * scale + cells_.power[i] * power_scale;
    density_[row * weights.size() + i] = static_cast<float>(weights[i] / volume / 3);
  }
  const std::vector<AliasEntry> table = make_alias_table(weights);
  std::copy(table.begin(), table.end(),
            table_.begin() + static_cast<std::ptrdiff_t>(row * weights.size()));
}

std::size_t EmissionGuide::row_of(const Vec3f& position) const {
  const Vec3f place = apply(cells_.receivers.world_to_grid, position);
  const Vec3i& counts = cells_.receivers.counts;
  for (int axis = 0; axis < 3; ++axis) {
    // Written so that a NaN is beyond.
    if (!(place[axis] >= 0 && place[axis] < static_cast<float>(counts[axis]))) {
      return cells_.receivers.size();
    }
  }
  return cells_.receivers.index(Vec3i(place));
}

std::optional<GuideSample> EmissionGuide::sample(const Vec3f& position,
                                                 RandomStream& random) const {
  if (table_.empty()) return std::nullopt;
  const std::size_t row = row_of(position);
  const std::size_t size = cells_.emitters.size();
  const AliasEntry* const table = table_.data() + row * size;
  auto cell =
      std::min(static_cast<std::size_t>(random.uniform() * static_cast<float>(size)), size - 1);
  // What is left of that number is too coarse to decide.
  if (!(random.uniform() < table[cell].threshold)) cell = table[cell].alias;
  Vec3f point(cells_.emitters.cell(cell));
  for (int axis = 0; axis < 3; ++axis) point[axis] += random.uniform();
  const Vec3f way = apply(cells_.emitters.grid_to_world, point) - position;
  const float length = way.length();
  if (!(length > 0)) return std::nullopt;
  const Vec3f direction = way / length;
  return GuideSample{direction, pdf(row, position, direction)};
}

float EmissionGuide::pdf(const Vec3f& position, const Vec3f& direction) const {
  return table_.empty() ? 0 : pdf(row_of(position), position, direction);
}

float EmissionGuide::pdf(std::size_t row, const Vec3f& position, const Vec3f& direction) const {
  const CellGrid& grid = cells_.emitters;
  const float* const density = density_.data() + row * grid.size();
  const Vec3f origin = apply(grid.world_to_grid, position);
  Vec3f along(0);
  for (int from = 0; from < 3; ++from) {
    for (int to = 0; to < 3; ++to) {
      along[to] += direction[from] * grid.world_to_grid.linear[from][to];
    }
  }
  const Vec3f reciprocal(1 / along.x, 1 / along.y, 1 / along.z);
  const Interval part = clip(origin, along, reciprocal, Vec3f(grid.counts));
  if (!(part.begin < part.end)) return 0;

  // Through the cells in order [Amanatides87]; what is left of an axis keeps rounding inside.
  std::array<float, 3> next;
  std::array<float, 3> step;
  std::array<int, 3> left;
  std::array<int, 3> stride = {grid.counts.y * grid.counts.z, grid.counts.z, 1};
  int index = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float place = origin[axis] + along[axis] * part.begin;
    const int cell = std::clamp(static_cast<int>(place), 0, grid.counts[axis] - 1);
    index += cell * stride[axis];
    const bool forward = along[axis] > 0;
    left[axis] = forward ? grid.counts[axis] - 1 - cell : cell;
    step[axis] = std::abs(reciprocal[axis]);
    const auto face = static_cast<float>(forward ? cell + 1 : cell);
    next[axis] = along[axis] == 0 ? kInfinity : (face - origin[axis]) * reciprocal[axis];
    if (!forward) stride[axis] = -stride[axis];
  }
  float sum = 0;
  float begin = part.begin;
  while (true) {
    const int axis = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    const float end = std::max(std::min(next[axis], part.end), begin);
    // 3 ∫ r² dr, without the difference of two cubes.
    sum += density[index] * (end - begin) * (end * end + end * begin + begin * begin);
    if (next[axis] >= part.end || left[axis]-- == 0) return sum;
    begin = end;
    next[axis] += step[axis];
    index += stride[axis];
  }
}

}  // namespace freepath
