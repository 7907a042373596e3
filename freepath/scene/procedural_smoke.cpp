// A column of smoke. Where a puff came from is found by walking back along a turbulent velocity
// field; the column is simple there, and its detail is carried along, which curls it.

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "freepath/scene/procedural.h"
#include "freepath/scene/procedural_grid.h"
#include "freepath/scene/procedural_noise.h"

namespace freepath {
namespace procedural {
namespace {

constexpr float kWidth = 60;  // of the box around the column; its height is kLongestSide

/// Vectors on a coarse lattice over the box, interpolated: flows are smooth, and dear to follow.
class CoarseFlow {
 public:
  template <class Function>
  CoarseFlow(const Box3f& box, float spacing, const Function& function)
      : origin_(box.min), spacing_(spacing) {
    for (int axis = 0; axis < 3; ++axis) {
      counts_[axis] = static_cast<int>(std::ceil((box.max[axis] - box.min[axis]) / spacing)) + 2;
    }
    vectors_.resize(std::size_t(counts_.x) * std::size_t(counts_.y) * std::size_t(counts_.z));
    tbb::parallel_for(0, counts_.x, [&](int x) {
      for (int y = 0; y < counts_.y; ++y) {
        for (int z = 0; z < counts_.z; ++z) {
          vectors_[at(x, y, z)] = function(origin_ + Vec3f(Vec3i(x, y, z)) * spacing_);
        }
      }
    });
  }

  Vec3f operator()(const Vec3f& point) const {
    const Vec3f position = (point - origin_) / spacing_;
    int base[3];
    float part[3];
    for (int axis = 0; axis < 3; ++axis) {
      base[axis] = std::clamp(static_cast<int>(position[axis]), 0, counts_[axis] - 2);
      part[axis] = std::clamp(position[axis] - static_cast<float>(base[axis]), 0.0F, 1.0F);
    }
    Vec3f sum(0);
    for (int corner = 0; corner < 8; ++corner) {
      const int dx = corner >> 2, dy = corner >> 1 & 1, dz = corner & 1;
      const float weight = (dx != 0 ? part[0] : 1 - part[0]) * (dy != 0 ? part[1] : 1 - part[1]) *
                           (dz != 0 ? part[2] : 1 - part[2]);
      sum += vectors_[at(base[0] + dx, base[1] + dy, base[2] + dz)] * weight;
    }
    return sum;
  }

 private:
  std::size_t at(int x, int y, int z) const {
    return (std::size_t(x) * std::size_t(counts_.y) + std::size_t(y)) * std::size_t(counts_.z) +
           std::size_t(z);
  }

  Vec3f origin_;
  float spacing_;
  Vec3i counts_{0};
  std::vector<Vec3f> vectors_;
};

/// Velocity of the air, a unit of length in a unit of time: eddies that grow on the way up.
Vec3f velocity(const Vec3f& point, uint32_t seed) {
  const float strength = 1.1F * smooth_step(-5, 30, point.y) + 0.1F;
  const Vec3f large = curl_noise(point * 0.055F, seed + 1) * 0.9F;
  const Vec3f small = curl_noise(point * 0.13F, seed + 2) * 0.5F;
  return (large + small) * strength;
}

/// How far a puff was carried from where it would be in still air.
Vec3f carried(Vec3f point, uint32_t seed) {
  const Vec3f end = point;
  constexpr int kSteps = 10;
  constexpr float kTime = 0.45F;
  for (int step = 0; step < kSteps; ++step) point -= velocity(point, seed) * kTime;
  return end - point;
}

struct Smoke {
  const CoarseFlow& flow;
  uint32_t seed;
  int octaves;

  /// Radius of the column at a height, before turbulence.
  static float radius(float height) { return 5.0F + 0.13F * height; }

  float density(const Vec3f& point) const {
    const Vec3f source = point - flow(point);
    const float height = source.y;
    if (height < 0 || height > kLongestSide || point.y < 0) return 0;
    const float lean = 0.05F * height;
    const Vec3f axis(lean * std::sin(0.05F * height), 0, lean * std::cos(0.043F * height));
    const float wide = radius(height);
    const float out = std::hypot(source.x - axis.x, source.z - axis.z) / wide;
    if (out > 1.6F) return 0;
    // Puffs: the source pulses, and tears as it cools.
    const Vec3f stretched = source * Vec3f(1, 0.75F, 1);
    const float puffs =
        fractal_noise(stretched * (1.1F / wide) + Vec3f(0, 3, 0), 2, 0.5F, seed + 3);
    const float detail = fractal_noise(stretched * 0.22F, octaves, 0.58F, seed + 4);
    const float shape = 1 - out + 0.75F * puffs + 0.55F * detail;
    const float thin = 1 - 0.8F * smooth_step(10, kLongestSide, height);
    const float ends = smooth_step(0, 3, point.y) * smooth_step(kLongestSide, 72, point.y);
    const float value = smooth_step(0.02F, 0.8F, shape) * thin * ends;
    return value < 2e-3F ? 0 : std::min(1.0F, value);
  }
};

}  // namespace
}  // namespace procedural

std::vector<Field> generate_smoke(const ProceduralOptions& options) {
  using namespace procedural;
  const auto seed = static_cast<uint32_t>(options.seed ^ options.seed >> 32) * 91U + 5U;
  const Box3f box(Vec3f(-kWidth / 2, 0, -kWidth / 2), Vec3f(kWidth / 2, kLongestSide, kWidth / 2));
  const GridShape shape = grid_over(box, options.resolution);
  constexpr float kSpacing = 2;
  const CoarseFlow flow(box, kSpacing, [&](const Vec3f& point) { return carried(point, seed); });
  // Octaves of detail down to two voxels; the first has features of 4.5.
  int octaves = 1;
  for (float size = 4.5F; size > 4 * shape.voxel_size && octaves < 8; size /= 2) ++octaves;
  const Smoke smoke{flow, seed, octaves};
  const std::string names[] = {"density"};
  return sample_fields(
      shape, names,
      [&](const BrickRegion& brick, std::span<float> values) {
        return sample_voxels(shape, brick, values,
                             [&](const Vec3f& point) { return std::array{smoke.density(point)}; });
      },
      options.progress);
}

}  // namespace freepath
