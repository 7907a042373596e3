// Bare volumes that glow by a field of temperatures.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "freepath/paths/renderer.h"
#include "freepath/scene/volume_camera.h"
#include "freepath/scene/volume_scene.h"
#include "freepath/spectra/blackbody.h"
#include "freepath/spectra/cie_observer.h"
#include "freepath/spectra/rgb_color_space.h"
#include "tests/statistics.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr int kCubeVoxels = 8;        // of a cube [voxels], whose edge is 1 in the world
constexpr double kHotKelvins = 1900;  // [K]

/// @param margin around the cube [voxels]: temperatures fade over half a voxel at their border
std::shared_ptr<Field> glowing_cube(float value, int margin = 0) {
  Matrix4d index_to_world;
  index_to_world.setScale(Vec3d(1.0 / kCubeVoxels));
  return make_field(
      Vec3i(-margin), Vec3i(kCubeVoxels - 1 + margin), [value](const Vec3i&) { return value; },
      index_to_world);
}

/// The picture's mean of a cube of optical thickness 1 that emits and scatters nothing, seen face
/// on from far away.
std::array<RunningStatistics, 3> seen_face_on(OpticalProperties optics, const char* tracker) {
  std::vector<Volume> volumes(1);
  volumes[0].densities.push_back(*glowing_cube(1));
  // The field holds degrees of another scale.
  volumes[0].temperature = glowing_cube(static_cast<float>((kHotKelvins - 300) / 2), 8);
  optics.albedo = Rgb(0.0F);
  optics.temperature_scale = 2;
  optics.temperature_offset = -150;
  volumes[0].optics = std::move(optics);
  const VolumeMedium volume = make_medium(std::move(volumes), 0);
  const Medium& medium = *volume.medium;
  const Vec3d middle = medium.world_bounds().center();
  CameraOptions view{.width = 8, .height = 8, .fov = 1e-3, .from = {}, .at = middle};
  view.from = middle + Vec3d(0, 0, 500);
  const Camera camera = make_camera(medium, view, UpAxis::kY);
  RenderSettings settings;
  settings.samples = 2048;
  settings.walk.tracker = tracker;
  settings.walk.interpolation = Interpolation::kNearest;
  const RenderResult result =
      render_scene(make_volume_scene(volume, camera, {}), ColorMode::kRgb, settings);
  const Image image = result.film.to_image(LayerSet::standard());
  std::array<RunningStatistics, 3> means;
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    for (int c = 0; c < 3; ++c) {
      means[c].add(image.values[pixel * image.channels.size() + c]);
    }
  }
  return means;
}

TEST(VolumeTemperature, AHotCubeIsABlackBodySeenThroughItsOwnExtinction) {
  const BlackbodySpectrum body(kHotKelvins, BlackbodyScale::kPeak);
  const Vec3d radiance =
      rgb_color_space("srgb").from_xyz(observe(body)) * kLuminousIntegral * (1 - std::exp(-1.0));
  for (const char* tracker : {"delta", "spectral", "decomposition"}) {
    const auto means = seen_face_on({}, tracker);
    for (int c = 0; c < 3; ++c) {
      EXPECT_TRUE(check_mean(tracker, means[c].mean(), means[c].standard_error(), means[c].count(),
                             radiance[c],
                             c < 2 ? MeanTolerance{4, 0, 0.003} : MeanTolerance{4, 2e-3}));
    }
  }
}

TEST(VolumeTemperature, TheEmittedRadianceIsMultiplied) {
  OpticalProperties optics;
  optics.emission = Rgb(0.5F, 0.0F, 2.0F);
  const auto plain = seen_face_on({}, "delta");
  const auto scaled = seen_face_on(optics, "delta");
  EXPECT_NEAR(scaled[0].mean() / plain[0].mean(), 0.5, 1e-5);
  EXPECT_EQ(scaled[1].mean(), 0);
  EXPECT_NEAR(scaled[2].mean() / plain[2].mean(), 2, 1e-5);
}

TEST(VolumeTemperature, WhatIsColdDoesNotGlow) {
  OpticalProperties optics;
  std::vector<Volume> volumes(1);
  volumes[0].densities.push_back(*glowing_cube(1));
  volumes[0].temperature = glowing_cube(90);  // [K]
  EXPECT_FALSE(make_medium(std::move(volumes), 0).medium->emits());
}

}  // namespace
}  // namespace freepath::testing
