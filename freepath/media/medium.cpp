#include "freepath/media/medium.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/media/density_function.h"
#include "freepath/media/medium_channels.h"

namespace freepath {
namespace {

void check_spectrum(const Rgb& spectrum, const char* name, std::size_t component) {
  for (int channel = 0; channel < kChannels; ++channel) {
    const float value = spectrum[channel];
    if (!std::isfinite(value) || value < 0) {
      fail("component {}: {} of channel {} is {}; it must be finite and not negative", component,
           name, channel, value);
    }
  }
}

bool is_finite(const Matrix4d& matrix) {
  return std::all_of(matrix.getValue(), matrix.getValue() + 16,
                     [](double value) { return std::isfinite(value); });
}

void check_component(const Component& component, const Component& first, std::size_t number) {
  check_spectrum(component.sigma_a, "sigma_a", number);
  check_spectrum(component.sigma_s, "sigma_s", number);
  check_spectrum(component.emission, "emission", number);
  check_spectrum(component.sigma_t(), "sigma_a + sigma_s", number);
  check_spectrum(component.sigma_a * component.emission, "sigma_a · emission", number);
  if (!component.density || (!component.density->function && component.density->voxels.empty())) {
    fail("component {}: its density has no active voxel", number);
  }
  const Field& field = *component.density;
  if ((field.function == nullptr) != (first.density->function == nullptr)) {
    fail(
        "grids '{}' and '{}': one is computed and one of voxels; components are all the one or "
        "all the other",
        field.name, first.density->name);
  }
  if (field.function && field.function->cells != first.density->function->cells) {
    fail("density functions '{}' and '{}' differ in cells; components must share them", field.name,
         first.density->name);
  }
  if (!is_finite(field.index_to_world)) {
    fail("grid '{}': its transform is not finite; set another", field.name);
  }
}

/// Whether all voxels in the bounds of the active ones have one value.
bool is_uniform(const BrickMap& voxels) {
  const Vec3i& first = voxels.active_min();
  const Vec3i& last = voxels.active_max();
  const float value = voxels.value(first);
  for (int x = first.x; x <= last.x; ++x) {
    for (int y = first.y; y <= last.y; ++y) {
      for (int z = first.z; z <= last.z; ++z) {
        if (voxels.value({x, y, z}) != value) return false;
      }
    }
  }
  return true;
}

/// Edge of a cube with a voxel's volume [world], for the cost model alone.
double voxel_edge(const Matrix4d& index_to_world) {
  return std::cbrt(std::abs(index_to_world.determinant()));
}

/// @param records of those cells in Medium::walk_cells(), to be set
void mark_empty_cells(const SuperVoxels& cells, float* records) {
  std::copy(cells.maxima.begin(), cells.maxima.end(), records);
  for (std::size_t cell = 0; cell < cells.cell_count(); ++cell) {
    const int radius = cells.empty_radius[cell];
    if (radius > 0) records[cell * cells.components] = static_cast<float>(-radius);
  }
}

/// World → walk space, given world → place.
AffineMap scaled_map(const Matrix4d& world_to_grid, const Vec3i& first, int cell_size,
                     const Vec3d& origin) {
  const double scale = 1.0 / cell_size;
  AffineMap map;
  for (int to = 0; to < 3; ++to) {
    double offset = (world_to_grid[3][to] - first[to]) * scale;
    for (int from = 0; from < 3; ++from) {
      const double factor = world_to_grid[from][to] * scale;
      offset += origin[from] * factor;
      map.linear[from][to] = static_cast<float>(factor);
    }
    map.offset[to] = static_cast<float>(offset);
  }
  return map;
}

/// Walk space → place, given that of the voxels that its cells are made of.
AffineMap voxels_from_cells(const Matrix4d& to_voxels, int cell_size) {
  AffineMap map;
  for (int to = 0; to < 3; ++to) {
    for (int from = 0; from < 3; ++from) {
      map.linear[from][to] = static_cast<float>(to_voxels[from][to] * cell_size);
    }
    map.offset[to] = static_cast<float>(to_voxels[3][to]);
  }
  return map;
}

}  // namespace

Medium::Medium(std::vector<Component> components, int super_voxel,
               const std::optional<Matrix4d>& world_to_index)
    : components_(std::move(components)) {
  if (components_.empty() || components_.size() > kMaxComponents) {
    fail("a medium has 1 to {} components, not {}", kMaxComponents, components_.size());
  }
  for (std::size_t k = 0; k < components_.size(); ++k) {
    check_component(components_[k], components_[0], k);
  }
  if (components_[0].density->function) {
    build_from_functions();
  } else {
    build_from_voxels(super_voxel);
  }
  set_world_to_grid(world_to_index);
}

std::vector<const Field*> Medium::fields() const {
  std::vector<const Field*> fields;
  for (const Component& component : components_) fields.push_back(component.density.get());
  return fields;
}

void Medium::set_world_to_grid(const std::optional<Matrix4d>& world_to_index) {
  if (world_to_index && !aligned()) {
    fail("fields that differ in transform or bounds can't be given one map from the world");
  }
  if (world_to_index) {
    world_to_grid_ = *world_to_index;
  } else {
    const double determinant = space_.index_to_world.determinant();
    if (!std::isfinite(determinant) || determinant == 0) {
      fail("grid '{}': its transform has no inverse", components_[0].density->name);
    }
    world_to_grid_ = space_.index_to_world.inverse();
  }
  for (int to = 0; to < 3; ++to) {
    world_to_grid_[3][to] = world_to_grid_[3][to] - space_.origin[to] + 0.5;
  }
}

void Medium::build_from_voxels(int super_voxel) {
  space_ = make_walk_space(fields());
  std::vector<float> extinction;
  const double edge = voxel_edge(space_.index_to_world);
  for (const Component& component : components_) {
    extinction.push_back(static_cast<float>(largest(component.sigma_t()) * edge));
  }
  WalkParts parts = make_walk_parts(space_, fields(), extinction, super_voxel);
  part_tree_ = std::make_shared<const BoxTree>(std::move(parts.tree));
  set_parts(std::move(parts.parts));
}

void Medium::set_parts(std::vector<WalkPart> parts) {
  std::size_t records = 0;
  for (WalkPart& part : parts) {
    part.first_record = records;
    records += part.cells.maxima.size();
  }
  walk_cells_ = WalkCells(records);
  for (const WalkPart& part : parts) {
    mark_empty_cells(part.cells, walk_cells_.data() + part.first_record);
  }
  parts_ = std::make_shared<const std::vector<WalkPart>>(std::move(parts));
}

void Medium::build_from_functions() {
  const DensityFunction& first = *components_[0].density->function;
  const Vec3i cells = first.cells;
  space_.index_to_world = components_[0].density->index_to_world;
  space_.voxel_counts = cells;
  space_.to_component.assign(components_.size(), Matrix4d());
  WalkPart part;
  part.box = {Vec3i(0), cells};
  part.windows.resize(components_.size());
  SuperVoxels& super_voxels = part.cells;
  super_voxels.cell_size = 1;
  super_voxels.counts = cells;
  super_voxels.components = static_cast<int>(components_.size());
  const Vec3f edge = first.box.size() / Vec3f(cells);
  for (int x = 0; x < cells.x; ++x) {
    for (int y = 0; y < cells.y; ++y) {
      for (int z = 0; z < cells.z; ++z) {
        const Vec3f low = first.box.min + edge * Vec3f(Vec3i(x, y, z));
        bool empty = true;
        for (const Component& component : components_) {
          const auto [minimum, maximum] = component.density->function->bounds({low, low + edge});
          if (!(minimum >= 0) || !(maximum >= minimum) || !std::isfinite(maximum)) {
            fail("density function '{}' has the bounds {} to {} in the cell at ({}, {}, {})",
                 component.density->name, minimum, maximum, low.x, low.y, low.z);
          }
          super_voxels.minima.push_back(minimum);
          super_voxels.maxima.push_back(maximum);
          empty = empty && maximum == 0;
        }
        super_voxels.empty_radius.push_back(empty ? 1 : 0);
      }
    }
  }
  set_parts({std::move(part)});
}

Medium Medium::with_scaled_bounds(float scale) const {
  if (!(scale > 0) || !std::isfinite(scale)) fail("bounds can't be scaled by {}", scale);
  Medium scaled = *this;
  std::vector<WalkPart> parts = *parts_;
  for (WalkPart& part : parts) {
    for (float& maximum : part.cells.maxima) maximum *= scale;
    for (float& minimum : part.cells.minima) minimum /= scale;
  }
  scaled.set_parts(std::move(parts));
  return scaled;
}

Medium Medium::clipped_to_voxels() const {
  Medium clipped = *this;
  clipped.reach_ = 0.5;
  return clipped;
}

Medium Medium::clipped_to_middles() const {
  Medium clipped = *this;
  clipped.reach_ = 0;
  // Bounds of cells count the voxels beyond, which no filter reads within the outermost middles.
  // Where all others are equal, the least is the largest.
  std::vector<WalkPart> parts = *parts_;
  const std::size_t count = components_.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Field& field = *components_[k].density;
    if (field.function || !is_uniform(field.voxels)) continue;
    for (WalkPart& part : parts) {
      for (std::size_t i = k; i < part.cells.minima.size(); i += count) {
        part.cells.minima[i] = part.cells.maxima[i];
      }
    }
  }
  clipped.set_parts(std::move(parts));
  return clipped;
}

std::size_t Medium::super_voxel_count() const {
  std::size_t count = 0;
  for (const WalkPart& part : parts()) count += part.cells.cell_count();
  return count;
}

std::size_t Medium::memory_bytes() const {
  std::size_t bytes = walk_cells_.size() * sizeof(float);
  for (const WalkPart& part : parts()) bytes += part.memory_bytes();
  return bytes;
}

AffineMap Medium::world_to_walk(const Vec3d& origin) const {
  return scaled_map(world_to_grid_, Vec3i(0), super_voxels().cell_size, origin);
}

AffineMap Medium::world_to_walk(const WalkPart& part, const Vec3d& origin) const {
  return scaled_map(world_to_grid_, part.first, part.cells.cell_size, origin);
}

Vec3d Medium::middle_of(const WalkPart& part) const {
  return (part.middle() + Vec3d(space_.origin) - Vec3d(0.5)) * space_.index_to_world;
}

AffineMap Medium::walk_to_component(std::size_t component) const {
  return voxels_from_cells(space_.to_component[component], super_voxels().cell_size);
}

AffineMap Medium::walk_to_component(const WalkPart& part, std::size_t component) const {
  const auto& field = components_[component].density;
  return voxels_from_cells(
      to_window(part, space_.to_component[component], field->voxels, part.windows[component]),
      part.cells.cell_size);
}

/// Along rows: position in the grid → index of the grid → world → position in the field.
Matrix4d Medium::grid_to_field(const Field& field) const {
  const double determinant = field.index_to_world.determinant();
  if (!std::isfinite(determinant) || determinant == 0) {
    fail("grid '{}': its transform has no inverse", field.name);
  }
  Matrix4d grid_to_index;
  grid_to_index.setTranslation(Vec3d(space_.origin) - Vec3d(0.5));
  Matrix4d result = grid_to_index * space_.index_to_world * field.index_to_world.inverse();
  for (int to = 0; to < 3; ++to) result[3][to] = result[3][to] - field.voxels.origin()[to] + 0.5;
  return result;
}

AffineMap Medium::walk_to_field(const Field& field) const {
  return voxels_from_cells(grid_to_field(field), super_voxels().cell_size);
}

AffineMap Medium::walk_to_field(const WalkPart& part, const Field& field,
                                BrickWindow& window) const {
  const Matrix4d to_field = grid_to_field(field);
  window = window_of(field.voxels, part.box, to_field);
  return voxels_from_cells(to_window(part, to_field, field.voxels, window), part.cells.cell_size);
}

Box3f Medium::walk_bounds(Interpolation interpolation) const {
  if (components_[0].density->function) return {Vec3f(0), Vec3f(super_voxels().counts)};
  const double reach = std::min(reach_, interpolation == Interpolation::kNearest ? 0.5 : 1.0);
  const double scale = 1.0 / super_voxels().cell_size;
  const Box3d bounds = space_.bounds(fields(), reach);
  return {Vec3f(bounds.min * scale), Vec3f(bounds.max * scale)};
}

Box3f Medium::walk_bounds(const WalkPart& part, Interpolation interpolation) const {
  if (parts().size() == 1 && part_tree().leaves().empty()) return walk_bounds(interpolation);
  const double reach = std::min(reach_, interpolation == Interpolation::kNearest ? 0.5 : 1.0);
  const Box3d bounds = space_.bounds(fields(), reach);
  Box3f box;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = std::max(bounds.min[axis], double(part.box.begin[axis]));
    const double high = std::min(bounds.max[axis], double(part.box.end[axis]));
    box.min[axis] = static_cast<float>((low - part.first[axis]) / part.cells.cell_size);
    box.max[axis] = static_cast<float>((high - part.first[axis]) / part.cells.cell_size);
  }
  return box;
}

Box3d Medium::world_bounds() const { return bounds_with(0.5); }

Box3d Medium::outer_bounds() const { return bounds_with(1); }

OrientedBox Medium::outer_box() const {
  const Field& first = *components_[0].density;
  if (first.function || first.index_to_world.determinant() == 0) {
    return OrientedBox(outer_bounds());
  }
  const Matrix4d from_world = first.index_to_world.inverse();
  Box3d box;
  for (const Component& component : components_) {
    box.extendBy(Imath::transform(box_of_voxels(component.density->voxels, 1),
                                  component.density->index_to_world * from_world));
  }
  return OrientedBox(box, first.index_to_world);
}

Box3d Medium::box_of_voxels(const BrickMap& map, double filter) const {
  const Vec3d reach(std::min(reach_, filter));
  return {Vec3d(map.active_min()) - reach, Vec3d(map.active_max()) + reach};
}

Box3d Medium::bounds_with(double filter) const {
  if (const auto& function = components_[0].density->function) {
    return {Vec3d(function->box.min), Vec3d(function->box.max)};
  }
  Box3d box;
  for (const Component& component : components_) {
    box.extendBy(Imath::transform(box_of_voxels(component.density->voxels, filter),
                                  component.density->index_to_world));
  }
  return box;
}

bool Medium::has_grey_extinction() const {
  MediumChannels channels = channels_of(*this);
  channels.count = kChannels;
  return channels.has_grey_extinction();
}

bool Medium::is_grey() const {
  return std::all_of(components_.begin(), components_.end(), [](const Component& c) {
    return freepath::is_grey(c.sigma_a) && freepath::is_grey(c.sigma_s) &&
           freepath::is_grey(c.emission) && c.radiance[0].field == nullptr;
  });
}

bool Medium::emits() const { return channels_of(*this).emits(); }

}  // namespace freepath
