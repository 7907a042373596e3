#include "freepath/scene/ground.h"

#include <cmath>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/materials/material_kinds.h"
#include "freepath/spectra/rgb_color_space.h"
#include "freepath/spectra/rgb_spectrum.h"

namespace freepath {
namespace {

/// The plane reaches so many times the extent of everything else.
constexpr double kReach = 1e5;

}  // namespace

void check(const Ground& ground) {
  for (int channel = 0; channel < kChannels; ++channel) {
    const float albedo = ground.albedo[channel];
    if (albedo >= 0 && albedo <= 1) continue;
    fail("the albedo of the ground is {} in channel {}; it must lie in 0 to 1", albedo, channel);
  }
  if (ground.height && !std::isfinite(*ground.height)) {
    fail("the height of the ground is {}; it must be finite", *ground.height);
  }
}

double height_under(const Box3d& extent, const Ground& ground) {
  if (!ground.height && extent.isEmpty()) {
    fail("nothing has a bottom that a ground could lie at: give its height");
  }
  return ground.height.value_or(extent.min[up_index(ground.up)]);
}

void add_ground(const Ground& ground, const Box3d& extent, const Vec3d& camera, PathScene& scene,
                SurfaceScene& surfaces) {
  check(ground);
  const int up = up_index(ground.up);
  const double height = height_under(extent, ground);
  Box3d all = extent;
  all.extendBy(camera);
  Vec3d centre = all.center();
  const double reach = kReach * (all.size().length() + std::abs(centre[up] - height));
  centre[up] = height;
  Vec3d u(0), v(0);
  u[0] = reach;
  v[up == 1 ? 2 : 1] = reach;
  SurfaceShape plane;
  plane.geometry =
      TriangleMesh{.positions = {centre - u - v, centre + u - v, centre + u + v, centre - u + v},
                   .normals = {},
                   .uvs = {},
                   .indices = {0, 1, 2, 0, 2, 3}};
  plane.needs_uv = false;
  plane.shape = static_cast<uint32_t>(scene.shapes.size());
  surfaces.shapes.push_back(std::move(plane));
  const RgbSpectrum albedo =
      RgbSpectrum::reflectance(Vec3d(ground.albedo), rgb_color_space("srgb"));
  const auto material = static_cast<uint32_t>(scene.materials.size());
  scene.materials.emplace_back(
      DiffuseMaterial{scene.spectra->add(albedo, SpectrumRole::kReflectance)});
  scene.shapes.push_back({.material = material, .light = {}});
}

}  // namespace freepath
