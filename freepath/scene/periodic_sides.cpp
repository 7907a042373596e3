#include "freepath/scene/periodic_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/spectra/rgb_color_space.h"

namespace freepath {
namespace {

constexpr double kRounding = 1e-3;  // of a voxel

/// Voxels along an axis of the world: which axis of the index that is, and where they stand.
struct VoxelRow {
  int axis = 0;
  double step = 1;           ///< To the next voxel [world]; may be negative.
  double offset = 0;         ///< Of the middle of voxel 0 [world].
  double low = 0, high = 0;  ///< Faces of the outermost active voxels [world].

  double index_of(double position) const { return (position - offset) / step; }
};

/// @throws Error for voxels that are turned against the axis
VoxelRow voxel_row(const std::string& name, const Matrix4d& index_to_world, const Vec3i& first,
                   const Vec3i& last, int world_axis) {
  const Matrix4d& m = index_to_world;
  VoxelRow row;
  int parallel = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double along = std::abs(m[axis][world_axis]);
    const double length = Vec3d(m[axis][0], m[axis][1], m[axis][2]).length();
    if (along <= 1e-6 * length) continue;
    ++parallel;
    row = {axis, m[axis][world_axis], m[3][world_axis]};
    if (along < (1 - 1e-9) * length) parallel = 3;  // slanted
  }
  if (parallel != 1) {
    fail("grid '{}': its voxels are turned against the {} axis; along it they can't repeat", name,
         "xyz"[world_axis]);
  }
  const double a = row.offset + row.step * (first[row.axis] - 0.5);
  const double b = row.offset + row.step * (last[row.axis] + 0.5);
  row.low = std::min(a, b);
  row.high = std::max(a, b);
  return row;
}

VoxelRow voxel_row(const Field& field, int world_axis) {
  return voxel_row(field.name, field.index_to_world, field.voxels.active_min(),
                   field.voxels.active_max(), world_axis);
}

/// The first and last layer of a period of voxels, each of which has to stand once more beyond the
/// other; nothing where filters do not reach over the sides.
/// @param is_clipped whether a medium ends at the faces of its voxels, unless they go on beyond the
///   sides
/// @throws Error for voxels that do not fit the domain
std::optional<std::array<int, 2>> layers_at_sides(const std::string& name, const VoxelRow& row,
                                                  int world_axis, const Box3d& domain,
                                                  bool is_clipped) {
  const double low = domain.min[world_axis];
  const double high = domain.max[world_axis];
  const double voxel = std::abs(row.step);
  const double slack = kRounding * voxel;
  if (row.low < low - slack || row.high > high + slack) {
    fail(
        "grid '{}': its voxels reach from {:.6g} to {:.6g} along {}, beyond the domain from {:.6g} "
        "to {:.6g}: give a longer period",
        name, row.low, row.high, "xyz"[world_axis], low, high);
  }
  // Filters reach no farther than to the next voxel.
  if (row.low >= low + voxel && row.high <= high - voxel) return std::nullopt;
  if (is_clipped && (row.low > low + slack || row.high < high - slack)) return std::nullopt;
  const double a = row.index_of(low);
  const double b = row.index_of(high);
  const double begin = std::min(a, b) + 0.5;
  const double end = std::max(a, b) - 0.5;
  const auto first = static_cast<int>(std::lround(begin));
  const auto last = static_cast<int>(std::lround(end));
  if (std::abs(begin - first) > kRounding || std::abs(end - last) > kRounding) {
    fail(
        "grid '{}': the period of {:.6g} along {} cuts voxels of {:.6g} that lie at its sides: "
        "give one from face to face",
        name, high - low, "xyz"[world_axis], voxel);
  }
  return std::array{first, last};
}

/// A map with the values of the layer `source` of voxels at the layer `target` as well.
void copy_layer(const BrickMap& map, int axis, int source, int target, BrickMapBuilder& builder) {
  constexpr int kSize = BrickMap::kBrickSize;
  map.for_each_brick([&](const PlacedBrick& brick) {
    const Vec3i first = brick.coord * kSize;
    if (source < first[axis] || source >= first[axis] + kSize) return;
    for (int i = 0; i < kSize; ++i) {
      for (int j = 0; j < kSize; ++j) {
        Vec3i voxel = first;
        voxel[axis] = source;
        voxel[(axis + 1) % 3] += i;
        voxel[(axis + 2) % 3] += j;
        const float value = map.value(voxel);
        if (value == 0) continue;
        voxel[axis] = target;
        builder.set_voxel(voxel, value);
      }
    }
  });
}

/// The same voxels, and around those of [first, last] along an axis one more layer at either end.
BrickMap with_layers(const BrickMap& map, int axis, int first, int last) {
  Vec3i active_min = map.active_min();
  Vec3i active_max = map.active_max();
  active_min[axis] = std::min(active_min[axis], first - 1);
  active_max[axis] = std::max(active_max[axis], last + 1);
  std::unordered_map<uint32_t, std::size_t> uses;
  std::size_t count = 0;
  map.for_each_brick([&](const PlacedBrick& brick) {
    ++uses[brick.brick];
    ++count;
  });
  BrickMapBuilder builder(active_min, active_max, uses.size() + count / 4, 2 * count + 1);
  map.for_each_brick([&](const PlacedBrick& brick) {
    const auto values = map.voxels().subspan(std::size_t{brick.brick} * BrickMap::kBrickVoxels,
                                             BrickMap::kBrickVoxels);
    const bool is_constant = std::all_of(values.begin(), values.end(),
                                         [&](float value) { return value == values.front(); });
    if (is_constant && uses[brick.brick] > 1) {
      builder.add_constant_brick(brick.coord, values.front());
    } else {
      std::copy(values.begin(), values.end(), builder.add_brick(brick.coord).begin());
    }
  });
  copy_layer(map, axis, last, first - 1, builder);
  copy_layer(map, axis, first, last + 1, builder);
  return std::move(builder).finish();
}

void repeat(Field& field, int world_axis, const Box3d& domain, bool is_clipped) {
  if (field.voxels.empty()) return;
  const VoxelRow row = voxel_row(field, world_axis);
  const auto layers = layers_at_sides(field.name, row, world_axis, domain, is_clipped);
  if (layers) field.voxels = with_layers(field.voxels, row.axis, (*layers)[0], (*layers)[1]);
}

/// The same field with these layers along each axis that repeats; null and formulas stay.
std::shared_ptr<const Field> repeated(const std::shared_ptr<const Field>& field,
                                      const PeriodicSides& sides, bool is_clipped) {
  if (!field || field->function) return field;
  auto result = std::make_shared<Field>(*field);
  for (int axis = 0; axis < 3; ++axis) {
    if (sides.axes[axis]) repeat(*result, axis, *sides.extents, is_clipped);
  }
  return result;
}

/// Voxels of `colors` along an axis of the index from `begin` on, so many; what is not one of the
/// period [first, last] is the one that stands for it.
void cut_out(ColorVoxels& colors, int axis, int begin, int count,
             const std::array<int, 2>& period) {
  const Vec3i old = colors.counts;
  Vec3i counts = old;
  counts[axis] = count;
  const int length = period[1] - period[0] + 1;
  const auto cut = [&](std::vector<RgbSpectrum>& values) {
    if (values.empty()) return;
    std::vector<RgbSpectrum> result;
    result.reserve(static_cast<std::size_t>(counts.x) * counts.y * counts.z);
    const RgbSpectrum none = RgbSpectrum::unbounded(Vec3d(0), rgb_color_space("srgb"));
    Vec3i at;
    for (at.z = 0; at.z < counts.z; ++at.z) {
      for (at.y = 0; at.y < counts.y; ++at.y) {
        for (at.x = 0; at.x < counts.x; ++at.x) {
          Vec3i from = at;
          int& index = from[axis];
          index += begin;
          if (index < period[0]) index += length;
          if (index > period[1]) index -= length;
          const bool is_one = index >= 0 && index < old[axis];
          const std::size_t number =
              (static_cast<std::size_t>(from.z) * old.y + from.y) * old.x + from.x;
          result.push_back(is_one ? values[number] : none);
        }
      }
    }
    values = std::move(result);
  };
  cut(colors.sigma_a);
  cut(colors.sigma_s);
  cut(colors.radiance);
  colors.counts = counts;
  Vec3d shift(0);
  shift[axis] = begin;
  colors.index_to_world = Matrix4d().setTranslation(shift) * colors.index_to_world;
}

std::shared_ptr<const ColorVoxels> repeated(const ColorVoxels& voxels, const std::string& name,
                                            const PeriodicSides& sides) {
  auto result = std::make_shared<ColorVoxels>(voxels);
  for (int axis = 0; axis < 3; ++axis) {
    if (!sides.axes[axis]) continue;
    const VoxelRow row =
        voxel_row(name, result->index_to_world, Vec3i(0), result->counts - Vec3i(1), axis);
    const auto layers = layers_at_sides(name, row, axis, *sides.extents, true);
    if (!layers) continue;
    const int begin = (*layers)[0] - 1;
    cut_out(*result, row.axis, begin, (*layers)[1] + 2 - begin, *layers);
  }
  return result;
}

}  // namespace

SceneMedium repeated(const SceneMedium& medium, const PeriodicSides& sides, int super_voxel) {
  if (medium.is_homogeneous()) return medium;
  if (medium.colors()) {
    return {medium.name(), repeated(*medium.colors(), medium.name(), sides)};
  }
  const bool is_clipped = medium.medium()->outer_bounds() == medium.medium()->world_bounds();
  std::vector<Component> components = medium.medium()->components();
  for (Component& component : components) {
    component.density = repeated(component.density, sides, is_clipped);
  }
  std::vector<SceneMediumComponent> spectra = medium.components();
  for (SceneMediumComponent& component : spectra) {
    component.radiance_field = repeated(component.radiance_field, sides, is_clipped);
    if (component.temperature) {
      component.temperature->field = repeated(component.temperature->field, sides, is_clipped);
    }
  }
  Medium walked(std::move(components), super_voxel);
  if (is_clipped) walked = walked.clipped_to_voxels();
  return {medium.name(), std::make_shared<const Medium>(std::move(walked)), std::move(spectra)};
}

Box3d repeat_sides(std::vector<Volume>& volumes, const PeriodicSides& sides) {
  Box3d domain = sides.extents.value_or(Box3d(Vec3d(0), Vec3d(0)));
  for (int axis = 0; axis < 3; ++axis) {
    if (!sides.axes[axis]) continue;
    if (!sides.extents) {
      bool is_first = true;
      for (const Volume& volume : volumes) {
        for (const Field& field : volume.densities) {
          if (field.voxels.empty()) continue;
          const VoxelRow row = voxel_row(field, axis);
          domain.min[axis] = is_first ? row.low : std::min(domain.min[axis], row.low);
          domain.max[axis] = is_first ? row.high : std::max(domain.max[axis], row.high);
          is_first = false;
        }
      }
      if (is_first) fail("the volumes are empty: give the extents of the domain that repeats");
    }
    for (Volume& volume : volumes) {
      for (Field& field : volume.densities) repeat(field, axis, domain, false);
      if (!volume.temperature) continue;
      Field temperature = *volume.temperature;
      repeat(temperature, axis, domain, false);
      volume.temperature = std::make_shared<const Field>(std::move(temperature));
    }
  }
  return domain;
}

}  // namespace freepath
