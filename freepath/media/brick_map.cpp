#include "freepath/media/brick_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "freepath/base/error.h"

namespace freepath {
namespace {

constexpr double kMaxIndexEntries = 1 << 26;              // 256 MiB, some 3200³ voxels
constexpr std::size_t kMaxListed = std::size_t{1} << 24;  // 256 MiB
constexpr std::size_t kMaxBricks = (std::size_t{1} << 31) / BrickMap::kBrickVoxels;

int brick_of(int voxel) { return voxel >> 3; }  // floor, for negative coordinates too

std::size_t voxel_offset(const Vec3i& voxel) {
  return static_cast<std::size_t>((voxel.x & 7) << 6 | (voxel.y & 7) << 3 | (voxel.z & 7));
}

bool comes_before(const Vec3i& a, const Vec3i& b) {
  if (a.x != b.x) return a.x < b.x;
  return a.y != b.y ? a.y < b.y : a.z < b.z;
}

bool is_listed_before(const PlacedBrick& listed, const Vec3i& coord) {
  return comes_before(listed.coord, coord);
}

}  // namespace

uint32_t BrickMap::brick_at(const Vec3i& coord) const {
  if (is_sparse_) {
    const auto found = std::lower_bound(listed_.begin(), listed_.end(), coord, is_listed_before);
    return found != listed_.end() && found->coord == coord ? found->brick : 0;
  }
  const Vec3i entry = coord - origin_ / kBrickSize;
  for (int axis = 0; axis < 3; ++axis) {
    if (entry[axis] < 0 || entry[axis] >= brick_counts_[axis]) return 0;
  }
  return index_[(static_cast<std::size_t>(entry.x) * brick_counts_.y + entry.y) * brick_counts_.z +
                entry.z];
}

BrickWindow BrickMap::window(const Vec3i& begin, const Vec3i& end) const {
  BrickWindow window{begin * kBrickSize, end - begin, nullptr, nullptr};
  const Vec3d counts(window.brick_counts);
  if (counts.x * counts.y * counts.z > kMaxIndexEntries) {
    fail("a box of {} x {} x {} bricks is too many for a dense index", counts.x, counts.y,
         counts.z);
  }
  auto index = std::make_shared<std::vector<uint32_t>>(window.entry_count());
  auto row = index->begin();
  for (int x = begin.x; x < end.x; ++x) {
    for (int y = begin.y; y < end.y; ++y, row += window.brick_counts.z) {
      if (!is_sparse_) {
        for (int z = begin.z; z < end.z; ++z) row[z - begin.z] = brick_at(Vec3i(x, y, z));
        continue;
      }
      auto listed =
          std::lower_bound(listed_.begin(), listed_.end(), Vec3i(x, y, begin.z), is_listed_before);
      const Vec3i past(x, y, end.z);
      for (; listed != listed_.end() && is_listed_before(*listed, past); ++listed) {
        row[listed->coord.z - begin.z] = listed->brick;
      }
    }
  }
  window.index = index->data();
  window.cut_out = std::move(index);
  return window;
}

BrickWindow BrickMap::window() const {
  if (is_sparse_) fail("the map's index is a list of bricks: cut a window out of it");
  return {origin_, brick_counts_, index_.data(), nullptr};
}

void BrickMap::widen_index(const Vec3i& origin, const Vec3i& brick_counts) {
  if (origin == origin_ && brick_counts == brick_counts_) return;
  if (is_sparse_) fail("an index that is a list of bricks can't be widened");
  const Vec3i first = (origin_ - origin) / kBrickSize;
  const Vec3i last = first + brick_counts_;
  for (int axis = 0; axis < 3; ++axis) {
    if (first[axis] < 0 || last[axis] > brick_counts[axis]) {
      fail("a wider index of bricks must hold the present one");
    }
  }
  decltype(index_) wider(std::size_t(brick_counts.x) * std::size_t(brick_counts.y) *
                         std::size_t(brick_counts.z));
  auto row = index_.begin();
  for (int x = first.x; x < last.x; ++x) {
    for (int y = first.y; y < last.y; ++y) {
      const std::size_t entry = (std::size_t(x) * std::size_t(brick_counts.y) + std::size_t(y)) *
                                    std::size_t(brick_counts.z) +
                                std::size_t(first.z);
      std::copy_n(row, brick_counts_.z, wider.begin() + static_cast<std::ptrdiff_t>(entry));
      row += brick_counts_.z;
    }
  }
  index_ = std::move(wider);
  origin_ = origin;
  brick_counts_ = brick_counts;
}

float BrickMap::value(const Vec3i& voxel) const {
  const Vec3i coord(brick_of(voxel.x), brick_of(voxel.y), brick_of(voxel.z));
  return voxels_.empty()
             ? 0.0F
             : voxels_[std::size_t{brick_at(coord)} * kBrickVoxels + voxel_offset(voxel)];
}

double BrickMap::interpolate(const Vec3d& point) const {
  const Vec3i base(static_cast<int>(std::floor(point.x)), static_cast<int>(std::floor(point.y)),
                   static_cast<int>(std::floor(point.z)));
  const Vec3d fraction = point - Vec3d(base);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3i offset(corner >> 2, (corner >> 1) & 1, corner & 1);
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) {
      weight *= offset[axis] != 0 ? fraction[axis] : 1 - fraction[axis];
    }
    sum += weight * value(base + offset);
  }
  return sum;
}

std::size_t BrickMap::memory_bytes() const {
  return index_.capacity() * sizeof(index_[0]) + listed_.capacity() * sizeof(listed_[0]) +
         voxels_.capacity() * sizeof(voxels_[0]);
}

BrickMapBuilder::BrickMapBuilder(const Vec3i& active_min, const Vec3i& active_max,
                                 std::size_t brick_capacity, std::size_t coord_count) {
  map_.active_min_ = active_min;
  map_.active_max_ = active_max;
  if (map_.empty()) return;
  double entries = 1;
  for (int axis = 0; axis < 3; ++axis) {
    constexpr int kLimit = 1 << 29;
    if (active_min[axis] < -kLimit || active_max[axis] > kLimit) {
      fail(
          "voxel coordinates reach from {} to {}, more than {} away from the origin: crop the grid",
          active_min[axis], active_max[axis], kLimit);
    }
    const int first = brick_of(active_min[axis] - 2);
    const int last = brick_of(active_max[axis] + 2);
    map_.origin_[axis] = first * BrickMap::kBrickSize;
    map_.brick_counts_[axis] = last - first + 1;
    entries *= map_.brick_counts_[axis];
  }
  map_.is_sparse_ =
      coord_count != kUnknown && !is_worth_an_index(entries, static_cast<double>(coord_count));
  if (map_.is_sparse_ ? coord_count > kMaxListed : entries > kMaxIndexEntries) {
    fail(
        "the active voxels span {} x {} x {}, too many for {}: crop the grid or split it into "
        "several",
        active_max.x - active_min.x + 1, active_max.y - active_min.y + 1,
        active_max.z - active_min.z + 1,
        map_.is_sparse_ ? fmt::format("an index of {} bricks", coord_count)
                        : "a dense index of bricks");
  }
  if (!map_.is_sparse_) map_.index_.resize(static_cast<std::size_t>(entries));
  map_.voxels_.reserve((brick_capacity + 1) * BrickMap::kBrickVoxels);
  new_brick();  // brick 0, the empty one
}

std::size_t BrickMapBuilder::CoordHash::operator()(const Vec3i& coord) const {
  uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis) {
    hash = (hash ^ static_cast<uint32_t>(coord[axis])) * 0x9E3779B97F4A7C15U;
    hash ^= hash >> 32;
  }
  return hash;
}

uint32_t& BrickMapBuilder::entry(const Vec3i& brick) {
  Vec3i coord;
  for (int axis = 0; axis < 3; ++axis) {
    coord[axis] = brick[axis] - map_.origin_[axis] / BrickMap::kBrickSize;
    if (coord[axis] < 0 || coord[axis] >= map_.brick_counts_[axis]) {
      fail("brick ({}, {}, {}) lies outside the bounds given for the brick map", brick.x, brick.y,
           brick.z);
    }
  }
  if (map_.is_sparse_) return listed_[brick];
  const Vec3i& counts = map_.brick_counts_;
  return map_.index_[(static_cast<std::size_t>(coord.x) * counts.y + coord.y) * counts.z + coord.z];
}

void BrickMapBuilder::check_brick_count(std::size_t count) const {
  if (count > kMaxBricks) {
    fail("more than {} bricks of 8x8x8 voxels: the grid is too large, resample or split it",
         kMaxBricks);
  }
}

uint32_t BrickMapBuilder::new_brick() {
  const std::size_t brick = map_.brick_count();
  check_brick_count(brick + 1);
  map_.voxels_.resize(map_.voxels_.size() + BrickMap::kBrickVoxels);
  shared_.push_back(brick == 0);
  return static_cast<uint32_t>(brick);
}

std::span<float, BrickMap::kBrickVoxels> BrickMapBuilder::add_brick(const Vec3i& brick) {
  uint32_t& slot = entry(brick);
  if (shared_[slot]) slot = new_brick();
  return std::span<float, BrickMap::kBrickVoxels>(
      map_.voxels_.data() + std::size_t{slot} * BrickMap::kBrickVoxels, BrickMap::kBrickVoxels);
}

std::span<float> BrickMapBuilder::add_bricks(std::span<const Vec3i> bricks) {
  const std::size_t first = map_.brick_count();
  check_brick_count(first + bricks.size());
  map_.voxels_.resize(map_.voxels_.size() + bricks.size() * BrickMap::kBrickVoxels);
  shared_.resize(first + bricks.size(), false);
  for (std::size_t i = 0; i < bricks.size(); ++i) {
    entry(bricks[i]) = static_cast<uint32_t>(first + i);
  }
  return std::span(map_.voxels_).subspan(first * BrickMap::kBrickVoxels);
}

void BrickMapBuilder::add_constant_brick(const Vec3i& brick, float value) {
  add_constant_bricks(brick, brick + Vec3i(1), value);
}

void BrickMapBuilder::add_constant_bricks(const Vec3i& begin, const Vec3i& end, float value) {
  if (value == 0.0F) return;
  const auto [found, inserted] = constants_.try_emplace(std::bit_cast<uint32_t>(value), 0);
  if (inserted) {
    found->second = new_brick();
    shared_[found->second] = true;
    const auto first = map_.voxels_.end() - BrickMap::kBrickVoxels;
    std::fill(first, map_.voxels_.end(), value);
  }
  const int run = end.z - begin.z;
  for (int x = begin.x; x < end.x; ++x) {
    for (int y = begin.y; y < end.y; ++y) {
      if (map_.is_sparse_) {
        for (int z = begin.z; z < end.z; ++z) entry(Vec3i(x, y, z)) = found->second;
        continue;
      }
      entry(Vec3i(x, y, end.z - 1)) = found->second;  // checks that the run ends within the index
      std::fill_n(&entry(Vec3i(x, y, begin.z)), run, found->second);
    }
  }
}

void BrickMapBuilder::set_voxel(const Vec3i& voxel, float value) {
  const Vec3i brick(brick_of(voxel.x), brick_of(voxel.y), brick_of(voxel.z));
  const uint32_t before = entry(brick);
  if (shared_[before]) {
    const uint32_t copy = new_brick();
    std::copy_n(map_.voxels_.begin() + std::size_t{before} * BrickMap::kBrickVoxels,
                BrickMap::kBrickVoxels,
                map_.voxels_.begin() + std::size_t{copy} * BrickMap::kBrickVoxels);
    entry(brick) = copy;
  }
  map_.voxels_[std::size_t{entry(brick)} * BrickMap::kBrickVoxels + voxel_offset(voxel)] = value;
}

void BrickMapBuilder::set_active_bounds(const Vec3i& active_min, const Vec3i& active_max) {
  map_.active_min_ = active_min;
  map_.active_max_ = active_max;
}

BrickMap BrickMapBuilder::finish() && {
  map_.listed_.reserve(listed_.size());
  for (const auto& [coord, brick] : listed_) {
    if (brick != 0) map_.listed_.push_back({coord, brick});
  }
  std::sort(map_.listed_.begin(), map_.listed_.end(),
            [](const auto& a, const auto& b) { return comes_before(a.coord, b.coord); });
  return std::move(map_);
}

}  // namespace freepath
