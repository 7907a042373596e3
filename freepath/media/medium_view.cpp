#include "freepath/media/medium_view.h"

#include <algorithm>

#include <utility>

#include "freepath/media/density_function.h"

namespace freepath {
namespace {

RadianceView view_of(const RadianceField& radiance, const BrickWindow& window,
                     const AffineMap& walk_to_voxels) {
  RadianceView view;
  view.index = window.index;
  view.voxels = radiance.field->voxels.voxels().data();
  for (int axis = 0; axis < 3; ++axis) view.brick_counts[axis] = window.brick_counts[axis];
  view.walk_to_voxels = walk_to_voxels;
  if (radiance.table) {
    view.table = radiance.table->data();
    view.first = radiance.first;
    view.per_step = 1 / radiance.step;
    view.last = static_cast<float>(radiance.table->size() - 1);
  }
  return view;
}

void set_radiance(const std::vector<RadianceView>& views, MediumView& view) {
  for (int k = 0; k < view.component_count; ++k) {
    const RadianceView* const first = views.data() + std::size_t(k) * kMaxChannels;
    if (first->index != nullptr) view.components[k].radiance = first;
  }
}

}  // namespace

void MediumView::find_matter() {
  matter_count_ = 0;
  for (int k = 0; k < component_count; ++k) {
    const auto is_there = [](float sigma) { return sigma != 0; };
    const ComponentView& component = components[k];
    if (std::any_of(component.sigma_a.begin(), component.sigma_a.end(), is_there) ||
        std::any_of(component.sigma_s.begin(), component.sigma_s.end(), is_there)) {
      matter_[matter_count_++] = k;
    }
  }
  if (matter_count_ == 0) matter_[matter_count_++] = 0;
}

std::shared_ptr<const std::vector<RadianceView>> radiance_views_of(const Medium& medium,
                                                                   const WalkPart& part,
                                                                   const MediumChannels& channels) {
  if (!channels.has_radiance_fields()) return nullptr;
  struct Held {
    std::vector<RadianceView> views;
    std::vector<BrickWindow> windows;  // which the views point into
  };
  auto held = std::make_shared<Held>();
  const Field* before = nullptr;
  BrickWindow window;
  AffineMap map;
  for (const ComponentChannels& component : channels.components) {
    for (int slot = 0; slot < kMaxChannels; ++slot) {
      const RadianceField& radiance = component.radiance[slot % channels.count];
      if (!radiance.field) {
        held->views.emplace_back();
        continue;
      }
      if (radiance.field.get() != before) {
        before = radiance.field.get();
        map = medium.walk_to_field(part, *before, window);
        held->windows.push_back(window);
      }
      held->views.push_back(view_of(radiance, window, map));
    }
  }
  return {held, &held->views};
}

void show_part(const Medium& medium, const WalkPart& part, const Vec3d& origin,
               std::shared_ptr<const std::vector<RadianceView>> radiance, MediumView& view) {
  const Box3f bounds = medium.walk_bounds(part, view.interpolation);
  for (int axis = 0; axis < 3; ++axis) {
    view.cell_counts[axis] = part.cells.counts[axis];
    view.bounds_min[axis] = bounds.min[axis];
    view.bounds_max[axis] = bounds.max[axis];
  }
  view.cell_size = part.cells.cell_size;
  view.cells = medium.walk_cells().data() + part.first_record;
  view.minima = part.cells.minima.data();
  view.world_to_walk = medium.world_to_walk(part, origin);
  for (int k = 0; k < view.component_count; ++k) {
    ComponentView& target = view.components[k];
    target.index = part.windows[k].index;
    for (int axis = 0; axis < 3; ++axis) {
      target.brick_counts[axis] = part.windows[k].brick_counts[axis];
    }
    target.walk_to_voxels = medium.walk_to_component(part, k);
  }
  view.radiance_views = std::move(radiance);
  if (view.radiance_views) set_radiance(*view.radiance_views, view);
}

MediumView view_of(const Medium& medium, Interpolation interpolation,
                   const MediumChannels& channels, const Vec3d& origin) {
  MediumView view;
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
    target.voxels = component.density->voxels.voxels().data();
    const ComponentChannels& values = channels.components[k];
    auto& emission = values.radiance[0].field ? target.radiance_scale : target.emission;
    for (int slot = 0; slot < kMaxChannels; ++slot) {
      const int channel = view.source(slot);
      target.sigma_a[slot] = values.sigma_a[channel];
      target.sigma_s[slot] = values.sigma_s[channel];
      emission[slot] = values.sigma_a[channel] * values.emission[channel];
    }
  }
  view.find_matter();
  const WalkPart& first = medium.parts()[0];
  show_part(medium, first, origin, radiance_views_of(medium, first, channels), view);
  return view;
}

}  // namespace freepath
