#include "freepath/paths/emission_guide.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace freepath {
namespace {

/// A ray that moves less along an axis does not move [cells/m]; reciprocals stay finite.
constexpr float kFlat = 1e-30F;

}  // namespace

EmissionGuide::EmissionGuide(EmissionCells cells) : cells_(std::move(cells)) {
  const double sum = std::accumulate(cells_.power.begin(), cells_.power.end(), 0.0);
  if (!(sum > 0)) return;
  const double volume = cells_.grid.cell_volume();
  power_ = sum * volume;
  const std::vector<double> weights(cells_.power.begin(), cells_.power.end());
  table_ = make_alias_table(weights);
  for (const double weight : weights) {
    density_.push_back(static_cast<float>(weight / sum / volume / 3));
  }
}

std::optional<GuideSample> EmissionGuide::sample(const Vec3f& position,
                                                 RandomStream& random) const {
  if (table_.empty()) return std::nullopt;
  std::size_t cell =
      std::min(static_cast<std::size_t>(random.uniform() * static_cast<float>(table_.size())),
               table_.size() - 1);
  // What is left of that number is too coarse to decide.
  if (!(random.uniform() < table_[cell].threshold)) cell = table_[cell].alias;
  Vec3f point(cells_.grid.cell(cell));
  for (int axis = 0; axis < 3; ++axis) point[axis] += random.uniform();
  const Vec3f way = apply(cells_.grid.grid_to_world, point) - position;
  const float length = way.length();
  if (!(length > 0)) return std::nullopt;
  const Vec3f direction = way / length;
  return GuideSample{direction, pdf(position, direction)};
}

float EmissionGuide::pdf(const Vec3f& position, const Vec3f& direction) const {
  if (table_.empty()) return 0;
  const CellGrid& grid = cells_.grid;
  const auto& linear = grid.world_to_grid.linear;
  const Vec3f origin = apply(grid.world_to_grid, position);
  Vec3f along;
  Vec3f reciprocal;
  float begin = 0;
  float last = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    along[axis] = direction.x * linear[0][axis] + direction.y * linear[1][axis] +
                  direction.z * linear[2][axis];
    const auto size = static_cast<float>(grid.counts[axis]);
    if (std::abs(along[axis]) < kFlat) {
      along[axis] = 0;
      if (!(origin[axis] >= 0 && origin[axis] <= size)) return 0;
      continue;
    }
    reciprocal[axis] = 1 / along[axis];
    const float low = (0 - origin[axis]) * reciprocal[axis];
    const float high = (size - origin[axis]) * reciprocal[axis];
    begin = std::max(begin, std::min(low, high));
    last = std::min(last, std::max(low, high));
  }
  if (!(begin < last)) return 0;

  // Through the cells in order [Amanatides87]. The last face is met at `last` exactly, since both
  // are rounded alike: the walk ends inside of the grid.
  Vec3f face;
  Vec3f pace;
  Vec3f next(std::numeric_limits<float>::infinity());
  Vec3i stride(grid.counts.y * grid.counts.z, grid.counts.z, 1);
  int index = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int cell =
        std::clamp(static_cast<int>(origin[axis] + along[axis] * begin), 0, grid.counts[axis] - 1);
    index += cell * stride[axis];
    const bool forward = along[axis] > 0;
    face[axis] = static_cast<float>(forward ? cell + 1 : cell);
    pace[axis] = forward ? 1.0F : -1.0F;
    if (along[axis] != 0) next[axis] = (face[axis] - origin[axis]) * reciprocal[axis];
    if (!forward) stride[axis] = -stride[axis];
  }
  float sum = 0;
  while (true) {
    const float met = std::min({next.x, next.y, next.z});
    const float end = std::max(std::min(met, last), begin);
    // 3 ∫ r² dr, without the difference of two cubes.
    sum += density_[index] * (end - begin) * (end * end + end * begin + begin * begin);
    if (met >= last) return sum;
    begin = end;
    // Without branches, which no processor could foresee; through edges both at once.
    for (int axis = 0; axis < 3; ++axis) {
      const bool crosses = next[axis] <= met;
      face[axis] += crosses ? pace[axis] : 0.0F;
      index += crosses ? stride[axis] : 0;
      next[axis] = crosses ? (face[axis] - origin[axis]) * reciprocal[axis] : next[axis];
    }
  }
}

}  // namespace freepath
