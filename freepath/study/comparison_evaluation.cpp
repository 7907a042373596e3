#include "freepath/study/comparison_evaluation.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "freepath/base/error.h"

namespace freepath {

void evaluate(Comparison& comparison) {
  comparison.tests = 0;
  for (std::size_t which = 0; which < comparison.configurations.size(); ++which) {
    ConfigurationResult& result = comparison.configurations[which];
    result.bias = test_bias(result.together, comparison.reference(which).estimates);
    comparison.tests += result.bias.tests();
  }
  comparison.threshold = family_wise_threshold(comparison.level, comparison.tests);
  const ConfigurationResult& baseline = comparison.configurations[comparison.baseline];
  for (ConfigurationResult& result : comparison.configurations) {
    result.verdict = result.bias.verdict(comparison.threshold);
    result.efficiency =
        result.efficiency_over(baseline, [](const ComparisonRun& run) { return run.cpu_seconds; });
  }
}

Comparison merge_rounds(std::vector<Comparison> rounds) {
  if (rounds.empty()) fail("nothing to merge: there are no rounds");
  Comparison all = std::move(rounds.front());
  for (std::size_t i = 1; i < rounds.size(); ++i) {
    Comparison& round = rounds[i];
    const auto is_same = [](const ConfigurationResult& a, const ConfigurationResult& b) {
      return a.configuration == b.configuration;
    };
    if (!std::equal(all.configurations.begin(), all.configurations.end(),
                    round.configurations.begin(), round.configurations.end(), is_same)) {
      fail("rounds of other methods can't be merged");
    }
    for (std::size_t which = 0; which < all.configurations.size(); ++which) {
      ConfigurationResult& to = all.configurations[which];
      ConfigurationResult& from = round.configurations[which];
      to.together = merged({&to.together, &from.together});
      std::move(from.runs.begin(), from.runs.end(), std::back_inserter(to.runs));
    }
    all.seconds += round.seconds;
  }
  evaluate(all);
  return all;
}

bool ConfigurationResult::has_overflows() const {
  return std::any_of(runs.begin(), runs.end(),
                     [](const ComparisonRun& run) { return run.overflows > 0; });
}

bool ConfigurationResult::is_trusted() const {
  return verdict != BiasVerdict::kFails && !bias.is_heavy_tailed && !is_biased && !has_overflows();
}

std::optional<Interval> ConfigurationResult::efficiency_over(
    const ConfigurationResult& baseline,
    const std::function<double(const ComparisonRun&)>& cost) const {
  std::vector<double> ratios;
  for (std::size_t repeat = 0; repeat < runs.size(); ++repeat) {
    const ComparisonRun& mine = runs[repeat];
    const ComparisonRun& theirs = baseline.runs[repeat];
    const bool positive = mine.error.mse > 0 && theirs.error.mse > 0;
    ratios.push_back(positive ? theirs.error.mse * cost(theirs) / (mine.error.mse * cost(mine))
                              : 0);
  }
  return geometric_interval(ratios);
}

Interval ConfigurationResult::over_runs(
    const std::function<double(const ComparisonRun&)>& figure) const {
  std::vector<double> values;
  for (const ComparisonRun& run : runs) values.push_back(figure(run));
  return mean_interval(values);
}

}  // namespace freepath
