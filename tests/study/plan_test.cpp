#include "freepath/study/plan.h"

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "freepath/base/error.h"
#include "freepath/study/pixel_estimates.h"
#include "tests/counted_clock.h"
#include "tests/study/small_target.h"

namespace freepath {
namespace {

using testing::counted_clock;
using testing::small_target;

PilotCandidate candidate(const std::string& tracker) {
  PilotCandidate candidate;
  candidate.name = tracker;
  candidate.configuration.tracker = tracker;
  return candidate;
}

TEST(Pilots, TellWhatRefusesAndWhatIsBiased) {
  PilotCandidate march = candidate("ray-marching");
  march.configuration.interpolation = Interpolation::kTrilinear;
  const auto results =
      run_pilots(small_target(), {candidate("delta"), candidate("closed-form"), march}, {});
  EXPECT_TRUE(results[0].refusal.empty());
  EXPECT_TRUE(results[0].cost.has_value());
  EXPECT_NE(results[1].refusal.find("homogeneous"), std::string::npos) << results[1].refusal;
  EXPECT_FALSE(results[1].cost);
  EXPECT_TRUE(results[2].is_biased);
  EXPECT_EQ(cheapest(results), 0U);
}

// Look-ups of a path are a property of method and medium: those of a longer rendering agree.
TEST(Pilots, ForeseeLookupsAndNoise) {
  // Work is counted in look-ups of a microsecond each, whatever the machine does.
  RenderTarget target = small_target();
  uint64_t looked_up = 0;
  target.render = [render = target.render, &looked_up](const RenderSettings& settings,
                                                       const ProgressFunction& progress) {
    RenderResult result = render(settings, progress);
    looked_up += result.counts.statistics().lookups;
    return result;
  };
  PilotSettings pilots;
  pilots.render.threads = 1;
  pilots.render.clock = counted_clock();
  pilots.cpu_clock = [&looked_up] { return 1e-6 * static_cast<double>(looked_up); };
  const auto results = run_pilots(target, {candidate("delta"), candidate("decomposition")}, pilots);
  RenderSettings settings;
  settings.samples = 256;
  const RenderResult rendered = small_target().render(settings, {});
  const double lookups = static_cast<double>(rendered.counts.statistics().lookups) /
                         (256.0 * target.width * target.height);
  EXPECT_NEAR(results[0].lookups_per_path / lookups, 1, 0.03);
  EXPECT_LT(results[1].lookups_per_path, results[0].lookups_per_path);
  // Noise of that rendering, and the time foreseen to it.
  const PixelEstimates picture = estimates_of(rendered.film);
  const auto mean = [](const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  const double noise = std::sqrt(mean(picture.variance)) / mean(picture.mean);
  const double seconds = 1e-6 * static_cast<double>(rendered.counts.statistics().lookups);
  EXPECT_NEAR(results[0].seconds_to(noise)->value / seconds, 1, 0.1);
  EXPECT_NEAR(results[0].seconds_to(noise / 10)->value / results[0].seconds_to(noise)->value, 100,
              1e-6);
}

TEST(Pilots, CanTryOtherTargets) {
  const RenderTarget grey = small_target();
  const RenderTarget chromatic = small_target(true);
  PilotCandidate other = candidate("delta");
  other.target = &chromatic;
  const auto results = run_pilots(grey, {candidate("delta"), other}, {});
  EXPECT_NE(results[0].lookups_per_path, results[1].lookups_per_path);
}

TEST(Pilots, EndWhenTheyAreAsked) {
  EXPECT_THROW(run_pilots(small_target(), {candidate("delta")}, {}, [](double) { return false; }),
               Error);
}

}  // namespace
}  // namespace freepath
