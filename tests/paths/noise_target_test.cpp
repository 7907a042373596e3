#include "freepath/paths/noise_target.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/paths/lumpy_cloud.h"
#include "tests/scene/volume_pictures.h"
#include "tests/statistics.h"

namespace freepath::testing {
namespace {

/// The mean of all pixels and channels, and the noise about another picture, as a part of its mean.
double mean_of(const Film& film) {
  double sum = 0;
  for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
    for (int c = 0; c < 3; ++c) sum += film.mean(pixel, c);
  }
  return sum / (3.0 * static_cast<double>(film.pixel_count()));
}

double error_of(const Film& film, const Film& truth) {
  double sum = 0;
  for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
    for (int c = 0; c < 3; ++c) sum += std::pow(film.mean(pixel, c) - truth.mean(pixel, c), 2);
  }
  return std::sqrt(sum / (3.0 * static_cast<double>(film.pixel_count()))) / mean_of(truth);
}

// 19 of 20 pictures are as near to the truth as was asked for, and the mean of all is the truth.
TEST(NoiseTarget, IsReachedWithoutBias) {
  constexpr double kNoise = 0.02;
  constexpr int kSeeds = 100;
  const Medium medium({cloud(Rgb(0.5F), Rgb(5.0F, 3.0F, 1.0F), 0.3F)});
  const PathScene scene = scene_of(medium, camera_for(medium, 24, 18), constant_light(1));
  RenderSettings settings;
  settings.layers = {};
  settings.samples = 20'000;
  settings.walk.seed = 1'000'000;
  const Film truth = render_scene(scene, ColorMode::kRgb, settings).film;
  std::vector<double> errors;
  RunningStatistics means;
  for (int seed = 0; seed < kSeeds; ++seed) {
    settings.walk.seed = static_cast<uint64_t>(seed);
    settings.samples = 0;
    const NoisePlan plan = plan_noise(scene, ColorMode::kRgb, settings, kNoise);
    EXPECT_GE(plan.pilot_samples * 16, plan.samples);
    settings.samples = plan.samples;
    const Film film = render_scene(scene, ColorMode::kRgb, settings).film;
    errors.push_back(error_of(film, truth) / kNoise);
    means.add(mean_of(film));
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LE(errors[kSeeds * 95 / 100 - 1], 1.05);
  EXPECT_GE(errors[kSeeds / 2], 0.93);  // not by taking far more samples
  EXPECT_TRUE(check_mean("all seeds", means, mean_of(truth), {.z = 4}));
}

TEST(NoiseTarget, SamplesAreThoseAllowedAtMost) {
  const Medium medium({cloud(Rgb(0.5F), Rgb(5.0F), 0)});
  const PathScene scene = scene_of(medium, camera_for(medium, 32, 24), constant_light(1));
  RenderSettings settings;
  settings.samples = 50;
  EXPECT_EQ(plan_noise(scene, ColorMode::kRgb, settings, 1e-4).samples, 50U);
  // Twice the noise, a quarter of the samples.
  settings.samples = 0;
  const double fine = plan_noise(scene, ColorMode::kRgb, settings, 0.005).samples;
  const double coarse = plan_noise(scene, ColorMode::kRgb, settings, 0.01).samples;
  EXPECT_NEAR(fine / coarse, 4, 0.4);
  // Pilots that are longer than the shortest cost an eighth of the picture at most.
  const NoisePlan longer = plan_noise(scene, ColorMode::kRgb, settings, 0.003);
  EXPECT_GT(longer.pilot_samples, 8U);
  EXPECT_LE(7 * longer.pilot_samples, longer.samples);
}

// Nothing to see is no noise.
TEST(NoiseTarget, ABlackPictureTakesFewSamples) {
  const Medium medium({cloud(Rgb(0.5F), Rgb(5.0F), 0)});
  const PathScene scene = scene_of(medium, camera_for(medium, 8, 6), constant_light(0));
  RenderSettings settings;
  settings.samples = 0;
  EXPECT_EQ(plan_noise(scene, ColorMode::kRgb, settings, 0.01).samples, 2U);
}

}  // namespace
}  // namespace freepath::testing
