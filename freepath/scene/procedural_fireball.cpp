// An explosion: rolling lobes with bumps upon bumps. It is hottest deep inside and in the creases
// between lobes, where what burns breaks through; the crests have cooled to soot.

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

constexpr float kCoolest = 300, kHottest = 3000;  // [K]

/// A core, lobes around it and lobes on them, more above than below.
SphereUnion lobes(uint64_t seed) {
  Sequence random(seed ^ 0xF12E);
  std::vector<Sphere> spheres{{Vec3f(0, 2, 0), 20}};
  for (int i = 0; i < 22; ++i) {
    Vec3f direction = random.direction();
    if (direction.y < -0.5F) direction.y = -direction.y;
    spheres.push_back({direction * random.uniform(17, 24) * Vec3f(1, 1.1F, 1) + Vec3f(0, 2, 0),
                       random.uniform(8, 13)});
  }
  const std::size_t first = spheres.size();
  for (std::size_t i = 1; i < first; ++i) {
    for (int lobe = 0; lobe < 7; ++lobe) {
      const Sphere parent = spheres[i];
      spheres.push_back({parent.centre + random.direction() * (0.85F * parent.radius),
                         parent.radius * random.uniform(0.3F, 0.55F)});
    }
  }
  return SphereUnion(std::move(spheres));
}

struct Fireball {
  SphereUnion spheres;
  Billows billows;
  uint32_t seed;
  float edge;    ///< Width of the soft border.
  Vec3f centre;  ///< Of the explosion.
  float size;    ///< Of its radius, about.

  static constexpr float kWarp = 2.5F;

  /// Density and temperature.
  std::array<float, 2> at(const Vec3f& point, const SphereUnion& near) const;
};

std::array<float, 2> Fireball::at(const Vec3f& point, const SphereUnion& near) const {
  if (point.y < 0 || near.distance(point) > billows.outward() + kWarp) return {};
  const Vec3f pushed = point + curl_noise(point * 0.06F, seed + 2) * (kWarp / 6);
  const float rough = -near.distance(pushed);
  const float depth = billows.raise(pushed, rough, 1);
  if (depth <= 0) return {};
  // Heat: from the middle outward it falls; a crest is cooler than a crease of the same depth.
  const float inner = 1 - (point - centre).length() / size;
  const float eddies = fractal_noise(point * 0.09F, 4, 0.55F, seed + 5);
  const float crease = (rough - depth) / (billows.inward() + 1e-3F);
  const float heat =
      0.5F + 0.75F * inner + 0.5F * eddies + 0.55F * crease - 0.3F * smooth_step(4, 0, depth);
  const float hot = smooth_step(0, 1, heat);
  const float soot = 0.25F + 0.75F * (1 - hot);  // what has burnt out is thick
  const float density = std::min(1.0F, smooth_step(0, edge, depth) * soot);
  return {density, kCoolest + (kHottest - kCoolest) * hot};
}

}  // namespace
}  // namespace procedural

std::vector<Field> generate_fireball(const ProceduralOptions& options) {
  using namespace procedural;
  SphereUnion spheres = lobes(options.seed);
  const float voxel = kLongestSide / static_cast<float>(std::max(options.resolution, 1));
  const auto seed = static_cast<uint32_t>(options.seed ^ options.seed >> 32) * 57U;
  const Billows billows(8, 0.4F, 2.2F * voxel, seed + 11);
  const float border = billows.outward() + Fireball::kWarp;
  const Box3f raw = spheres.bounds();
  const Vec3f raw_size = raw.max - raw.min;
  const float scale = (kLongestSide - 2 * border) / std::max({raw_size.x, raw_size.y, raw_size.z});
  const Vec3f middle = (raw.min + raw.max) * (0.5F * scale);
  const Vec3f offset(-middle.x, border - raw.min.y * scale, -middle.z);
  spheres.transform(scale, offset);
  Box3f box = spheres.bounds();
  box.min -= Vec3f(border);
  box.max += Vec3f(border);
  const GridShape shape = grid_over(box, options.resolution);
  const Vec3f size = box.max - box.min;
  const Fireball fireball{std::move(spheres),
                          billows,
                          seed,
                          std::max(1.0F, 1.5F * voxel),
                          Vec3f(0, 2 * scale, 0) + offset,
                          0.45F * std::max({size.x, size.y, size.z})};
  const std::string names[] = {"density", "temperature"};
  return sample_fields(
      shape, names,
      [&](const BrickRegion& brick, std::span<float> values) {
        return sample_near(
            fireball.spheres, Fireball::kWarp, billows.outward(), shape, brick, values,
            [&](const Vec3f& point, const SphereUnion& near) { return fireball.at(point, near); });
      },
      options.progress);
}

}  // namespace freepath
