// A cumulus: towers of spheres on a common base, spheres on spheres, and round bumps of ever
// smaller size on their surface, cut flat below where the air's moisture begins to condense.

#include <algorithm>
#include <array>
#include <cmath>

#include "freepath/scene/procedural.h"
#include "freepath/scene/procedural_billows.h"
#include "freepath/scene/procedural_grid.h"
#include "freepath/scene/procedural_noise.h"

namespace freepath {
namespace procedural {
namespace {

/// Spheres around the upper surface of another, where a cloud grows. The parent is a copy, since it
/// may stand among the spheres that are added to.
// NOLINTNEXTLINE(performance-unnecessary-value-param): the copy is meant, see above
void grow(Sphere parent, int count, float smallest, float largest, Sequence& random,
          std::vector<Sphere>& spheres) {
  for (int i = 0; i < count; ++i) {
    Vec3f direction = random.direction();
    if (direction.y < -0.15F) direction.y = -direction.y;  // little grows downward
    const float radius = parent.radius * random.uniform(smallest, largest);
    spheres.push_back({parent.centre + direction * (parent.radius * 0.88F), radius});
  }
}

/// The towers: a tall one in the middle, others around it, on an oval.
std::vector<Sphere> towers(Sequence& random) {
  std::vector<Sphere> spheres;
  constexpr int kAround = 7;
  const float turn = random.uniform(0, 6.2831853F);
  for (int tower = 0; tower <= kAround; ++tower) {
    const bool middle = tower == 0;
    const float angle =
        turn + 6.2831853F / kAround * (static_cast<float>(tower) + random.uniform(-0.25F, 0.25F));
    const float out = middle ? 0.1F : random.uniform(0.65F, 1.0F);
    Sphere sphere;
    sphere.radius = middle ? random.uniform(15, 18) : random.uniform(10, 14);
    sphere.centre =
        Vec3f(30 * out * std::cos(angle), sphere.radius * 0.5F, 17 * out * std::sin(angle));
    const int floors = middle ? 3 : random.uniform() < 0.65F ? 2 : 1;
    for (int floor = 0; floor < floors; ++floor) {
      spheres.push_back(sphere);
      const Vec3f sideways = random.direction() * (0.35F * sphere.radius);
      sphere.centre += Vec3f(sideways.x, 0.75F * sphere.radius, sideways.z);
      sphere.radius *= random.uniform(0.72F, 0.88F);
    }
  }
  return spheres;
}

/// All spheres of a cloud whose base is at y = 0, 100 units along its longest side.
SphereUnion cumulus(uint64_t seed) {
  Sequence random(seed ^ 0xC10D);
  std::vector<Sphere> spheres = towers(random);
  const std::size_t first = spheres.size();
  for (std::size_t i = 0; i < first; ++i) grow(spheres[i], 14, 0.38F, 0.6F, random, spheres);
  const std::size_t second = spheres.size();
  for (std::size_t i = first; i < second; ++i) grow(spheres[i], 8, 0.35F, 0.55F, random, spheres);
  return SphereUnion(std::move(spheres));
}

struct Cloud {
  SphereUnion spheres;
  Billows billows;
  uint32_t seed;
  float edge;  ///< Width of the soft border.

  static constexpr float kWarp = 2.0F;       // how far large eddies push the shape
  static constexpr float kCore = 7.0F;       // depth where the density is full
  static constexpr float kBaseSwell = 1.2F;  // height of the swell of the base

  float density(const Vec3f& point, const SphereUnion& near) const;
};

float Cloud::density(const Vec3f& point, const SphereUnion& near) const {
  const float swell = gradient_noise(point * Vec3f(0.07F, 0, 0.07F), seed + 1);
  const float height = point.y - kBaseSwell * (1 + swell);
  if (height <= 0) return 0;
  const float rough = near.distance(point);
  if (rough > billows.outward() + kWarp) return 0;
  float depth = -rough;
  if (depth < kCore + kWarp) {
    const Vec3f coarse = point * 0.06F;
    const Vec3f pushed =
        point + Vec3f(gradient_noise(coarse, seed + 2), gradient_noise(coarse, seed + 3),
                      gradient_noise(coarse, seed + 4)) *
                    kWarp;
    // The base is smooth: bumps fade in above it.
    const float bumps = 0.25F + 0.75F * smooth_step(0, 9, height);
    depth = billows.raise(pushed, -near.distance(pushed), bumps);
    if (depth <= 0) return 0;
  }
  const float body = 0.5F + 0.5F * smooth_step(0, kCore, depth);
  const float variation = 0.86F + 0.14F * fractal_noise(point * 0.15F, 2, 0.5F, seed + 5);
  const float border = smooth_step(0, edge, depth) * smooth_step(0, 2.5F, height);
  return std::min(1.0F, border * body * variation);
}

}  // namespace
}  // namespace procedural

std::vector<Field> generate_cloud(const ProceduralOptions& options) {
  using namespace procedural;
  SphereUnion spheres = cumulus(options.seed);
  // Scaled so that with the bumps on it the cloud is as long as it should be.
  const float voxel = kLongestSide / static_cast<float>(std::max(options.resolution, 1));
  const Billows billows(6.5F, 0.42F, 2.2F * voxel, static_cast<uint32_t>(options.seed) + 11);
  const float border = billows.outward() + Cloud::kWarp;
  const Box3f raw = spheres.bounds();
  const Vec3f raw_size = raw.max - raw.min;
  const float scale = (kLongestSide - 2 * border) / std::max({raw_size.x, raw.max.y, raw_size.z});
  const Vec3f middle = (raw.min + raw.max) * (0.5F * scale);
  spheres.transform(scale, Vec3f(-middle.x, 0, -middle.z));
  Box3f box = spheres.bounds();
  box.min -= Vec3f(border);
  box.max += Vec3f(border);
  box.min.y = 0;
  const GridShape shape = grid_over(box, options.resolution);
  const Cloud cloud{std::move(spheres), billows, static_cast<uint32_t>(options.seed) * 77U,
                    std::max(0.7F, 1.5F * voxel)};
  const std::string names[] = {"density"};
  return sample_fields(
      shape, names,
      [&](const BrickRegion& brick, std::span<float> values) {
        return sample_near(cloud.spheres, Cloud::kWarp, billows.outward(), shape, brick, values,
                           [&](const Vec3f& point, const SphereUnion& near) {
                             return std::array{cloud.density(point, near)};
                           });
      },
      options.progress);
}

}  // namespace freepath
