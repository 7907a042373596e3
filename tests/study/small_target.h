#pragma once
/// @file A picture small enough to compare methods on in a test.

#include <memory>
#include <string>

#include "freepath/scene/volume_camera.h"
#include "freepath/scene/volume_scene.h"
#include "freepath/study/render_target.h"
#include "tests/media/make_field.h"

namespace freepath::testing {

/// A ball of uneven density under a constant sky, some 4 mean free paths thick; with `chromatic`
/// extinction in the ratios 1 : 2 : 4.
inline RenderTarget small_target(bool chromatic = false, int width = 64, int height = 48) {
  const auto field = make_field(Vec3i(-12), Vec3i(12), [](const Vec3i& p) {
    const float inside = 1 - static_cast<float>(p.x * p.x + p.y * p.y + p.z * p.z) / 150.0F;
    return inside > 0 ? inside * (p.x / 4 % 2 == 0 ? 1.5F : 0.5F) : 0.0F;
  });
  Component component{.density = field};
  component.sigma_s = chromatic ? Rgb(0.1F, 0.2F, 0.4F) : Rgb(0.25F);
  component.sigma_a = Rgb(0.02F);
  const auto medium = std::make_shared<const Medium>(std::vector<Component>{component}, 4);
  CameraOptions options;
  options.width = width;
  options.height = height;
  LightOptions light;
  light.environment = Rgb(0.5F, 0.7F, 1.0F);
  light.sun = false;
  const auto scene = std::make_shared<const PathScene>(make_volume_scene(
      {medium}, make_camera(*medium, options, UpAxis::kY), make_surroundings(light, UpAxis::kY)));
  RenderTarget target;
  target.name = "ball";
  target.digest = chromatic ? "chromatic ball" : "ball";
  target.width = width;
  target.height = height;
  target.render = [scene](const RenderSettings& settings, const ProgressFunction& progress) {
    return render_scene(*scene, ColorMode::kRgb, settings, progress);
  };
  return target;
}

}  // namespace freepath::testing
