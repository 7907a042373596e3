// Pictures that end before they are whole.

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <vector>

#include "freepath/paths/deadline.h"
#include "freepath/paths/renderer.h"
#include "tests/counted_clock.h"
#include "tests/paths/lumpy_cloud.h"

namespace freepath::testing {
namespace {

/// Time of a counted clock that passes between the end of a pass and that of the rendering.
constexpr double kAfterTheEnd = 50 * kCountedTick;

// Whatever a pass was broken off by: a pixel is as in a whole picture of as many samples.
void expect_pixels_of_whole_pictures(const Film& film, const Medium& medium, const Camera& camera) {
  const Image image = film.to_image();
  std::map<uint32_t, Image> whole;
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    const uint32_t samples = film.samples(pixel);
    if (samples > 0 && !whole.contains(samples)) {
      const RenderResult result = render(medium, camera, constant_light(1), settings_of(samples));
      whole.emplace(samples, result.film.to_image());
    }
    const std::size_t channels = image.channels.size();
    for (std::size_t value = pixel * channels; value < (pixel + 1) * channels; ++value) {
      ASSERT_EQ(image.values[value], samples > 0 ? whole.at(samples).values[value] : 0.0F)
          << "pixel " << pixel << " of " << samples << " samples";
    }
  }
}

TEST(Renderer, StopsWhenAskedTo) {
  const Medium medium({cloud(Rgb(0.1F), Rgb(9.0F), 0.8F)});
  const Camera camera = camera_for(medium, 64, 64);
  RenderSettings settings = settings_of(1 << 20);
  settings.clock = counted_clock();
  const RenderResult result =
      render(medium, camera, constant_light(1), settings,
             [](const RenderProgress& progress) { return progress.samples_done < 2; });
  EXPECT_TRUE(result.interrupted);
  EXPECT_LT(result.samples, 1U << 20);
  EXPECT_GE(result.samples, 1U);
  EXPECT_GE(result.most_samples, result.samples);
  EXPECT_EQ(result.pixels_without_samples, 0U);
  if (result.most_samples <= 1024) {
    expect_pixels_of_whole_pictures(result.film, medium, camera);
  }
}

TEST(Renderer, TimeEndsAPictureOfUnlimitedSamples) {
  const Medium medium({cloud(Rgb(0.1F), Rgb(9.0F), 0.8F)});
  const Camera camera = camera_for(medium, 16, 16);
  RenderSettings settings = settings_of(0);
  settings.time_limit = 0.5;
  settings.clock = counted_clock();
  const RenderResult result = render(medium, camera, constant_light(1), settings);
  EXPECT_FALSE(result.interrupted);
  EXPECT_GT(result.samples, 1U);
  EXPECT_LT(result.seconds, Deadline::later_pass_limit(0.5) + kAfterTheEnd);
}

/// A medium so thick that paths in it scatter tens of thousands of times; with gaps between lumps.
Medium thick_medium() { return Medium({cloud(Rgb(0.0F), Rgb(3e4F), 0)}); }

TEST(Renderer, TimeEndsAFirstPassThatWouldTakeLong) {
  const Medium medium = thick_medium();
  const Camera camera({Vec3d(0, 0, 9), Vec3d(0), Vec3d(0, 1, 0), 60}, 200, 200);
  std::vector<RenderResult> results;
  for (const int threads : {1, 2}) {
    RenderSettings settings = settings_of(0);
    settings.time_limit = 0.1;
    settings.clock = counted_clock();
    settings.threads = threads;
    results.push_back(render(medium, camera, constant_light(1), settings));
    const RenderResult& result = results.back();
    EXPECT_LT(result.seconds, Deadline::first_pass_limit(0.1) + kAfterTheEnd);
    EXPECT_FALSE(result.interrupted);
    EXPECT_EQ(result.samples, 0U);
    EXPECT_EQ(result.most_samples, 1U);
    EXPECT_EQ(result.pixels_without_samples, 200U * 200 - result.counts.paths);
  }
  // Pixels that both have reached are the same; those without a sample are 0.
  const Image images[] = {results[0].film.to_image(), results[1].film.to_image()};
  const std::size_t channels = images[0].channels.size();
  for (std::size_t i = 0; i < images[0].values.size(); ++i) {
    const bool reached[] = {results[0].film.samples(i / channels) > 0,
                            results[1].film.samples(i / channels) > 0};
    if (reached[0] && reached[1]) {
      ASSERT_EQ(images[0].values[i], images[1].values[i]) << i;
    } else {
      ASSERT_EQ(images[reached[0] ? 1 : 0].values[i], 0) << i;
    }
  }
}

TEST(Renderer, AWishToStopEndsAFirstPassThatWouldTakeLong) {
  const Medium medium = thick_medium();
  // In its midst, where no path ends.
  const Vec3d centre = medium.world_bounds().center();
  const Camera camera({centre, centre + Vec3d(1, 0, 0), Vec3d(0, 1, 0), 90}, 64, 64);
  RenderSettings settings = settings_of(1);
  settings.clock = counted_clock();
  const RenderResult result = render(medium, camera, constant_light(1), settings,
                                     [](const RenderProgress&) { return false; });
  EXPECT_TRUE(result.interrupted);
  EXPECT_LT(result.seconds, 1.2 + kAfterTheEnd);
  EXPECT_LT(result.most_samples, 2U);
  EXPECT_EQ(result.pixels_without_samples, 64U * 64 - result.counts.paths);
}

}  // namespace
}  // namespace freepath::testing
