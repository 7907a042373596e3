#include "freepath/paths/scene_medium.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "freepath/base/error.h"

namespace freepath {
namespace {

SampledSpectrum thermal_channels(double temperature, const SpectrumValues& spectra) {
  SampledSpectrum radiance;
  if (!spectra.is_spectral()) {
    const Vec3d rgb = spectra.rgb_of_xyz(thermal_xyz(temperature));
    return {static_cast<float>(rgb.x), static_cast<float>(rgb.y), static_cast<float>(rgb.z)};
  }
  for (int i = 0; i < spectra.channels(); ++i) {
    radiance[i] = static_cast<float>(thermal_radiance(temperature, spectra.wavelengths()[i]));
  }
  return radiance;
}

/// One number for each voxel, x fastest, as a field.
template <class Value>
std::shared_ptr<const Field> make_voxels(const ColorVoxels& colors, const std::string& name,
                                         const Value& value_of) {
  BrickMapBuilder builder(Vec3i(0), colors.counts - Vec3i(1), 0);
  std::size_t i = 0;
  for (int z = 0; z < colors.counts.z; ++z) {
    for (int y = 0; y < colors.counts.y; ++y) {
      for (int x = 0; x < colors.counts.x; ++x, ++i) {
        builder.set_voxel(Vec3i(x, y, z), value_of(i));
      }
    }
  }
  auto field = std::make_shared<Field>();
  field->name = name;
  field->voxels = std::move(builder).finish();
  field->index_to_world = colors.index_to_world;
  return field;
}

}  // namespace

SceneMedium::SceneMedium(std::string name, std::shared_ptr<const Medium> medium,
                         std::vector<SceneMediumComponent> components)
    : name_(std::move(name)), medium_(std::move(medium)), components_(std::move(components)) {
  for (const SceneMediumComponent& component : components_) phases_.push_back(component.phase);
  bounds_ = medium_->world_bounds();
}

SceneMedium::SceneMedium(std::string name, std::shared_ptr<const ColorVoxels> voxels)
    : name_(std::move(name)), colors_(std::move(voxels)), phases_{colors_->phase} {
  bounds_ = outer_box().bounds();
}

BoundMedium SceneMedium::bind(const SpectrumValues& spectra) const {
  if (colors_) return bind_colors(spectra);
  BoundMedium bound{medium_, {}};
  bound.channels.count = spectra.channels();
  for (const SceneMediumComponent& component : components_) {
    ComponentChannels& target = bound.channels.components.emplace_back();
    for (int c = 0; c < spectra.channels(); ++c) {
      target.sigma_a[c] = std::max(0.0F, spectra[component.sigma_a][c] * component.scale);
      target.sigma_s[c] = std::max(0.0F, spectra[component.sigma_s][c] * component.scale);
      target.emission[c] =
          std::max(0.0F, spectra[component.radiance][c]) * component.radiance_scale;
      target.radiance[c].field = component.radiance_field;
    }
    if (component.temperature) {
      const auto fields = tabulate_radiance(
          *component.temperature, [&](double kelvin) { return thermal_channels(kelvin, spectra); });
      std::copy(fields.begin(), fields.end(), target.radiance.begin());
      const SampledSpectrum factor = component.temperature_factor
                                         ? spectra[*component.temperature_factor]
                                         : SampledSpectrum(1.0F);
      for (int c = 0; c < spectra.channels(); ++c) {
        target.emission[c] = fields[0].field ? component.radiance_scale * factor[c] : 0;
      }
    }
  }
  return bound;
}

BoundMedium SceneMedium::bind_colors(const SpectrumValues& spectra) const {
  const ColorVoxels& colors = *colors_;
  BoundMedium bound;
  bound.channels.count = spectra.channels();
  std::vector<Component> components;
  const auto value_of = [&](const std::vector<RgbSpectrum>& values, SpectrumRole role) {
    return [&values, &spectra, role](int channel) {
      return [&values, &spectra, role, channel](std::size_t i) {
        return std::max(0.0F, spectra.value_of(values[i], role, channel));
      };
    };
  };
  for (const bool scatters : {false, true}) {
    const std::vector<RgbSpectrum>& sigma = scatters ? colors.sigma_s : colors.sigma_a;
    if (sigma.empty()) continue;
    for (int c = 0; c < spectra.channels(); ++c) {
      Component component;
      component.density =
          make_voxels(colors, name_, value_of(sigma, SpectrumRole::kReflectance)(c));
      component.sigma_a = Rgb(scatters ? 0.0F : colors.scale);
      component.sigma_s = Rgb(scatters ? colors.scale : 0.0F);
      components.push_back(component);
      ComponentChannels& target = bound.channels.components.emplace_back();
      (scatters ? target.sigma_s : target.sigma_a)[c] = colors.scale;
      if (scatters || colors.radiance.empty()) continue;
      const auto radiance =
          make_voxels(colors, name_, value_of(colors.radiance, SpectrumRole::kIlluminant)(c));
      for (RadianceField& field : target.radiance) field.field = radiance;
      target.emission[c] = colors.radiance_scale * static_cast<float>(kMediumRadiance);
    }
  }
  bound.medium = std::make_shared<const Medium>(
      Medium(std::move(components), colors.super_voxel).clipped_to_voxels());
  return bound;
}

Box3d SceneMedium::outer_bounds() const { return medium_ ? medium_->outer_bounds() : bounds_; }

OrientedBox SceneMedium::outer_box() const {
  if (medium_) return medium_->outer_box();
  return OrientedBox(Box3d(Vec3d(-0.5), Vec3d(colors_->counts) - Vec3d(0.5)),
                     colors_->index_to_world);
}

std::size_t SceneMedium::bytes_of_set(int wavelengths) const {
  if (!colors_) return 0;
  const std::size_t values =
      colors_->sigma_a.size() + colors_->sigma_s.size() + colors_->radiance.size();
  return values * sizeof(float) * static_cast<std::size_t>(wavelengths);
}

bool SceneMedium::is_grey(const SpectrumTable& table) const {
  return !colors_ && std::all_of(components_.begin(), components_.end(),
                                 [&](const SceneMediumComponent& component) {
                                   return table.is_constant(component.sigma_a) &&
                                          table.is_constant(component.sigma_s);
                                 });
}

bool SceneMedium::is_constant(const SpectrumTable& table) const {
  return is_grey(table) && std::all_of(components_.begin(), components_.end(),
                                       [&](const SceneMediumComponent& component) {
                                         return !component.temperature &&
                                                table.is_constant(component.radiance);
                                       });
}

SampledSpectrum SceneMedium::albedo(std::size_t component, const SpectrumValues& spectra) const {
  if (components_.empty()) return SampledSpectrum(1.0F);
  const SceneMediumComponent& values = components_[std::min(component, components_.size() - 1)];
  const SampledSpectrum& sigma_s = spectra[values.sigma_s];
  const SampledSpectrum sigma_t = sigma_s + spectra[values.sigma_a];
  SampledSpectrum albedo;
  for (int c = 0; c < kMaxChannels; ++c) {
    albedo[c] = sigma_s[c] / (sigma_t[c] > 0 ? sigma_t[c] : 1.0F);
  }
  return albedo;
}

SceneMedium SceneMedium::homogeneous(std::string name, SceneMediumComponent component,
                                     const Box3d& box, const Matrix4d& box_to_world,
                                     float largest_sigma_t) {
  // Filters let the outermost voxels fade, so that the box ends at their middles.
  constexpr int kVoxels = 3;
  BrickMapBuilder builder(Vec3i(0), Vec3i(kVoxels - 1), 0);
  for (int i = 0; i < kVoxels * kVoxels * kVoxels; ++i) {
    builder.set_voxel(Vec3i(i % kVoxels, i / kVoxels % kVoxels, i / kVoxels / kVoxels), 1.0F);
  }
  auto field = std::make_shared<Field>();
  field->name = name;
  field->voxels = std::move(builder).finish();
  Matrix4d index_to_box;
  index_to_box.setScale(box.size() / double{kVoxels - 1});
  for (int axis = 0; axis < 3; ++axis) index_to_box[3][axis] = box.min[axis];
  field->index_to_world = index_to_box * box_to_world;
  Component uniform;
  uniform.density = field;
  uniform.sigma_s = Rgb(largest_sigma_t);
  SceneMedium medium(std::move(name),
                     std::make_shared<const Medium>(Medium({uniform}).clipped_to_middles()),
                     {std::move(component)});
  medium.is_homogeneous_ = true;
  return medium;
}

SceneMedium SceneMedium::in_box(const Box3d& box, const Matrix4d& box_to_world) const {
  return homogeneous(name_, components_[0], box, box_to_world, medium_->components()[0].sigma_s[0]);
}

}  // namespace freepath
