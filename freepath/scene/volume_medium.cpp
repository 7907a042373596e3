#include "freepath/scene/volume_medium.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "freepath/base/box.h"
#include "freepath/base/error.h"
#include "freepath/media/walk_space.h"
#include "freepath/spectra/rgb_color_space.h"
#include "freepath/spectra/rgb_spectrum.h"

namespace freepath {
namespace {

void set_coefficients(const OpticalProperties& optics, Component& component) {
  if (!std::isfinite(optics.density_scale) || optics.density_scale < 0) {
    fail("the density scale is {}; it must be finite and not negative", optics.density_scale);
  }
  if (optics.sigma_a || optics.sigma_s) {
    component.sigma_a = optics.sigma_a.value_or(Rgb(0.0F));
    component.sigma_s = optics.sigma_s.value_or(Rgb(0.0F));
  } else {
    for (int channel = 0; channel < kChannels; ++channel) {
      const float albedo = optics.albedo[channel];
      if (!(albedo >= 0 && albedo <= 1)) {
        fail("the albedo of channel {} is {}; it must lie in 0 to 1", channel, albedo);
      }
    }
    component.sigma_s = optics.albedo;
    component.sigma_a = Rgb(1.0F) - optics.albedo;
  }
  component.sigma_a *= optics.density_scale;
  component.sigma_s *= optics.density_scale;
}

/// Black bodies of temperatures, in R, G and B (sRGB).
std::array<RadianceField, kChannels> glow_of(const TemperatureEmission& emission) {
  const RgbColorSpace& space = rgb_color_space("srgb");
  const auto fields = tabulate_radiance(emission, [&](double kelvin) {
    const Vec3d rgb = space.from_xyz(thermal_xyz(kelvin));
    SampledSpectrum radiance;
    for (int c = 0; c < kChannels; ++c) radiance[c] = static_cast<float>(rgb[c]);
    return radiance;
  });
  return {fields[0], fields[1], fields[2]};
}

/// The components that a volume contributes.
void add_components(Volume volume, std::vector<Component>& components,
                    std::vector<std::optional<TemperatureEmission>>& temperatures) {
  const std::size_t densities = volume.densities.size();
  if (densities != 1 && densities != kChannels) {
    fail("a volume has one density, or three for R, G and B, not {}", densities);
  }
  Component glowing;
  glowing.emission = volume.optics.emission.value_or(Rgb(0.0F));
  std::optional<TemperatureEmission> temperature;
  if (volume.temperature) {
    temperature = {volume.temperature, volume.optics.temperature_scale,
                   volume.optics.temperature_offset};
    set_thermal_emission(*temperature, volume.optics.emission.value_or(Rgb(1.0F)), glowing);
  }
  for (std::size_t i = 0; i < densities; ++i) {
    Component component = glowing;
    component.density = std::make_shared<const Field>(std::move(volume.densities[i]));
    component.phase = volume.optics.phase;
    set_coefficients(volume.optics, component);
    if (densities > 1) {
      Rgb only(0.0F);
      only[static_cast<int>(i)] = 1;
      component.sigma_a *= only;
      component.sigma_s *= only;
    }
    components.push_back(std::move(component));
    temperatures.push_back(temperature);
  }
}

/// Beyond this many mean free paths across a volume single precision no longer tells one tentative
/// collision from the next, and a walk would not get on.
constexpr double kLargestOpticalDepth = 4e6;

/// Length across a part of a medium [world].
double length_of(const Medium& medium, const WalkPart& part) {
  const Matrix4d to_world = medium.world_to_grid().inverse();
  const Box3d box = Imath::transform(Box3d(Vec3d(part.box.begin), Vec3d(part.box.end)), to_world);
  return std::min(box.size().length(), medium.world_bounds().size().length());
}

void check_depth_of_part(const Medium& medium, const WalkPart& medium_part) {
  const std::vector<Component>& components = medium.components();
  const std::vector<float>& maxima = medium_part.cells.maxima;
  const double length = length_of(medium, medium_part);
  double depth = 0;
  double deepest = -1;
  float densest = 0;
  const Field* field = nullptr;
  for (std::size_t k = 0; k < components.size(); ++k) {
    float most = 0;
    for (std::size_t i = k; i < maxima.size(); i += components.size()) {
      most = std::max(most, maxima[i]);
    }
    const double part = double{most} * largest(components[k].sigma_t()) * length;
    depth += part;
    if (part <= deepest) continue;
    deepest = part;
    densest = most;
    field = components[k].density.get();
  }
  if (depth > kLargestOpticalDepth) {
    fail(
        "grid '{}': its largest density, {}, makes an optical depth of {:.3g} across the volume, "
        "more "
        "than {:.0e}: take a smaller --density-scale or smaller coefficients",
        field->name, densest, depth, kLargestOpticalDepth);
  }
}

/// A coefficient of any size. Equal channels are the same at all wavelengths.
SpectralDistribution coefficient(const Rgb& rgb, const RgbColorSpace& space) {
  if (rgb.x == rgb.y && rgb.y == rgb.z) return {double{rgb.x}};
  return RgbSpectrum::unbounded(Vec3d(rgb), space);
}

std::vector<SceneMediumComponent> spectra_of(const VolumeMedium& medium, SpectrumTable& table) {
  const auto add = [&](const Rgb& rgb) {
    return table.add(coefficient(rgb, table.space()), SpectrumRole::kReflectance);
  };
  std::vector<SceneMediumComponent> spectra;
  for (const Component& component : medium.medium->components()) {
    const std::size_t number = spectra.size();
    SceneMediumComponent& target = spectra.emplace_back();
    target.sigma_a = add(component.sigma_a);
    target.sigma_s = add(component.sigma_s);
    target.phase = component.phase;
    if (number < medium.temperatures.size() && medium.temperatures[number]) {
      target.temperature = medium.temperatures[number];
      target.temperature_factor = add(component.emission);
    } else if (component.radiance[0].field) {
      fail(
          "component {}: its radiance is a field without temperatures, of which no spectrum is "
          "known",
          number);
    } else if (largest(component.emission) > 0) {
      target.radiance = table.add(RgbSpectrum::illuminant(Vec3d(component.emission), table.space()),
                                  SpectrumRole::kIlluminant);
    }
  }
  return spectra;
}

}  // namespace

void set_thermal_emission(const TemperatureEmission& emission, const Rgb& factor,
                          Component& component) {
  component.radiance = glow_of(emission);
  component.emission = component.radiance[0].field ? factor : Rgb(0.0F);
}

VolumeMedium make_medium(std::vector<Volume> volumes, int super_voxel, const PeriodicSides& sides) {
  VolumeMedium result;
  if (sides.any()) {
    result.sides = {sides.axes, repeat_sides(volumes, sides)};
  }
  std::vector<Field*> fields;
  for (Volume& volume : volumes) {
    for (Field& field : volume.densities) fields.push_back(&field);
  }
  if (!fields.empty()) share_layout(fields);
  std::vector<Component> components;
  for (Volume& volume : volumes) {
    add_components(std::move(volume), components, result.temperatures);
  }
  if (components.size() > Medium::kMaxComponents) {
    fail("the volumes have {} densities, more than {}: an RGB density counts as three",
         components.size(), Medium::kMaxComponents);
  }
  result.medium = std::make_shared<const Medium>(std::move(components), super_voxel);
  check_optical_depth(*result.medium);
  return result;
}

std::vector<VolumeMedium> grey_media(const VolumeMedium& medium, const MediumChannels& channels,
                                     int super_voxel) {
  if (channels.is_grey()) return {medium};
  std::vector<VolumeMedium> media(static_cast<std::size_t>(channels.count), medium);
  for (int c = 0; c < channels.count; ++c) {
    std::vector<Component> components = medium.medium->components();
    for (std::size_t k = 0; k < components.size(); ++k) {
      const ComponentChannels& from = channels.components[k];
      components[k].sigma_a = Rgb(from.sigma_a[c]);
      components[k].sigma_s = Rgb(from.sigma_s[c]);
      components[k].emission = Rgb(from.emission[c]);
      components[k].radiance.fill(from.radiance[c]);
    }
    media[c].medium = std::make_shared<const Medium>(std::move(components), super_voxel);
  }
  return media;
}

void check_optical_depth(const Medium& medium) {
  for (const WalkPart& part : medium.parts()) check_depth_of_part(medium, part);
}

bool is_empty(const Medium& medium) {
  const std::vector<Component>& components = medium.components();
  const std::vector<float>& maxima = medium.super_voxels().maxima;
  const auto is_computed = [](const Component& c) { return c.density->function != nullptr; };
  return std::none_of(components.begin(), components.end(), is_computed) &&
         std::all_of(maxima.begin(), maxima.end(), [](float most) { return most == 0; });
}

SceneMedium to_scene_medium(const VolumeMedium& medium, SpectrumTable& table) {
  return {"volume", medium.medium, spectra_of(medium, table)};
}

}  // namespace freepath
