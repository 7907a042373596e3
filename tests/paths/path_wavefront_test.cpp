// Jobs of a wavefront: done whole or not at all.

#include "freepath/paths/path_wavefront.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "tests/scene/volume_pictures.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr int kColumns = 16;
constexpr int kRows = 8;
constexpr PathJob kJob{.first_pixel = 16, .pixels = 64, .first_sample = 0, .samples = 3};

/// Everything that a path needs, in one place.
struct Stage {
  explicit Stage(const Rgb& sigma_s, const WalkSettings& walk = {})
      : scene(scene_of(Medium({Component{.density = make_field(Vec3i(-8), Vec3i(7), hash_noise),
                                         .sigma_a = Rgb(0.01F),
                                         .sigma_s = sigma_s,
                                         .phase = {}}}),
                       Camera({Vec3d(0, 0, 30), Vec3d(0), Vec3d(0, 1, 0), 30}, kColumns, kRows),
                       {Rgb(1.0F), Sun({.elevation = 50}, UpAxis::kY)})),
        factory(scene, ColorMode::kRgb, 3, walk) {
    setup.scene = &scene;
    setup.factory = &factory;
    setup.slots = 64;
    setup.first_set = kJob.first_sample;
    for (uint32_t set = 0; set < kJob.samples; ++set) {
      setup.colors.push_back(factory.colors_of_set(kJob.first_sample + set));
    }
  }

  PathScene scene;
  WavelengthSampler factory;
  PathSetup setup;
};

/// Of walks, those of jobs that were dropped count too.
void expect_same_paths(const PathCounts& a, const PathCounts& b) {
  EXPECT_EQ(a.paths, b.paths);
  EXPECT_EQ(a.overflows, b.overflows);
  EXPECT_EQ(a.cut_paths, b.cut_paths);
}

// A step of a nanometre makes 10^10 steps in a flight: the wish to stop reaches into it.
TEST(PathWavefront, IsStoppedWithinAFlight) {
  WalkSettings settings;
  settings.tracker = "ray-marching:step=1e-9";
  settings.interpolation = Interpolation::kNearest;
  const Stage stage(Rgb(0.5F), settings);
  PathWavefront wavefront(stage.setup);
  for (const int allowed : {1, 2, 5}) {
    Film film(kColumns, kRows);
    int questions = 0;
    EXPECT_FALSE(wavefront.trace(kJob, film, [&] { return ++questions > allowed; }));
    EXPECT_EQ(questions, allowed + 1);
    for (int pixel = 0; pixel < kColumns * kRows; ++pixel) EXPECT_EQ(film.samples(pixel), 0U);
  }
}

TEST(PathWavefront, AJobThatIsStoppedLeavesNothing) {
  // One path for all channels, and one for each.
  for (const Rgb& sigma_s : {Rgb(0.5F), Rgb(0.5F, 0.2F, 0.1F)}) {
    Stage stage(sigma_s);
    Film whole(kColumns, kRows);
    PathWavefront undisturbed(stage.setup);
    uint64_t questions = 0;
    ASSERT_TRUE(undisturbed.trace(kJob, whole, [&] { return ++questions, false; }));
    ASSERT_GT(questions, 10U);  // more than once a path: within paths

    PathWavefront wavefront(stage.setup);
    for (uint64_t allowed = 0; allowed < questions; ++allowed) {
      Film film(kColumns, kRows);
      uint64_t left = allowed;
      EXPECT_FALSE(wavefront.trace(kJob, film, [&] { return left-- == 0; })) << allowed;
      EXPECT_EQ(film.sample_counts().most, 0U);
    }
    expect_same_paths(wavefront.counts(), {});

    // And what was stopped is no burden to what follows.
    Film film(kColumns, kRows);
    EXPECT_TRUE(wavefront.trace(kJob, film));
    EXPECT_EQ(film.to_image().values, whole.to_image().values);
    expect_same_paths(wavefront.counts(), undisturbed.counts());
  }
}

TEST(PathWavefront, CountsThePathsOfFinishedJobs) {
  Stage stage(Rgb(0.5F));
  PathWavefront wavefront(stage.setup);
  Film film(kColumns, kRows);
  EXPECT_TRUE(wavefront.trace(kJob, film));
  EXPECT_EQ(wavefront.counts().paths, kJob.pixels * kJob.samples);
  EXPECT_TRUE(wavefront.trace({.first_pixel = 0, .pixels = 5, .samples = 1}, film));
  EXPECT_EQ(wavefront.counts().paths, kJob.pixels * kJob.samples + 5);
  EXPECT_EQ(film.sample_counts().most, 3U);
  EXPECT_EQ(film.sample_counts().fewest, 0U);
  EXPECT_EQ(film.sample_counts().pixels_without, kColumns * kRows - 5 - kJob.pixels);
}

}  // namespace
}  // namespace freepath::testing
