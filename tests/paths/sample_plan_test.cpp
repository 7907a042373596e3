#include "freepath/paths/sample_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/paths/lumpy_cloud.h"
#include "tests/scene/volume_pictures.h"
#include "tests/statistics.h"

namespace freepath::testing {
namespace {

double mean_share(const std::vector<SampleShare>& shares) {
  double sum = 0;
  for (const SampleShare share : shares) sum += share.value();
  return sum / static_cast<double>(shares.size());
}

/// A pilot's film whose left half has noise of one deviation and its right one of another.
Film pilot_of_halves(float left, float right, float lookups_at_right = 0) {
  Film film(32, 20);
  for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
    const bool is_right = pixel % 32 >= 16;
    const float deviation = is_right ? right : left;
    for (int i = 0; i < 4; ++i) {
      const float value = 8 + (i % 2 == 0 ? deviation : -deviation);
      film.add(pixel,
               {.radiance = {value, value, value}, .lookups = is_right ? lookups_at_right : 0});
    }
  }
  return film;
}

TEST(SamplePlan, SharesGrowWithTheRootOfTheDeviation) {
  const std::vector<SampleShare> shares = shares_of_pilot(pilot_of_halves(1, 4));
  EXPECT_NEAR(mean_share(shares), 1, 0.03);
  // Twice as many, to a step, but for what the border smooths.
  EXPECT_NEAR(shares[31].value() / shares[0].value(), 2, 0.3);
  EXPECT_GT(shares[16].value(), shares[15].value() - 1e-9);
}

TEST(SamplePlan, SharesFallWithTheTimeOfSamples) {
  // 160 look-ups and a constant of 10 take 17 times as long; shares fall with the fourth root.
  const std::vector<SampleShare> shares = shares_of_pilot(pilot_of_halves(1, 1, 160));
  EXPECT_NEAR(mean_share(shares), 1, 0.03);
  EXPECT_NEAR(shares[0].value() / shares[31].value(), std::pow(17, 0.25), 0.4);
}

TEST(SamplePlan, WithoutNoiseAllSharesAreOne) {
  for (const SampleShare share : shares_of_pilot(pilot_of_halves(0, 0))) {
    EXPECT_TRUE(share.is_one());
  }
}

TEST(SamplePlan, QuietPixelsKeepAQuarter) {
  const std::vector<SampleShare> shares = shares_of_pilot(pilot_of_halves(0, 1));
  EXPECT_EQ(shares[0].value(), 0.25);
  EXPECT_NEAR(mean_share(shares), 1, 0.03);
}

TEST(SamplePlan, AGridCoversThePicture) {
  for (const auto& [width, height] : {std::pair{1, 1}, {90, 90}, {192, 108}, {4096, 2160}}) {
    const PilotGrid grid = PilotGrid::over(width, height);
    EXPECT_LE(int64_t{grid.width} * grid.height, PilotGrid::kMostSquares);
    EXPECT_GE(grid.width * grid.edge, width);
    EXPECT_GE(grid.height * grid.edge, height);
    EXPECT_LT((grid.width - 1) * grid.edge, width);
    EXPECT_LT((grid.height - 1) * grid.edge, height);
  }
}

/// A thin cloud in the middle of the picture, and nothing around it.
struct SmallCloud {
  Medium medium{{cloud(Rgb(0.9F), Rgb(4.0F), 0.3F)}};
  PathScene scene = scene_of(medium, camera_for(medium, 40, 12), constant_light(1));
  RenderSettings settings;

  SmallCloud() {
    settings.layers = {};
    settings.adaptive = true;
  }
  Film render(uint32_t samples) {
    settings.samples = samples;
    return render_scene(scene, ColorMode::kRgb, settings).film;
  }
};

TEST(SamplePlan, PixelsHaveTheirSharesOfTheSamples) {
  SmallCloud cloud;
  const Film film = cloud.render(24);
  EXPECT_TRUE(film.has_shares());
  double sum = 0;
  for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
    EXPECT_EQ(film.samples(pixel), film.share(pixel).samples(24));
    EXPECT_EQ(film.rounds(pixel), 24U);
    sum += film.samples(pixel);
  }
  EXPECT_NEAR(sum / static_cast<double>(film.pixel_count()), 24, 1.5);
  EXPECT_LT(film.samples(0), film.samples(6 * 40 + 20));
}

// What has a sample, a part or more samples at first costs nothing: all bits are the same.
TEST(SamplePlan, SamplesAreThoseOfUniformPictures) {
  SmallCloud cloud;
  const Film film = cloud.render(16);
  cloud.settings.adaptive = false;
  for (std::size_t pixel = 0; pixel < film.pixel_count(); pixel += 7) {
    const std::size_t column = pixel % 40;
    const std::size_t row = pixel / 40;
    const auto x = static_cast<double>(column);
    const auto y = static_cast<double>(row);
    cloud.settings.crop = Crop{x, y, x + 1, y + 1};
    const Film alone = cloud.render(film.samples(pixel));
    EXPECT_EQ(film.mean(pixel, 1), alone.mean(0, 1));
    EXPECT_EQ(film.variance(pixel, 1), alone.variance(0, 1));
  }
}

TEST(SamplePlan, CropsHaveTheSharesOfTheWhole) {
  SmallCloud cloud;
  const Film whole = cloud.render(8);
  cloud.settings.crop = Crop{13, 3, 31, 9};
  const Film part = cloud.render(8);
  for (int y = 0; y < part.height(); ++y) {
    for (int x = 0; x < part.width(); ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * part.width() + x;
      const std::size_t of_whole = static_cast<std::size_t>(y + 3) * 40 + x + 13;
      EXPECT_EQ(part.share(pixel), whole.share(of_whole));
      EXPECT_EQ(part.mean(pixel, 0), whole.mean(of_whole, 0));
    }
  }
}

// The pictures' mean over many seeds is that of uniform ones: a plan by the samples that it weighs
// would drop those pixels early that have missed their light.
TEST(SamplePlan, PicturesStayWithoutBias) {
  SmallCloud cloud;
  cloud.settings.adaptive = false;
  cloud.settings.walk.seed = 1'000'000;
  const Film truth = cloud.render(40'000);
  cloud.settings.adaptive = true;
  RunningStatistics inside;
  RunningStatistics all;
  double expected_inside = 0;
  double expected = 0;
  for (int seed = 0; seed < 400; ++seed) {
    cloud.settings.walk.seed = static_cast<uint64_t>(seed);
    const Film film = cloud.render(8);
    double sum = 0;
    for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) sum += film.mean(pixel, 0);
    all.add(sum);
    inside.add(film.mean(6 * 40 + 20, 0));
  }
  for (std::size_t i = 0; i < truth.pixel_count(); ++i) expected += truth.mean(i, 0);
  expected_inside = truth.mean(6 * 40 + 20, 0);
  EXPECT_TRUE(check_mean("all pixels", all, expected, {.z = 4}));
  EXPECT_TRUE(check_mean("one pixel", inside, expected_inside, {.z = 4}));
}

// Fewer look-ups and samples, the time of any machine, for the same error.
TEST(SamplePlan, ErrorsFallFasterThanThoseOfUniformPictures) {
  SmallCloud cloud;
  const auto cost_of_error = [&](bool adaptive) {
    cloud.settings.adaptive = adaptive;
    double squares = 0;
    double cost = 0;
    const Film film = cloud.render(400);
    for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
      squares += film.variance(pixel, 0);
      cost += film.samples(pixel) * (10 + film.mean_lookups(pixel));
    }
    return squares * cost;
  };
  EXPECT_LT(cost_of_error(true), 0.8 * cost_of_error(false));
}

}  // namespace
}  // namespace freepath::testing
