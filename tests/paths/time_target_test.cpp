#include "freepath/paths/time_target.h"

#include <gtest/gtest.h>

#include "tests/counted_clock.h"
#include "tests/paths/lumpy_cloud.h"
#include "tests/scene/volume_pictures.h"

namespace freepath::testing {
namespace {

// By a clock that counts how often it is asked, which is as often as there is work.
TEST(TimeTarget, SamplesFillTheTime) {
  const Medium medium({cloud(Rgb(0.5F), Rgb(5.0F), 0)});
  const PathScene scene = scene_of(medium, camera_for(medium, 64, 48), constant_light(1));
  RenderSettings settings;
  settings.threads = 1;
  settings.samples = 0;
  settings.time_limit = 100;
  settings.clock = counted_clock(0.01);
  const TimePlan plan = plan_time(scene, ColorMode::kRgb, settings);
  ASSERT_GT(plan.samples, 1U);
  EXPECT_LT(plan.seconds, 8);
  settings.samples = plan.samples;
  settings.time_limit = 0;
  settings.clock = counted_clock(0.01);
  const RenderResult result = render_scene(scene, ColorMode::kRgb, settings);
  EXPECT_EQ(result.samples, plan.samples);
  // Flights, which this clock counts, are not as even as time is.
  EXPECT_GT(plan.seconds + result.seconds, 70);
  EXPECT_LT(plan.seconds + result.seconds, 105);
}

// The decision is not that of the picture's samples: they may cost what they like.
TEST(TimeTarget, IsKnownForLongTimesAlone) {
  const Medium medium({cloud(Rgb(0.5F), Rgb(5.0F), 0)});
  const PathScene scene = scene_of(medium, camera_for(medium, 16, 12), constant_light(1));
  RenderSettings settings;
  settings.samples = 7;
  settings.time_limit = 19;
  EXPECT_EQ(plan_time(scene, ColorMode::kRgb, settings).samples, 0U);
  settings.time_limit = 1e6;
  settings.clock = counted_clock(100);
  EXPECT_EQ(plan_time(scene, ColorMode::kRgb, settings).samples, 7U) << "the most that are wished";
}

}  // namespace
}  // namespace freepath::testing
