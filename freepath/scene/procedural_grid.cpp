#include "freepath/scene/procedural_grid.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>

#include "freepath/base/error.h"

namespace freepath::procedural {
namespace {

constexpr int kMinResolution = 16, kMaxResolution = 2048;
constexpr int kSide = BrickMap::kBrickSize;
constexpr int kVoxels = BrickMap::kBrickVoxels;

/// Counts bricks and reports each percent once.
class Progress {
 public:
  Progress(const std::function<void(double)>& report, std::size_t total)
      : report_(report), total_(total) {}

  void add(std::size_t count) {
    if (!report_) return;
    const std::lock_guard lock(mutex_);
    done_ += count;
    const std::size_t percent = 100 * done_ / total_;
    if (percent == reported_) return;
    reported_ = percent;
    report_(static_cast<double>(done_) / static_cast<double>(total_));
  }

 private:
  const std::function<void(double)>& report_;
  std::size_t total_, done_ = 0, reported_ = 0;
  std::mutex mutex_;
};

/// What a sampler made of a brick, null where it is empty.
using BrickValues = std::unique_ptr<float[]>;

struct Bounds {
  Vec3i low{std::numeric_limits<int>::max()}, high{std::numeric_limits<int>::min()};
};

/// Bounds of the voxels other than 0.
Bounds bounds_of(std::span<const Vec3i> bricks, std::span<const float> values) {
  Bounds bounds;
  for (std::size_t i = 0; i < bricks.size(); ++i) {
    for (int offset = 0; offset < kVoxels; ++offset) {
      if (values[i * kVoxels + static_cast<std::size_t>(offset)] == 0) continue;
      const Vec3i voxel = bricks[i] * kSide + Vec3i(offset >> 6, offset >> 3 & 7, offset & 7);
      for (int axis = 0; axis < 3; ++axis) {
        bounds.low[axis] = std::min(bounds.low[axis], voxel[axis]);
        bounds.high[axis] = std::max(bounds.high[axis], voxel[axis]);
      }
    }
  }
  return bounds;
}

BrickMap map_of(std::span<const Vec3i> bricks, std::span<BrickValues> values, std::size_t field,
                bool last) {
  Bounds span;
  for (const Vec3i& brick : bricks) {
    for (int axis = 0; axis < 3; ++axis) {
      span.low[axis] = std::min(span.low[axis], brick[axis] * kSide);
      span.high[axis] = std::max(span.high[axis], brick[axis] * kSide + kSide - 1);
    }
  }
  BrickMapBuilder builder(span.low, span.high, bricks.size());
  const std::span<float> voxels = builder.add_bricks(bricks);
  for (std::size_t i = 0; i < bricks.size(); ++i) {
    std::copy_n(values[i].get() + field * kVoxels, kVoxels, voxels.data() + i * kVoxels);
    if (last) values[i].reset();  // so that the values are not twice in memory at the end
  }
  const Bounds active = bounds_of(bricks, voxels);
  builder.set_active_bounds(active.low, active.high);
  return std::move(builder).finish();
}

}  // namespace

GridShape grid_over(const Box3f& box, int resolution) {
  if (resolution < kMinResolution || resolution > kMaxResolution) {
    fail("a resolution of {} voxels; it must be {} to {}", resolution, kMinResolution,
         kMaxResolution);
  }
  GridShape shape;
  shape.voxel_size = kLongestSide / static_cast<float>(resolution);
  for (int axis = 0; axis < 3; ++axis) {
    const float voxels = (box.max[axis] - box.min[axis]) / shape.voxel_size;
    shape.size[axis] = std::clamp(static_cast<int>(std::ceil(voxels - 1e-3F)), 1, resolution);
  }
  shape.origin = box.min + Vec3f(shape.voxel_size / 2);
  return shape;
}

std::vector<Field> sample_fields(const GridShape& shape, std::span<const std::string> names,
                                 const BrickSampler& sampler,
                                 const std::function<void(double)>& report) {
  const Vec3i counts = (shape.size + Vec3i(kSide - 1)) / kSide;
  const std::size_t slab = std::size_t(counts.y) * std::size_t(counts.z);
  const std::size_t total = std::size_t(counts.x) * slab;
  std::vector<BrickValues> values(total);
  Progress progress(report, total);
  const auto coord_of = [&](std::size_t i) {
    return Vec3i(static_cast<int>(i / slab), static_cast<int>(i % slab) / counts.z,
                 static_cast<int>(i % slab) % counts.z);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, total, 16), [&](const auto& range) {
    std::vector<float> sampled(names.size() * kVoxels);
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      BrickRegion brick;
      brick.first = coord_of(i) * kSide;
      brick.centre = shape.centre(brick.first) + Vec3f(3.5F * shape.voxel_size);
      brick.radius = 3.5F * std::sqrt(3.0F) * shape.voxel_size;
      std::ranges::fill(sampled, 0.0F);
      if (!sampler(brick, sampled)) continue;
      values[i] = std::make_unique<float[]>(sampled.size());
      std::ranges::copy(sampled, values[i].get());
    }
    progress.add(range.size());
  });

  std::vector<Vec3i> bricks;
  for (std::size_t i = 0; i < total; ++i) {
    if (values[i]) bricks.push_back(coord_of(i));
  }
  std::erase(values, nullptr);
  std::vector<Field> fields(names.size());
  for (std::size_t field = 0; field < names.size(); ++field) {
    fields[field].name = names[field];
    fields[field].voxels = map_of(bricks, values, field, field + 1 == names.size());
    fields[field].index_to_world.setScale(Vec3d(shape.voxel_size));
    for (int axis = 0; axis < 3; ++axis) {
      fields[field].index_to_world[3][axis] = shape.origin[axis];
    }
  }
  return fields;
}

float SphereUnion::distance(const Vec3f& point) const {
  float nearest = std::numeric_limits<float>::max();
  for (const Sphere& sphere : spheres_) {
    // Compared before the root is taken: most spheres are farther, and a root is slow.
    const float squared = (point - sphere.centre).length2();
    const float reach = nearest + sphere.radius;
    if (reach > 0 && squared < reach * reach) nearest = std::sqrt(squared) - sphere.radius;
  }
  return nearest;
}

Box3f SphereUnion::bounds() const {
  Box3f box;
  for (const Sphere& sphere : spheres_) {
    box.extendBy(sphere.centre - Vec3f(sphere.radius));
    box.extendBy(sphere.centre + Vec3f(sphere.radius));
  }
  return box;
}

SphereUnion SphereUnion::near(const Vec3f& centre, float radius) const {
  const float reach = distance(centre) + 2 * radius;
  std::vector<Sphere> kept;
  for (const Sphere& sphere : spheres_) {
    if ((centre - sphere.centre).length() - sphere.radius <= reach) kept.push_back(sphere);
  }
  return SphereUnion(std::move(kept));
}

void SphereUnion::transform(float scale, const Vec3f& offset) {
  for (Sphere& sphere : spheres_) {
    sphere.centre = sphere.centre * scale + offset;
    sphere.radius *= scale;
  }
}

}  // namespace freepath::procedural
