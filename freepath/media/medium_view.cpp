#include "freepath/media/medium_view.h"

#include "freepath/media/density_function.h"

namespace freepath {

MediumView view_of(const Medium& medium, Interpolation interpolation, int channel,
                   const Vec3d& origin) {
  MediumView view;
  const SuperVoxels& cells = medium.super_voxels();
  const Box3f bounds = medium.walk_bounds(interpolation);
  for (int axis = 0; axis < 3; ++axis) {
    view.cell_counts[axis] = cells.counts[axis];
    view.bounds_min[axis] = bounds.min[axis];
    view.bounds_max[axis] = bounds.max[axis];
  }
  view.cell_size = cells.cell_size;
  view.cells = medium.walk_cells().data();
  view.minima = cells.minima.data();
  view.world_to_walk = medium.world_to_walk(origin);
  view.interpolation = interpolation;
  if (const DensityFunction* const function = medium.components()[0].density->function.get()) {
    for (int axis = 0; axis < 3; ++axis) {
      view.cell_origin[axis] = function->box.min[axis];
      view.cell_edge[axis] = function->box.size()[axis] / static_cast<float>(function->cells[axis]);
    }
  }
  view.aligned = medium.aligned();
  view.component_count = static_cast<int>(medium.components().size());
  for (int k = 0; k < view.component_count; ++k) {
    const Component& component = medium.components()[k];
    ComponentView& target = view.components[k];
    target.function = component.density->function.get();
    target.index = component.density->voxels.index().data();
    target.voxels = component.density->voxels.voxels().data();
    for (int axis = 0; axis < 3; ++axis) {
      target.brick_counts[axis] = component.density->voxels.brick_counts()[axis];
    }
    target.walk_to_voxels = medium.walk_to_component(k);
    for (int slot = 0; slot < kChannels; ++slot) {
      const int from = channel < 0 ? slot : channel;
      target.sigma_a[slot] = component.sigma_a[from];
      target.sigma_s[slot] = component.sigma_s[from];
      target.emission[slot] = component.sigma_a[from] * component.emission[from];
    }
  }
  return view;
}

}  // namespace freepath
