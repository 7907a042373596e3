#include "freepath/scene/volume_scene.h"

#include <cmath>
#include <memory>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/io/image.h"
#include "freepath/render/sky.h"

namespace freepath {
namespace {

void set_coefficients(const OpticalProperties& optics, Component& component) {
  if (optics.sigma_a || optics.sigma_s) {
    component.sigma_a = optics.sigma_a.value_or(Spectrum(0.0F));
    component.sigma_s = optics.sigma_s.value_or(Spectrum(0.0F));
  } else {
    for (int channel = 0; channel < kChannels; ++channel) {
      const float albedo = optics.albedo[channel];
      if (!(albedo >= 0 && albedo <= 1)) {
        fail("the albedo of channel {} is {}; it must lie in 0 to 1", channel, albedo);
      }
    }
    component.sigma_s = optics.albedo;
    component.sigma_a = Spectrum(1.0F) - optics.albedo;
  }
  component.sigma_a *= optics.density_scale;
  component.sigma_s *= optics.density_scale;
}

}  // namespace

Medium make_medium(Field field, const OpticalProperties& optics, int super_voxel) {
  if (!std::isfinite(optics.density_scale) || optics.density_scale < 0) {
    fail("the density scale is {}; it must be finite and not negative", optics.density_scale);
  }
  Component component;
  component.density = std::make_shared<const Field>(std::move(field));
  component.g = optics.g;
  component.emission = optics.emission;
  set_coefficients(optics, component);
  return Medium({component}, super_voxel);
}

Camera make_camera(const Box3d& world_bounds, const CameraOptions& options, UpAxis up) {
  const double aspect = static_cast<double>(options.width) / options.height;
  View view = frame_box(world_bounds, up, options.fov, aspect);
  if (options.from) view.from = *options.from;
  if (options.at) view.at = *options.at;
  return Camera(view, options.width, options.height);
}

Lights make_lights(const LightOptions& options, UpAxis up) {
  std::optional<Sun> sun;
  if (options.sun) sun.emplace(options.sun_parameters, up);
  if (const auto* radiance = std::get_if<Spectrum>(&options.environment)) {
    return Lights(ConstantEnvironment(*radiance), sun);
  }
  if (const auto* file = std::get_if<std::string>(&options.environment)) {
    return Lights(ImageEnvironment(read_image(*file), up, *file), sun);
  }
  return Lights(make_sky(options.sun_parameters, up), sun);
}

}  // namespace freepath
