#include "freepath/study/comparison.h"

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "freepath/report/page.h"
#include "freepath/study/comparison_report.h"
#include "tests/study/small_target.h"

namespace freepath {
namespace {

using testing::small_target;

std::vector<Configuration> trackers(const std::vector<std::string>& names) {
  std::vector<Configuration> configurations;
  for (const std::string& name : names) {
    Configuration configuration;
    configuration.tracker = name;
    configurations.push_back(configuration);
  }
  return configurations;
}

/// Equal samples, so that nothing but times depends on the machine.
ComparisonSettings settings_for(const std::vector<std::string>& names) {
  ComparisonSettings settings;
  settings.configurations = trackers(names);
  settings.time = 0;
  settings.samples = 128;
  settings.repeats = 4;
  settings.may_interpolate = true;
  settings.reference.time = 0;
  settings.reference.samples = 256;
  return settings;
}

const ConfigurationResult& result_of(const Comparison& comparison, const std::string& tracker) {
  for (const ConfigurationResult& result : comparison.configurations) {
    if (result.configuration.tracker == tracker) return result;
  }
  throw Error("no result of " + tracker);
}

// The issue's own criterion: unbiased methods pass at a family-wise level of a thousandth, a coarse
// march fails.
TEST(Comparison, TellsBiasedMethodsFromUnbiasedOnes) {
  const Comparison comparison =
      compare(small_target(),
              settings_for({"delta", "weighted-delta", "decomposition", "weighted-decomposition",
                            "spectral-decomposition", "ray-marching:step=24"}));
  for (const ConfigurationResult& result : comparison.configurations) {
    const bool march = result.configuration.tracker == "ray-marching:step=24";
    EXPECT_EQ(result.verdict, march ? BiasVerdict::kFails : BiasVerdict::kPasses)
        << result.name << ": " << result.bias.worst();
    EXPECT_EQ(result.is_biased, march);
  }
  EXPECT_EQ(comparison.tests, 6U * (3 + 3 * 12));
  const auto findings = findings_of(comparison);
  EXPECT_NE(findings.back().find("ray-marching:step=24"), std::string::npos) << findings.back();
}

TEST(Comparison, HoldsForChromaticMedia) {
  const Comparison comparison = compare(
      small_target(true), settings_for({"delta", "spectral", "spectral-decomposition",
                                        "hero-wavelength", "per-wavelength", "multi-volume"}));
  for (const ConfigurationResult& result : comparison.configurations) {
    EXPECT_EQ(result.verdict, BiasVerdict::kPasses) << result.name << ": " << result.bias.worst();
  }
}

// Of an unbiased method MSE is its variance, which its own samples tell too.
TEST(Comparison, StatesErrorsThatAgreeWithVariances) {
  ComparisonSettings settings = settings_for({"delta", "decomposition"});
  settings.repeats = 16;
  settings.samples = 256;
  settings.reference.samples = 128;  // would add an eighth, were its variance not taken off
  const Comparison comparison = compare(small_target(), settings);
  for (const ConfigurationResult& result : comparison.configurations) {
    const Interval mse = result.over_runs([](const ComparisonRun& run) { return run.error.mse; });
    const Interval variance = result.over_runs([](const ComparisonRun& run) {
      return (run.variance[0] + run.variance[1] + run.variance[2]) / 3;
    });
    EXPECT_NEAR(mse.value / variance.value, 1, 0.05) << result.name;
    EXPECT_LT(*mse.high - *mse.low, 0.2 * mse.value);
  }
}

TEST(Comparison, MeasuresTheSameAgainUpToTimes) {
  ComparisonSettings settings = settings_for({"delta", "weighted-delta"});
  const Comparison first = compare(small_target(), settings);
  settings.render.threads = 1;
  settings.render.batch = 512;
  const Comparison second = compare(small_target(), settings);
  settings.seed = 1;
  const Comparison other = compare(small_target(), settings);
  for (std::size_t i = 0; i < 2; ++i) {
    const ConfigurationResult& a = first.configurations[i];
    EXPECT_EQ(a.together.mean, second.configurations[i].together.mean);
    EXPECT_EQ(a.runs[3].error.mse, second.configurations[i].runs[3].error.mse);
    EXPECT_EQ(a.bias.block_z, second.configurations[i].bias.block_z);
    EXPECT_NE(a.together.mean, other.configurations[i].together.mean);
    EXPECT_NE(a.runs[0].error.mse, a.runs[1].error.mse);
  }
}

// What a cluster does: rounds that others have run, against references that another one has made.
TEST(Comparison, MergesRoundsIntoTheComparisonOfAll) {
  ComparisonSettings settings = settings_for({"delta", "weighted-delta"});
  const Comparison whole = compare(small_target(), settings);
  settings.references = references_of(small_target(), settings);
  EXPECT_EQ(settings.references[0].estimates.mean, whole.references[0].estimates.mean);
  std::vector<Comparison> rounds;
  for (int round = 0; round < settings.repeats; ++round) {
    settings.first_round = round;
    settings.end_round = round + 1;
    rounds.push_back(compare(small_target(), settings));
    EXPECT_EQ(rounds.back().configurations[0].runs.size(), 1U);
  }
  const Comparison merged = merge_rounds(rounds);
  EXPECT_EQ(merged.tests, whole.tests);
  EXPECT_EQ(merged.threshold, whole.threshold);
  for (std::size_t i = 0; i < 2; ++i) {
    const ConfigurationResult& a = whole.configurations[i];
    const ConfigurationResult& b = merged.configurations[i];
    EXPECT_EQ(a.together.mean, b.together.mean);
    EXPECT_EQ(a.together.variance, b.together.variance);
    EXPECT_EQ(a.flip, b.flip);
    EXPECT_EQ(a.bias.block_z, b.bias.block_z);
    ASSERT_EQ(b.runs.size(), 4U);
    for (std::size_t run = 0; run < 4; ++run) {
      EXPECT_EQ(a.runs[run].error.mse, b.runs[run].error.mse);
      EXPECT_EQ(a.runs[run].free_paths.lookups, b.runs[run].free_paths.lookups);
    }
    EXPECT_TRUE(b.efficiency->low.has_value());
  }
  settings.configurations = trackers({"delta"});
  rounds[3] = compare(small_target(), settings);
  EXPECT_THROW(merge_rounds(rounds), Error);
}

// Two experiments with other seeds: their intervals have to overlap. By look-ups, since seconds are
// the machine's.
TEST(Comparison, FindsEfficienciesAgain) {
  ComparisonSettings settings =
      settings_for({"delta", "weighted-delta:rate-scale=4", "per-wavelength"});
  const Comparison first = compare(small_target(), settings);
  settings.seed = 77;
  const Comparison second = compare(small_target(), settings);
  const auto lookups = [](const ComparisonRun& run) {
    return static_cast<double>(run.free_paths.lookups + run.shadow_rays.lookups);
  };
  const auto efficiency = [&](const Comparison& comparison, std::size_t i) {
    return *comparison.configurations[i].efficiency_over(comparison.configurations[0], lookups);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Interval a = efficiency(first, i);
    const Interval b = efficiency(second, i);
    EXPECT_LE(*a.low, *b.high) << first.configurations[i].name;
    EXPECT_LE(*b.low, *a.high) << first.configurations[i].name;
  }
  EXPECT_LT(*efficiency(first, 1).high, 0.5) << "four times the look-ups";
  EXPECT_DOUBLE_EQ(first.configurations[0].efficiency->value, 1);
}

TEST(Comparison, StatesEfficiencyByTimeOfTheProcessor) {
  const Comparison comparison =
      compare(small_target(), settings_for({"delta", "weighted-delta:rate-scale=4"}));
  const ConfigurationResult& result = comparison.configurations[1];
  std::vector<double> ratios;
  for (std::size_t i = 0; i < result.runs.size(); ++i) {
    const ComparisonRun& mine = result.runs[i];
    const ComparisonRun& theirs = comparison.configurations[0].runs[i];
    ratios.push_back(theirs.error.mse / mine.error.mse * (theirs.cpu_seconds / mine.cpu_seconds));
  }
  EXPECT_NEAR(result.efficiency->value, geometric_interval(ratios)->value, 1e-9);
}

// Four times the rate means about four times the look-ups in the same flights.
TEST(Comparison, CountsWork) {
  const Comparison comparison =
      compare(small_target(), settings_for({"delta", "weighted-delta:rate-scale=4"}));
  const auto lookups = [](const ComparisonRun& run) {
    return static_cast<double>(run.free_paths.lookups) / static_cast<double>(run.camera_samples);
  };
  const double tight = result_of(comparison, "delta").over_runs(lookups).value;
  const double loose =
      result_of(comparison, "weighted-delta:rate-scale=4").over_runs(lookups).value;
  EXPECT_NEAR(loose / tight, 4, 0.4);
  const ComparisonRun& run = comparison.configurations[0].runs[0];
  EXPECT_EQ(run.samples, 32U);
  EXPECT_EQ(run.camera_samples, 32U * 64 * 48);
  EXPECT_GT(run.seconds, 0);
  EXPECT_GT(run.cpu_seconds, 0);
  ASSERT_GE(run.convergence.size(), 2U);
  EXPECT_GT(run.convergence.front().mse, 2 * run.convergence.back().mse);
}

TEST(Comparison, RefusesWhatCannotRunBeforeItWorks) {
  ComparisonSettings settings = settings_for({"delta", "closed-form"});
  bool worked = false;
  try {
    compare(small_target(), settings, [&](const ComparisonProgress&) { return worked = true; });
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).rfind("closed-form: ", 0), 0U) << error.what();
  }
  EXPECT_FALSE(worked);
  settings = settings_for({"ray-marching"});
  settings.may_interpolate = false;
  EXPECT_THROW(compare(small_target(), settings), Error);
  settings = settings_for({});
  EXPECT_THROW(compare(small_target(), settings), Error);
}

TEST(Comparison, EndsWhenItIsAsked) {
  const ComparisonSettings settings = settings_for({"delta"});
  EXPECT_THROW(
      compare(small_target(), settings,
              [](const ComparisonProgress& progress) { return progress.step == "reference"; }),
      Interrupted);
}

class ReferenceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = std::filesystem::path(::testing::TempDir()) / "freepath_reference_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Reference get(const RenderTarget& target, const ReferencePlan& plan) const {
    return get_reference(target, plan, {}, {}, {});
  }

  std::filesystem::path folder_;
};

TEST_F(ReferenceTest, IsKeptAndFoundByItsContent) {
  ReferencePlan plan{.file = {}, .time = 0, .samples = 8, .cache = folder_ / "kept"};
  const Reference made = get(small_target(), plan);
  EXPECT_EQ(made.origin.rfind("made with delta", 0), 0U) << made.origin;
  const Reference found = get(small_target(), plan);
  EXPECT_EQ(found.origin.rfind("found in", 0), 0U) << found.origin;
  EXPECT_EQ(found.estimates.mean, made.estimates.mean);
  EXPECT_EQ(found.estimates.variance, made.estimates.variance);
  // Another target, another budget, another size: another reference.
  EXPECT_EQ(get(small_target(true), plan).origin.rfind("made", 0), 0U);
  EXPECT_EQ(get(small_target(false, 32, 24), plan).origin.rfind("made", 0), 0U);
  plan.samples = 9;
  EXPECT_EQ(get(small_target(), plan).origin.rfind("made", 0), 0U);
}

TEST_F(ReferenceTest, OfAnotherSizeIsRefused) {
  const std::string file = folder_ / "reference.exr";
  const ReferencePlan plan{.file = {}, .time = 0, .samples = 2, .cache = {}};
  write_exr(file, to_image(get(small_target(), plan).estimates));
  ReferencePlan given;
  given.file = file;
  EXPECT_EQ(get(small_target(), given).origin, file);
  try {
    get(small_target(false, 32, 24), given);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("--size 64x48"), std::string::npos) << error.what();
  }
}

TEST_F(ReferenceTest, WithoutVarianceIsToldOf) {
  const std::string file = folder_ / "reference.exr";
  const ReferencePlan plan{.file = {}, .time = 0, .samples = 64, .cache = {}};
  Image image = to_image(get(small_target(), plan).estimates);
  Image colour{.width = image.width, .height = image.height, .channels = {"R", "G", "B"}};
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    const float* const values = image.values.data() + pixel * image.channels.size();
    colour.values.insert(colour.values.end(), values, values + 3);
  }
  write_exr(file, colour);
  ComparisonSettings settings = settings_for({"delta"});
  settings.samples = 8;
  settings.reference.file = file;
  const Comparison comparison = compare(small_target(), settings);
  EXPECT_FALSE(comparison.references[0].variance_known);
  EXPECT_NE(findings_of(comparison).back().find("variance is not known"), std::string::npos);
}

// Numbers are the same in all forms.
TEST(ComparisonReport, SaysTheSameInAllForms) {
  ComparisonSettings settings = settings_for({"delta", "weighted-delta:rate-scale=2,roulette=0"});
  settings.configurations[1].tracker = "weighted-delta:rate-scale=2";
  settings.samples = 16;
  const Comparison comparison = compare(small_target(), settings);
  const ReportContext context{.target = "ball <1>",
                              .command = "freepath compare ball.vdb",
                              .machine = "a machine",
                              .date = "2026-11-22"};
  const auto json = nlohmann::json::parse(json_of(comparison, context));
  ASSERT_EQ(json["configurations"].size(), 2U);
  const auto& second = json["configurations"][1];
  EXPECT_EQ(second["tracker"], "weighted-delta:rate-scale=2");
  EXPECT_EQ(second["runs"].size(), 4U);
  EXPECT_DOUBLE_EQ(second["efficiency"]["value"], comparison.configurations[1].efficiency->value);
  std::istringstream csv(csv_of(comparison));
  std::string header;
  std::string row;
  std::getline(csv, header);
  std::getline(csv, row);
  const auto count = [](const std::string& text) {
    return std::count(text.begin(), text.end(), ',');
  };
  EXPECT_EQ(count(header), count(row));
  EXPECT_EQ(row.rfind("delta,delta,ratio,stochastic,1,", 0), 0U) << row;
  const std::string html = to_html(page_of(comparison, context));
  EXPECT_NE(html.find("Estimators on ball &lt;1&gt;"), std::string::npos);
  EXPECT_NE(html.find("freepath compare ball.vdb"), std::string::npos);
  for (const char* file : {"efficiency.svg", "convergence.svg", "mse.svg"}) {
    EXPECT_NE(html.find(file), std::string::npos) << file;
  }
}

}  // namespace
}  // namespace freepath
