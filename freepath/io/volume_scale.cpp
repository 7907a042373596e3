#include "freepath/io/volume_scale.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "freepath/base/error.h"

namespace freepath {
namespace {

BrickMap scaled_voxels(const Field& field, double factor) {
  const BrickMap& map = field.voxels;
  std::size_t bricks = 0;
  map.for_each_brick([&](const PlacedBrick& /*placed*/) { ++bricks; });
  BrickMapBuilder builder(map.active_min(), map.active_max(), bricks, bricks);
  map.for_each_brick([&](const PlacedBrick& placed) {
    const auto voxels = map.voxels().subspan(std::size_t{placed.brick} * BrickMap::kBrickVoxels,
                                             BrickMap::kBrickVoxels);
    const auto scaled = [&](float value) {
      const auto product = static_cast<float>(factor * static_cast<double>(value));
      if (std::isfinite(product)) return product;
      fail("grid \"{}\": {} times {} is out of the range of float; scale it less", field.name,
           value, factor);
    };
    if (std::ranges::all_of(voxels, [&](float value) { return value == voxels[0]; })) {
      builder.add_constant_brick(placed.coord, scaled(voxels[0]));
    } else {
      std::ranges::transform(voxels, builder.add_brick(placed.coord).begin(), scaled);
    }
  });
  return std::move(builder).finish();
}

}  // namespace

Field scaled_field(const Field& field, double values, double lengths) {
  Field scaled{field.name, scaled_voxels(field, values), field.index_to_world};
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 3; ++column) scaled.index_to_world[row][column] *= lengths;
  }
  return scaled;
}

}  // namespace freepath
