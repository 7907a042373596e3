// The renderer against furnaces and closed forms, and the independence of its pictures.

#include "freepath/paths/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "freepath/base/error.h"
#include "tests/paths/lumpy_cloud.h"
#include "tests/scene/volume_pictures.h"
#include "tests/statistics.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

/// Mean over the picture of a colour channel with its standard error, from the variance channels.
struct PictureMean {
  double mean = 0;
  double error = 0;
};

PictureMean picture_mean(const Film& film, int channel) {
  const Image image = film.to_image();
  const char* const names[] = {"R", "G", "B"};
  const int value = *find_channel(image, names[channel]);
  const int variance = *find_channel(image, std::string("variance.") + names[channel]);
  PictureMean result;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      result.mean += image.pixel(column, row)[value];
      result.error += image.pixel(column, row)[variance];
    }
  }
  const auto pixels = static_cast<double>(image.pixel_count());
  result.mean /= pixels;
  result.error = std::sqrt(result.error) / pixels;
  return result;
}

// Of a tracker whose weights grow at every scattering a picture would have an infinite variance,
// and be far from right: it is refused before it starts, unless paths are short.
TEST(Renderer, RefusesTrackersWhoseWeightsGrow) {
  const Rgb colour(1.0F, 2.0F, 3.0F);
  const Rgb albedos(1.0F, 0.5F, 0.2F);
  const Medium grey({cloud(Rgb(0.0F), Rgb(3.0F), 0)});
  const Medium coloured({cloud(Rgb(0.0F), colour, 0)});
  const Medium grey_extinction({cloud(Rgb(1.0F) - albedos, albedos, 0)});
  struct Case {
    const Medium& medium;
    const char* tracker;
    bool refused;
    uint32_t max_scatterings = UINT32_MAX;
    Absorption absorption = Absorption::kWeighted;
    const char* transmittance = "ratio";
  };
  const Case cases[] = {
      {grey, "weighted-delta:rate-scale=0.7", true},
      {grey, "weighted-delta:rate-scale=0.99", true},
      {grey, "weighted-delta:rate-scale=0.9", false, 1},
      {grey, "weighted-delta:rate-scale=0.7", true, 3},
      {grey, "weighted-delta:rate-scale=0.5", true, 0},
      {grey, "weighted-delta:rate-scale=1", false},
      {grey, "weighted-decomposition:control=1.1", true},
      {grey, "weighted-decomposition:control=0.5", false},
      {grey, "weighted-decomposition:rate-scale=0.9", true},
      {grey, "spectral:collision-probability=max", false},
      {grey, "spectral:rate-scale=0.9", true},
      {coloured, "spectral:collision-probability=max", true},
      {coloured, "spectral:collision-probability=average", true},
      {coloured, "spectral-decomposition:collision-probability=max", true},
      {coloured, "spectral", false},
      {coloured, "hero-wavelength", false},
      {coloured, "hero-wavelength:selection=throughput-albedo", true},
      {coloured, "delta", false, UINT32_MAX, Absorption::kAnalog},
      {grey_extinction, "delta", false},
      {grey_extinction, "delta", true, UINT32_MAX, Absorption::kAnalog},
      {grey_extinction, "spectral", false, UINT32_MAX, Absorption::kAnalog},
      {grey, "delta", true, UINT32_MAX, Absorption::kWeighted, "ratio:rate-scale=0.4"},
      {grey, "delta", false, UINT32_MAX, Absorption::kWeighted, "ratio:rate-scale=0.6"},
      {grey, "delta", true, UINT32_MAX, Absorption::kWeighted, "p-series:rate-scale=0.4"},
  };
  for (const Case& test : cases) {
    RenderSettings settings = settings_of(1, test.tracker);
    settings.max_scatterings = test.max_scatterings;
    settings.walk.absorption = test.absorption;
    settings.walk.transmittance = test.transmittance;
    const auto picture = [&] {
      render(test.medium, camera_for(test.medium, 2, 2), constant_light(1), settings);
    };
    SCOPED_TRACE(test.tracker);
    if (test.refused) {
      EXPECT_THROW(picture(), Error);
    } else {
      EXPECT_NO_THROW(picture());
    }
    settings.studies_unbounded_weights = true;
    EXPECT_NO_THROW(picture());
  }
}

// What a path that overflows would have added is not known, and neither is the error of its pixel.
TEST(Renderer, AnOverflowMakesTheVarianceInfinite) {
  const Medium medium({cloud(Rgb(0.0F), Rgb(300.0F), 0)});
  RenderSettings settings = settings_of(2, "weighted-delta:rate-scale=0.1");
  settings.studies_unbounded_weights = true;
  const RenderResult result = render(medium, camera_for(medium, 4, 4), constant_light(1), settings);
  EXPECT_GT(result.counts.overflows, 0U);
  const Image image = result.film.to_image();
  const int index = find_channel(image, "variance.R").value();
  bool infinite = false;
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    infinite = infinite || std::isinf(image.values[i * image.channels.size() + index]);
  }
  EXPECT_TRUE(infinite);
}

struct FurnaceCase {
  const char* tracker;
  Absorption absorption;
  EmissionTally emission;
  Interpolation interpolation;
};

std::vector<FurnaceCase> furnace_cases() {
  std::vector<FurnaceCase> cases;
  for (const char* tracker : {"delta", "weighted-delta", "weighted-delta:rate-scale=1.5"}) {
    for (const Absorption absorption : {Absorption::kAnalog, Absorption::kWeighted}) {
      for (const EmissionTally emission : {EmissionTally::kCollision, EmissionTally::kAnalog}) {
        cases.push_back({tracker, absorption, emission, Interpolation::kStochastic});
      }
    }
  }
  cases.push_back({"delta", {}, {}, Interpolation::kTrilinear});
  cases.push_back({"delta", {}, {}, Interpolation::kNearest});
  return cases;
}

// A closed furnace: whatever the medium does, the radiance is 1 everywhere.
void expect_furnace(const Component& component, int samples) {
  const Medium medium({component});
  const Camera camera = camera_for(medium, 32, 32);
  const auto cases = furnace_cases();
  const double threshold = family_wise_threshold(1e-3, cases.size());
  for (const FurnaceCase& test : cases) {
    RenderSettings settings = settings_of(static_cast<uint32_t>(samples), test.tracker);
    settings.walk.absorption = test.absorption;
    settings.walk.emission = test.emission;
    settings.walk.interpolation = test.interpolation;
    const RenderResult result = render(medium, camera, constant_light(1), settings);
    const PictureMean mean = picture_mean(result.film, 1);
    EXPECT_TRUE(check_mean(test.tracker, mean.mean, mean.error, result.counts.paths, 1.0,
                           {.z = threshold, .absolute = 1e-5, .largest_relative_error = 1e-3}));
    EXPECT_EQ(result.counts.overflows, 0U);
    EXPECT_EQ(result.counts.statistics().bound_violations, 0U);
  }
}

TEST(Renderer, WhiteFurnaceIsWhite) { expect_furnace(cloud(Rgb(0.0F), Rgb(6.0F), 0.4F), 512); }

TEST(Renderer, EmittingFurnaceIsWhite) {
  Component component = cloud(Rgb(3.0F), Rgb(3.0F), -0.3F);
  component.emission = Rgb(1.0F);
  expect_furnace(component, 512);
}

// One path for each channel, and an extinction that differs sixteenfold among them.
TEST(Renderer, ChromaticFurnaceIsWhiteInEveryChannel) {
  Component component = cloud(Rgb(0.5F, 2, 1), Rgb(0.5F, 2, 15), 0.2F);
  component.emission = Rgb(1.0F);
  const Medium medium({component});
  const RenderResult result =
      render(medium, camera_for(medium, 32, 32), constant_light(1), settings_of(512));
  for (int channel = 0; channel < 3; ++channel) {
    const PictureMean mean = picture_mean(result.film, channel);
    EXPECT_TRUE(check_mean("channel", mean.mean, mean.error, result.counts.paths, 1.0,
                           {.absolute = 1e-5, .largest_relative_error = 2e-3}));
  }
  EXPECT_EQ(result.counts.paths, 3U * 512 * 32 * 32);
}

// Without a scattering what is cut is what does not pass: A of the picture.
TEST(Renderer, TellsTheWeightThatTheLimitCuts) {
  for (const Rgb& extinction : {Rgb(2.0F), Rgb(1.0F, 2.0F, 3.0F)}) {
    const Medium medium({cloud(Rgb(0.0F), extinction, 0)});
    RenderSettings settings = settings_of(16);
    settings.max_scatterings = 0;
    const RenderResult result =
        render(medium, camera_for(medium, 8, 8), constant_light(1), settings);
    const Image image = result.film.to_image();
    const int alpha = *find_channel(image, "A");
    double sum = 0;
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
      sum += image.values[i * image.channels.size() + alpha];
    }
    EXPECT_GT(result.counts.cut_paths, 0U);
    EXPECT_NEAR(result.counts.cut_share(), sum / static_cast<double>(image.pixel_count()), 1e-4);
    settings.max_scatterings = UINT32_MAX;
    EXPECT_EQ(
        render(medium, camera_for(medium, 2, 2), constant_light(1), settings).counts.cut_paths, 0U);
  }
}

// Grey extinction under a coloured albedo: one path carries the weights of all channels.
TEST(Renderer, ColouredAlbedoAgreesWithEachChannelAlone) {
  const Rgb albedo(0.95F, 0.6F, 0.2F);
  const Medium together({cloud((Rgb(1.0F) - albedo) * 8.0F, albedo * 8.0F, 0.3F)});
  const Camera camera = camera_for(together, 32, 32);
  for (const Absorption absorption : {Absorption::kAnalog, Absorption::kWeighted}) {
    RenderSettings settings = settings_of(512);
    settings.walk.absorption = absorption;
    // One event for all channels: weights grow by a²/mean(a) at every scattering.
    if (absorption == Absorption::kAnalog) settings.max_scatterings = 5;
    const RenderResult all = render(together, camera, constant_light(1), settings);
    for (int channel = 0; channel < 3; ++channel) {
      const float a = albedo[channel];
      const Medium alone({cloud(Rgb((1 - a) * 8), Rgb(a * 8), 0.3F)});
      settings.walk.seed = 99;
      const RenderResult one = render(alone, camera, constant_light(1), settings);
      const PictureMean mean = picture_mean(all.film, channel);
      const PictureMean expected = picture_mean(one.film, 0);
      EXPECT_TRUE(check_mean("channel", mean.mean, std::hypot(mean.error, expected.error), 0,
                             expected.mean, {.largest_relative_error = 5e-3}));
    }
  }
}

// Without scattering a pixel is what the light has left: exp(-optical depth).
TEST(Renderer, AbsorbingMediumLetsThroughItsTransmittance) {
  const Medium medium({cloud(Rgb(4.0F), Rgb(0.0F), 0)});
  const Box3d bounds = medium.world_bounds();
  const Vec3d centre = bounds.center();
  // A lens so long that all rays of the one pixel are alike.
  const View view{centre + Vec3d(0.05, 0.02, 6), centre + Vec3d(0.05, 0.02, 0), Vec3d(0, 1, 0),
                  1e-4};
  const double tau = 4 * optical_depth(*medium.components()[0].density, view.from, Vec3d(0, 0, -1),
                                       12, Interpolation::kTrilinear);
  for (const Interpolation interpolation :
       {Interpolation::kTrilinear, Interpolation::kStochastic}) {
    RenderSettings settings = settings_of(1 << 20);
    settings.walk.interpolation = interpolation;
    settings.walk.absorption = Absorption::kAnalog;
    const RenderResult result = render(medium, Camera(view, 1, 1), constant_light(2), settings);
    const PictureMean mean = picture_mean(result.film, 0);
    EXPECT_TRUE(check_mean("radiance", mean.mean, mean.error, result.counts.paths,
                           2 * std::exp(-tau), {.absolute = 1e-5, .largest_relative_error = 0.01}));
  }
}

TEST(Renderer, CameraInsideTheMediumSeesTheFurnaceToo) {
  const Medium medium({cloud(Rgb(0.0F), Rgb(6.0F), 0)});
  const Vec3d centre = medium.world_bounds().center();
  const Camera camera({centre, centre + Vec3d(1, 0.2, 0.1), Vec3d(0, 1, 0), 90}, 16, 16);
  const RenderResult result = render(medium, camera, constant_light(1), settings_of(1024));
  const PictureMean mean = picture_mean(result.film, 2);
  EXPECT_TRUE(
      check_mean("inside", mean.mean, mean.error, result.counts.paths, 1, {.absolute = 1e-5}));
}

// The power of the furnaces: an albedo of 0.99 for 1 must fail them.
TEST(Renderer, AFurnaceThatLosesOnePercentIsNoticed) {
  const Medium medium({cloud(Rgb(0.06F), Rgb(5.94F), 0.4F)});
  const RenderResult result =
      render(medium, camera_for(medium, 32, 32), constant_light(1), settings_of(512));
  const PictureMean mean = picture_mean(result.film, 1);
  EXPECT_LT(z_score(mean.mean, mean.error, 1.0), -8);
}

std::vector<float> picture_of(const Medium& medium, const RenderSettings& settings) {
  const Surroundings lights{Rgb(0.3F), Sun({.elevation = 50}, UpAxis::kY)};
  return render(medium, camera_for(medium, 40, 30), lights, settings).film.to_image().values;
}

TEST(Renderer, PictureDependsOnSeedAndSamplesAlone) {
  const std::vector<Medium> media = [] {
    std::vector<Medium> list;
    list.emplace_back(std::vector{cloud(Rgb(0.1F), Rgb(9.0F), 0.8F)});
    list.emplace_back(std::vector{cloud(Rgb(0.1F), Rgb(4, 1, 0.25F), 0)});
    return list;
  }();
  for (const Medium& medium : media) {
    RenderSettings settings = settings_of(9);
    settings.threads = 1;
    const std::vector<float> reference = picture_of(medium, settings);
    for (const int threads : {1, 2, 3}) {
      for (const std::size_t batch : {1, 37, 2048}) {
        settings.threads = threads;
        settings.batch = batch;
        EXPECT_EQ(picture_of(medium, settings), reference)
            << threads << " threads, batch " << batch;
      }
    }
    settings.walk.seed = 12;
    EXPECT_NE(picture_of(medium, settings), reference);
  }
}

TEST(Renderer, EveryTargetGivesTheSameBits) {
  const Medium medium({cloud(Rgb(0.1F), Rgb(9.0F), 0.8F)});
  std::vector<std::vector<float>> pictures;
  for (const Simd simd : available_simd()) {
    RenderSettings settings = settings_of(9, "weighted-delta");
    settings.walk.simd = simd;
    pictures.push_back(picture_of(medium, settings));
  }
  ASSERT_GE(pictures.size(), 2U);
  for (const std::vector<float>& picture : pictures) EXPECT_EQ(picture, pictures[0]);
}

}  // namespace
}  // namespace freepath::testing
