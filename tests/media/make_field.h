#pragma once
/// @file Fields made of functions.

#include <functional>
#include <memory>
#include <utility>

#include "freepath/media/field.h"

namespace freepath::testing {

/// A field whose voxels are a function of their indices.
inline std::shared_ptr<Field> make_field(const Vec3i& low, const Vec3i& high,
                                         const std::function<float(const Vec3i&)>& density,
                                         const Matrix4d& index_to_world = Matrix4d()) {
  BrickMapBuilder builder(low, high, 0);
  for (int x = low.x; x <= high.x; ++x) {
    for (int y = low.y; y <= high.y; ++y) {
      for (int z = low.z; z <= high.z; ++z) {
        const float value = density(Vec3i(x, y, z));
        if (value != 0) builder.set_voxel(Vec3i(x, y, z), value);
      }
    }
  }
  auto field = std::make_shared<Field>();
  field->name = "test";
  field->voxels = std::move(builder).finish();
  field->index_to_world = index_to_world;
  return field;
}

}  // namespace freepath::testing
