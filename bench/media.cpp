#include "bench/media.h"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace freepath::bench {
namespace {

/// @param axes a bit for each axis that changes its direction
BrickMap mirror(const BrickMap& map, int axes) {
  const auto flip = [axes](Vec3i voxel, int edge) {
    for (int axis = 0; axis < 3; ++axis) {
      if ((axes >> axis & 1) != 0) voxel[axis] = edge - 1 - voxel[axis];
    }
    return voxel;
  };
  const Vec3i size = map.active_max() + Vec3i(1);  // of a cube that begins at 0
  BrickMapBuilder builder(Vec3i(0), map.active_max(), map.brick_count());
  const Vec3i& counts = map.brick_counts();
  const Vec3i first = map.origin() / BrickMap::kBrickSize;
  for (int entry = 0; entry < counts.x * counts.y * counts.z; ++entry) {
    if (map.index()[entry] == 0) continue;
    const Vec3i brick =
        first + Vec3i(entry / (counts.y * counts.z), entry / counts.z % counts.y, entry % counts.z);
    const float* from =
        map.voxels().data() + std::size_t(map.index()[entry]) * BrickMap::kBrickVoxels;
    const auto to = builder.add_brick(flip(brick, size.x / BrickMap::kBrickSize));
    for (int i = 0; i < BrickMap::kBrickVoxels; ++i) {
      const Vec3i voxel = flip(Vec3i(i >> 6, i >> 3 & 7, i & 7), BrickMap::kBrickSize);
      to[i] = from[voxel.x << 6 | voxel.y << 3 | voxel.z];
    }
  }
  return std::move(builder).finish();
}

}  // namespace

Medium make_haze(const Rgb& sigma_a, const Rgb& sigma_s) {
  constexpr int kSize = 128;
  BrickMapBuilder builder(Vec3i(0), Vec3i(kSize - 1), 0);
  for (int x = 0; x < kSize; ++x) {
    for (int y = 0; y < kSize; ++y) {
      for (int z = 0; z < kSize; ++z) {
        const double wave = std::sin(0.09 * x) * std::cos(0.07 * y + 0.05 * z);
        builder.set_voxel(Vec3i(x, y, z), static_cast<float>(0.775 + 0.225 * wave));
      }
    }
  }
  auto field = std::make_shared<Field>();
  field->name = "haze";
  field->voxels = std::move(builder).finish();
  return Medium({Component{.density = field, .sigma_a = sigma_a, .sigma_s = sigma_s}}, 8);
}

Medium with_spectra(const Medium& medium, const Rgb& sigma_a, const Rgb& sigma_s) {
  Component component = medium.components()[0];
  component.sigma_a = sigma_a;
  component.sigma_s = sigma_s;
  return Medium({component}, medium.super_voxels().cell_size);
}

Medium in_two_parts(const Medium& medium) {
  std::vector<Component> components(2, medium.components()[0]);
  const float shares[] = {0.75F, 0.25F};
  for (int k = 0; k < 2; ++k) {
    components[k].sigma_a *= shares[k];
    components[k].sigma_s *= shares[k];
  }
  return Medium(std::move(components), medium.super_voxels().cell_size);
}

Medium in_mirrors(const Medium& medium, int count) {
  const Component& whole = medium.components()[0];
  std::vector<Component> components;
  for (int k = 0; k < count; ++k) {
    auto field = std::make_shared<Field>();
    field->name = "mirrored";
    field->voxels = mirror(whole.density->voxels, k);
    Component part = whole;
    part.density = std::move(field);
    part.sigma_a /= static_cast<float>(count);
    part.sigma_s /= static_cast<float>(count);
    components.push_back(std::move(part));
  }
  return Medium(std::move(components), medium.super_voxels().cell_size);
}

}  // namespace freepath::bench
