#include "freepath/render/paths/emission_guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace freepath {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The part of a ray in a box.
struct Interval {
  float begin, end;
};

/// @param reciprocal of the direction's coordinates, which may be infinite
Interval clip(const Vec3f& origin, const Vec3f& direction, const Vec3f& reciprocal,
              const Vec3f& low, const Vec3f& high) {
  Interval part{0, kInfinity};
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) {
      if (origin[axis] < low[axis] || origin[axis] > high[axis]) return {0, -1};
      continue;
    }
    const float a = (low[axis] - origin[axis]) * reciprocal[axis];
    const float b = (high[axis] - origin[axis]) * reciprocal[axis];
    part.begin = std::max(part.begin, std::min(a, b));
    part.end = std::min(part.end, std::max(a, b));
  }
  return part;
}

/// 48 bits in [0, 1): 24 would prefer some cells of a large grid to others.
double fine_uniform(RandomStream& random) {
  const double high = random.uniform();
  return high + random.uniform() * 0x1p-24;
}

}  // namespace

EmissionGuide::EmissionGuide(EmissionCells cells) : cells_(std::move(cells)) {
  double sum = 0;
  for (const float power : cells_.power) sum += power;
  if (!(sum > 0)) return;
  const double volume = cells_.cell_volume();
  power_ = sum * volume;
  first_ = cells_.counts;
  std::vector<double> weights;
  density_.resize(cells_.power.size());
  for (std::size_t i = 0; i < cells_.power.size(); ++i) {
    if (!(cells_.power[i] > 0)) continue;
    density_[i] = static_cast<float>(cells_.power[i] / sum / volume / 3);
    occupied_.push_back(static_cast<uint32_t>(i));
    weights.push_back(cells_.power[i]);
    const auto row = static_cast<int>(i / cells_.counts.z);
    const Vec3i cell(row / cells_.counts.y, row % cells_.counts.y,
                     static_cast<int>(i % cells_.counts.z));
    for (int axis = 0; axis < 3; ++axis) {
      first_[axis] = std::min(first_[axis], cell[axis]);
      last_[axis] = std::max(last_[axis], cell[axis]);
    }
  }
  table_ = make_alias_table(weights);
}

std::optional<GuideSample> EmissionGuide::sample(const Vec3f& position,
                                                 RandomStream& random) const {
  if (table_.empty()) return std::nullopt;
  const auto size = static_cast<double>(table_.size());
  auto column =
      std::min(static_cast<std::size_t>(fine_uniform(random) * size), table_.size() - 1);
  if (!(random.uniform() < table_[column].threshold)) column = table_[column].alias;
  const uint32_t number = occupied_[column];
  const uint32_t row = number / static_cast<uint32_t>(cells_.counts.z);
  const auto rows = static_cast<uint32_t>(cells_.counts.y);
  Vec3f point(static_cast<float>(row / rows), static_cast<float>(row % rows),
              static_cast<float>(number % static_cast<uint32_t>(cells_.counts.z)));
  for (int axis = 0; axis < 3; ++axis) point[axis] += random.uniform();
  const Vec3f way = apply(cells_.grid_to_world, point) - position;
  const float length = way.length();
  if (!(length > 0)) return std::nullopt;
  GuideSample result{way / length, 0};
  result.pdf = pdf(position, result.direction);
  return result;
}

float EmissionGuide::pdf(const Vec3f& position, const Vec3f& direction) const {
  if (table_.empty()) return 0;
  const Vec3f origin = apply(cells_.world_to_grid, position);
  Vec3f along(0);
  for (int from = 0; from < 3; ++from) {
    for (int to = 0; to < 3; ++to) {
      along[to] += direction[from] * cells_.world_to_grid.linear[from][to];
    }
  }
  const Vec3f reciprocal(1 / along.x, 1 / along.y, 1 / along.z);
  const Interval part =
      clip(origin, along, reciprocal, Vec3f(first_), Vec3f(last_ + Vec3i(1)));
  if (!(part.begin < part.end)) return 0;

  // Through the cells in order [Amanatides87]; what is left of an axis keeps rounding inside.
  std::array<float, 3> next;
  std::array<float, 3> step;
  std::array<int, 3> left;
  std::array<std::ptrdiff_t, 3> stride = {
      static_cast<std::ptrdiff_t>(cells_.counts.y) * cells_.counts.z, cells_.counts.z, 1};
  std::ptrdiff_t index = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float place = origin[axis] + along[axis] * part.begin;
    const int cell = std::clamp(static_cast<int>(std::floor(place)), first_[axis], last_[axis]);
    index += cell * stride[axis];
    const bool forward = along[axis] > 0;
    left[axis] = forward ? last_[axis] - cell : cell - first_[axis];
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
    sum += density_[index] * (end - begin) * (end * end + end * begin + begin * begin);
    if (next[axis] >= part.end || left[axis]-- == 0) return sum;
    begin = end;
    next[axis] += step[axis];
    index += stride[axis];
  }
}

}  // namespace freepath
