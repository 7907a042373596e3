#include "freepath/media/medium_view.h"

#include <utility>

#include "freepath/media/density_function.h"

namespace freepath {
namespace {

RadianceView view_of(const RadianceField& radiance, const Medium& medium) {
  RadianceView view;
  if (!radiance.field) return view;
  const BrickMap& voxels = radiance.field->voxels;
  view.index = voxels.index().data();
  view.voxels = voxels.voxels().data();
  for (int axis = 0; axis < 3; ++axis) view.brick_counts[axis] = voxels.brick_counts()[axis];
  view.walk_to_voxels = medium.walk_to_field(*radiance.field);
  if (radiance.table) {
    view.table = radiance.table->data();
    view.first = radiance.first;
    view.per_step = 1 / radiance.step;
    view.last = static_cast<float>(radiance.table->size() - 1);
  }
  return view;
}

void set_radiance(const Medium& medium, const MediumChannels& channels, MediumView& view) {
  auto views = std::make_shared<std::vector<RadianceView>>();
  for (const ComponentChannels& component : channels.components) {
    for (int slot = 0; slot < kMaxChannels; ++slot) {
      views->push_back(view_of(component.radiance[view.source(slot)], medium));
    }
  }
  for (std::size_t k = 0; k < channels.components.size(); ++k) {
    if (channels.components[k].radiance[0].field) {
      view.components[k].radiance = views->data() + k * kMaxChannels;
    }
  }
  view.radiance_views = std::move(views);
}

}  // namespace

MediumView view_of(const Medium& medium, Interpolation interpolation,
                   const MediumChannels& channels, const Vec3d& origin) {
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
  view.channels = channels.count;
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
    const ComponentChannels& values = channels.components[k];
    auto& emission = values.radiance[0].field ? target.radiance_scale : target.emission;
    for (int slot = 0; slot < kMaxChannels; ++slot) {
      const int channel = view.source(slot);
      target.sigma_a[slot] = values.sigma_a[channel];
      target.sigma_s[slot] = values.sigma_s[channel];
      emission[slot] = values.sigma_a[channel] * values.emission[channel];
    }
  }
  if (channels.has_radiance_fields()) set_radiance(medium, channels, view);
  return view;
}

}  // namespace freepath
