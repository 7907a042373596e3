// Volumes to study methods on: dense, of the highest frequency, and the same at any resolution.

#include <algorithm>
#include <array>
#include <cmath>

#include "freepath/scene/procedural.h"
#include "freepath/scene/procedural_grid.h"
#include "freepath/scene/procedural_noise.h"

namespace freepath {
namespace procedural {
namespace {

constexpr float kFogHeight = 30;
constexpr float kHalf = 0.5F * kLongestSide;

uint32_t seed_of(const ProceduralOptions& options) {
  return mix(static_cast<uint32_t>(options.seed) ^ static_cast<uint32_t>(options.seed >> 32) ^
             0x6C617965U);
}

float distance_to(const Vec3f& point, const Vec3f& centre) {
  return std::sqrt((point - centre).length2());
}

/// Two puffs in opposite corners of the cube; the seed chooses which.
std::vector<Sphere> puff_spheres(uint64_t seed) {
  constexpr float kRadius = 24;
  constexpr float kReach = kHalf - kRadius;
  const Vec3f corner((seed & 1) != 0 ? kReach : -kReach, -kReach,
                     (seed & 2) != 0 ? kReach : -kReach);
  const Vec3f middle(0, kHalf, 0);
  return {{middle + corner, kRadius}, {middle - corner, kRadius}};
}

}  // namespace
}  // namespace procedural

std::vector<Field> generate_fog(const ProceduralOptions& options) {
  using namespace procedural;
  const GridShape shape = grid_over(
      Box3f(Vec3f(-kHalf, 0, -kHalf), Vec3f(kHalf, kFogHeight, kHalf)), options.resolution);
  const uint32_t seed = seed_of(options);
  const std::array<std::string, 1> names = {"density"};
  return sample_fields(
      shape, names,
      [&](const BrickRegion& brick, std::span<float> values) {
        return sample_voxels(shape, brick, values, [&](const Vec3f& point) {
          const float noise = fractal_noise(point * 0.03F, 4, 0.5F, seed);
          return std::array<float, 1>{std::clamp(0.8F + 0.25F * noise, 0.55F, 1.0F)};
        });
      },
      options.progress);
}

std::vector<Field> generate_noise(const ProceduralOptions& options) {
  using namespace procedural;
  const GridShape shape = grid_over(
      Box3f(Vec3f(-kHalf, 0, -kHalf), Vec3f(kHalf, kLongestSide, kHalf)), options.resolution);
  const uint32_t seed = seed_of(options);
  const std::array<std::string, 1> names = {"density"};
  const Vec3f centre(0, kHalf, 0);
  return sample_fields(
      shape, names,
      [&](const BrickRegion& brick, std::span<float> values) {
        if (distance_to(brick.centre, centre) > kHalf + brick.radius) return false;
        return sample_voxels(shape, brick, values, [&](const Vec3f& point) {
          if (distance_to(point, centre) > kHalf) return std::array<float, 1>{0};
          const Vec3f voxel = (point - shape.origin) / shape.voxel_size;
          const auto index = [](float value) { return static_cast<int>(std::lround(value)); };
          return std::array<float, 1>{
              unit(hash(index(voxel.x), index(voxel.y), index(voxel.z), seed))};
        });
      },
      options.progress);
}

std::vector<Field> generate_puffs(const ProceduralOptions& options) {
  using namespace procedural;
  const GridShape shape = grid_over(
      Box3f(Vec3f(-kHalf, 0, -kHalf), Vec3f(kHalf, kLongestSide, kHalf)), options.resolution);
  const std::vector<procedural::Sphere> puffs = puff_spheres(options.seed);
  const SphereUnion spheres(puffs);
  const std::array<std::string, 1> names = {"density"};
  return sample_fields(
      shape, names,
      [&](const BrickRegion& brick, std::span<float> values) {
        return sample_near(spheres, 0, 0, shape, brick, values,
                           [](const Vec3f& point, const SphereUnion& near) {
                             constexpr float kDepth = 3;  // at which a puff is as dense as it gets
                             const float inside = -near.distance(point) / kDepth;
                             return std::array<float, 1>{smooth_step(0, 1, inside)};
                           });
      },
      options.progress);
}

}  // namespace freepath
