#include "freepath/scene/assembly/grid_voxels.h"

#include <span>
#include <utility>

#include "freepath/base/counted.h"
#include "freepath/media/brick_map.h"

namespace freepath {

VoxelLayout read_voxel_layout(const ParameterList& list, const Matrix4d& medium_to_world) {
  VoxelLayout layout;
  const std::string_view names[3] = {"nx", "ny", "nz"};
  double product = 1;
  for (int axis = 0; axis < 3; ++axis) {
    layout.counts[axis] = list.get_integer(names[axis], 1);
    if (layout.counts[axis] < 1) {
      fail_at(list.location_of(names[axis]), "'{}' is {}: a grid has at least 1 voxel along it",
              names[axis], layout.counts[axis]);
    }
    product *= layout.counts[axis];
  }
  if (product > 1e9) fail("the grid has {:.3g} voxels, more than 1e9", product);
  const Vec3d p0 = list.get_point("p0", Vec3d(0));
  const Vec3d p1 = list.get_point("p1", Vec3d(1));
  Matrix4d index_to_medium;
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = (p1[axis] - p0[axis]) / layout.counts[axis];
    if (edge == 0) {
      fail_at(list.location_of("p1"), "'p0' and 'p1' are the same along {}", "xyz"[axis]);
    }
    index_to_medium[axis][axis] = edge;
    index_to_medium[3][axis] = p0[axis] + 0.5 * edge;
  }
  layout.index_to_world = index_to_medium * medium_to_world;
  return layout;
}

void check_voxel_count(const ParameterList& list, std::string_view name, std::size_t count,
                       const VoxelLayout& layout) {
  if (count == layout.voxels()) return;
  fail_at(list.location_of(name), "'{}' has {}, but nx · ny · nz is {}", name,
          counted(count, "value"), layout.voxels());
}

std::shared_ptr<const Field> read_voxels(const ParameterList& list, const VoxelLayout& layout,
                                         std::string_view name, std::string field_name) {
  const std::span<const double> values = list.get_floats(name);
  if (values.empty()) fail("a grid needs '{}', a number for each voxel", name);
  check_voxel_count(list, name, values.size(), layout);
  BrickMapBuilder builder(Vec3i(0), layout.counts - Vec3i(1), 0);
  std::size_t i = 0;
  for (int z = 0; z < layout.counts.z; ++z) {
    for (int y = 0; y < layout.counts.y; ++y) {
      for (int x = 0; x < layout.counts.x; ++x, ++i) {
        if (values[i] < 0) {
          fail_at(list.location_of(name), "'{}' is {} in voxel ({}, {}, {})", name, values[i], x, y,
                  z);
        }
        builder.set_voxel(Vec3i(x, y, z), static_cast<float>(values[i]));
      }
    }
  }
  auto field = std::make_shared<Field>();
  field->name = std::move(field_name);
  field->voxels = std::move(builder).finish();
  field->index_to_world = layout.index_to_world;
  return field;
}

}  // namespace freepath
