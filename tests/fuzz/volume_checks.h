#pragma once
/// @file Any bytes as a volume file: the readers must end, with fields that keep their promises or
/// with an Error that names the file.

#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "freepath/io/volume.h"
#include "tests/fuzz/fuzz_checks.h"

namespace freepath::fuzz {

inline void check_field(const LoadedField& loaded) {
  const BrickMap& map = loaded.field.voxels;
  for (const float value : map.voxels()) {
    require(std::isfinite(value) && value >= 0, "voxels are finite and not negative");
  }
  if (map.empty()) return;
  for (int axis = 0; axis < 3 && !map.is_sparse(); ++axis) {  // a list has no bounds of its own
    const int end = map.origin()[axis] + map.brick_counts()[axis] * BrickMap::kBrickSize;
    require(map.active_min()[axis] >= map.origin()[axis] + 2 && map.active_max()[axis] + 2 < end,
            "the index covers the active voxels and two more");
  }
  for (const Vec3i& corner : {map.active_min(), map.active_max()}) {
    require(map.value(corner) <= loaded.maximum, "no voxel is above the maximum");
  }
  std::size_t seen = 0;
  map.for_each_brick([&](const PlacedBrick& placed) {
    require(placed.brick < map.brick_count(), "the index names bricks that there are");
    ++seen;
  });
  require(seen == 0 || map.brick_count() > 1, "bricks have voxels");
}

/// Lists the grids of a file, loads each and the one that is meant without a selection.
inline void check_volume(std::string_view bytes) {
  static const FileInMemory file;
  static const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism,
                                               1);
  file.set(bytes);
  const std::string name = file.path();
  attempt(name, [&] { list_grid_heads(name); });
  const LoadOptions options{.selection = {}, .negative = NegativePolicy::kClamp};
  attempt(name, [&] {
    visit_grids(name, {}, options, [&](const GridInfo& info, std::vector<LoadedField> fields) {
      require(info.loadable || !info.reason.empty(), "a grid that can't be loaded has a reason");
      for (const LoadedField& field : fields) {
        check_field(field);
        for (const std::string& warning : field.warnings) check_message(warning, name);
      }
    });
  });
  attempt(name, [&] {
    for (const LoadedField& field : load_fields(name)) check_field(field);
  });
}

}  // namespace freepath::fuzz
