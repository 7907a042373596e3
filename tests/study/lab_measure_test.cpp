// Every tracker in every setting, the evolution of weights, and their independence of threads.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/study/interval.h"
#include "freepath/study/lab.h"
#include "freepath/transport/walker.h"

namespace freepath::testing {
namespace {

std::string tell(const LabMeasurement& measurement) {
  std::string text = measurement.tracker;
  for (const LabCheck& check : checks_of(measurement)) {
    text += "\n  " + std::to_string(check.estimate) + " +- " +
            std::to_string(check.standard_error) + ", exact " + std::to_string(check.exact) +
            ", p " + std::to_string(check.p);
  }
  return text;
}

class LabTrackers : public ::testing::TestWithParam<Absorption> {};

// The family-wise level of the laboratory itself: all trackers, settings, channels together.
TEST_P(LabTrackers, AllThatAreUnbiasedAgreeWithTheExactCurves) {
  LabOptions options;
  options.paths = 100'000;
  options.seed = 20170720;
  options.absorption = GetParam();
  const std::size_t settings = lab_setting_infos().size();
  std::size_t tests = 0;
  std::vector<std::pair<std::string, LabMeasurement>> measured;
  for (const LabSettingInfo& info : lab_setting_infos()) {
    const LabSetting setting = make_lab_setting(info.name);
    const LabCurves curves(setting);
    for (const std::string& tracker : lab_trackers(setting)) {
      const bool slow = tracker == "regular";
      const LabWalk walk{tracker, options.absorption, options.seed + measured.size(),
                         slow ? options.paths / 4 : options.paths};
      measured.emplace_back(info.name, measure_tracker(setting, curves, walk));
      tests += checks_of(measured.back().second).size();
    }
  }
  const double level = level_of_each(kLabLevel, tests);
  std::size_t refused = 0;
  std::size_t biased = 0;
  for (const auto& [setting, measurement] : measured) {
    const LabVerdict verdict = verdict_of(measurement, level);
    if (verdict == LabVerdict::kRefuses) {
      EXPECT_EQ(measurement.tracker, "closed-form") << measurement.refusal;
      ++refused;
    } else if (measurement.biased) {
      // Its steps see nothing of a density that is the same everywhere.
      EXPECT_EQ(verdict == LabVerdict::kDiffers, setting != "homogeneous")
          << setting << ": " << tell(measurement);
      ++biased;
    } else {
      EXPECT_EQ(verdict, LabVerdict::kAgrees) << setting << ": " << tell(measurement);
      EXPECT_EQ(measurement.statistics.bound_violations, 0U) << setting << measurement.tracker;
    }
  }
  EXPECT_EQ(refused, settings - 1);
  EXPECT_EQ(biased, settings);
}

INSTANTIATE_TEST_SUITE_P(Both, LabTrackers,
                         ::testing::Values(Absorption::kWeighted, Absorption::kAnalog),
                         [](const auto& test) {
                           return test.param == Absorption::kAnalog ? "Analog" : "Weighted";
                         });

TEST(LabTrackersList, HasTheWholeRegistry) {
  const std::vector<std::string> trackers = lab_trackers(make_lab_setting("ramp"));
  for (const MethodInfo& info : tracker_infos()) {
    const bool found = std::any_of(trackers.begin(), trackers.end(), [&](const auto& tracker) {
      return tracker.substr(0, tracker.find(':')) == info.name;
    });
    EXPECT_TRUE(found) << info.name;
  }
}

// Steps of a tenth of the ray jump over most of the spike.
TEST(LabMeasure, CoarseRayMarchingFails) {
  const LabSetting setting = make_lab_setting("spike");
  const LabMeasurement measurement = measure_tracker(
      setting, LabCurves(setting), {"ray-marching:step=0.1", Absorption::kAnalog, 1, 20'000});
  EXPECT_TRUE(measurement.biased);
  EXPECT_EQ(verdict_of(measurement, 1e-9), LabVerdict::kDiffers) << tell(measurement);
}

// The mean weight at each cut is the transmittance, and after n scatterings the albedo's n-th
// power, whatever carries all channels.
TEST(LabThroughputs, MeanWeightsAreExact) {
  const LabSetting setting = make_lab_setting("chromatic-ramp");
  const LabCurves curves(setting);
  const double albedo[] = {0.95, 0.98, 0.9};
  const double level = level_of_each(1e-3, 1000);  // three trackers, some hundred means each
  std::size_t tested = 0;
  for (const char* tracker : {"spectral", "spectral:collision-probability=history-max",
                              "spectral-decomposition", "hero-wavelength"}) {
    const LabWalk walk{tracker, Absorption::kWeighted, 5, 60'000};
    const LabThroughput along = throughput_along_ray(setting, curves, walk);
    const LabThroughput scattered = throughput_of_scatterings(setting, curves, walk);
    ASSERT_EQ(along.stages.size(), std::size_t{kLabCuts + 1});
    ASSERT_EQ(scattered.stages.size(), std::size_t{kLabScatterings + 1});
    for (const auto* throughput : {&along, &scattered}) {
      for (const LabStage& stage : throughput->stages) {
        for (int channel = 0; channel < 3; ++channel) {
          const LabWeights& weights = stage.channels[channel];
          const double exact = throughput == &along ? curves.transmittance(stage.at, channel)
                                                    : std::pow(albedo[channel], stage.at);
          EXPECT_NEAR(weights.exact / exact, 1, 1e-5);
          EXPECT_LE(weights.low, weights.median);
          EXPECT_LE(weights.median, weights.high);
          EXPECT_LE(weights.high, weights.largest);
          if (weights.standing != LabStanding::kTested) continue;
          ++tested;
          const double off = std::abs(weights.mean - exact) - 1e-4 * exact;  // rounding, summed
          EXPECT_GT(normal_two_sided_p(std::max(0.0, off) / (weights.standard_error + 1e-30)),
                    level)
              << tracker << " at " << stage.at << ", channel " << channel;
        }
      }
    }
  }
  EXPECT_GT(tested, 500U);
}

// What the history of a path is looked at for [Kutz17, Sec. 4.2.3].
TEST(LabThroughputs, HistoryKeepsWeightsBounded) {
  const LabSetting setting = make_lab_setting("chromatic-ramp");
  const LabCurves curves(setting);
  const auto largest = [&](const char* tracker) {
    const LabWalk walk{tracker, Absorption::kWeighted, 5, 8192};
    double weight = 0;
    for (const LabStage& stage : throughput_of_scatterings(setting, curves, walk).stages) {
      for (const LabWeights& weights : stage.channels) weight = std::max(weight, weights.largest);
    }
    return weight;
  };
  EXPECT_LE(largest("spectral"), 3.0001);  // the number of channels, for the mean is at most 1
  EXPECT_GT(largest("spectral:collision-probability=max"), 100);
}

TEST(LabThroughputs, TrackersOfOneChannelAreRefused) {
  const LabSetting setting = make_lab_setting("chromatic-ramp");
  EXPECT_THROW(
      throughput_along_ray(setting, LabCurves(setting), {"delta", Absorption::kWeighted, 0, 1000}),
      Error);
}

TEST(Lab, DoesNotDependOnThreads) {
  const auto run = [](int threads) {
    LabOptions options;
    options.settings = {"chromatic-spike"};
    options.trackers = {"spectral:rate-scale=0.8", "decomposition"};
    options.paths = 70'000;
    options.threads = threads;
    return run_lab(options);
  };
  const LabResult one = run(1);
  const LabResult three = run(3);
  ASSERT_EQ(one.settings.size(), 1U);
  const LabFindings& a = one.settings[0];
  const LabFindings& b = three.settings[0];
  ASSERT_EQ(a.trackers.size(), b.trackers.size());
  for (std::size_t i = 0; i < a.trackers.size(); ++i) {
    EXPECT_EQ(a.trackers[i].variance, b.trackers[i].variance);
    EXPECT_EQ(a.trackers[i].statistics.largest_weight, b.trackers[i].statistics.largest_weight);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      EXPECT_EQ(a.trackers[i].channels[channel].scattered,
                b.trackers[i].channels[channel].scattered);
      EXPECT_EQ(a.trackers[i].channels[channel].weights, b.trackers[i].channels[channel].weights);
    }
  }
  ASSERT_EQ(a.scatterings.size(), 1U);
  for (std::size_t i = 0; i < a.scatterings[0].stages.size(); ++i) {
    EXPECT_EQ(a.scatterings[0].stages[i].channels[1].mean,
              b.scatterings[0].stages[i].channels[1].mean);
  }
  ASSERT_EQ(a.sweeps.size(), b.sweeps.size());
  for (std::size_t i = 0; i < a.sweeps.size(); ++i) {
    EXPECT_EQ(a.sweeps[i].points[3].variance, b.sweeps[i].points[3].variance);
  }
}

TEST(Lab, StopsWhereProgressSaysSo) {
  int calls = 0;
  const auto stop = [&](double, std::string_view) { return ++calls < 5; };
  EXPECT_THROW(run_lab({.settings = {"ramp"}, .trackers = {}, .paths = 2000}, stop), Error);
  EXPECT_EQ(calls, 5);
}

TEST(Lab, RefusesWhatItDoesNotKnow) {
  EXPECT_THROW(run_lab({.settings = {"rampe"}, .trackers = {}}), Error);
  EXPECT_THROW(run_lab({.settings = {"ramp"}, .trackers = {"deltas"}}), Error);
}

}  // namespace
}  // namespace freepath::testing
