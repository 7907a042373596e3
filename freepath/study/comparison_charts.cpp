#include "freepath/study/comparison_charts.h"

#include <algorithm>
#include <bit>
#include <map>

#include "freepath/report/chart.h"
#include "freepath/study/comparison_figures.h"

namespace freepath {
namespace {

ChartBar bar_of(const std::string& name, const Interval& interval) {
  return {.name = name, .value = interval.value, .low = interval.low, .high = interval.high};
}

/// The best bar of those methods that are to be trusted stands out.
void mark_best(const Comparison& comparison, std::vector<ChartBar>& bars, bool larger_is_better) {
  ChartBar* best = nullptr;
  for (ChartBar& bar : bars) {
    const auto& all = comparison.configurations;
    const auto result = std::find_if(all.begin(), all.end(), [&](const ConfigurationResult& one) {
      return one.name == bar.name;
    });
    if (!result->is_trusted()) continue;
    const bool better =
        best == nullptr || (larger_is_better ? bar.value > best->value : bar.value < best->value);
    if (better) best = &bar;
  }
  if (best != nullptr) best->is_best = true;
}

NamedFigure efficiency_chart(const Comparison& comparison) {
  BarChart chart{.title = "Efficiency",
                 .axis = {.label = "1/(MSE · CPU time) over that of " +
                                   comparison.configurations[comparison.baseline].name,
                          .minimum = 0},
                 .bars = {},
                 .mark_at = 1};
  for (const ConfigurationResult& result : comparison.configurations) {
    if (result.efficiency) chart.bars.push_back(bar_of(result.name, *result.efficiency));
  }
  mark_best(comparison, chart.bars, true);
  return {"efficiency.svg", "How much sooner a method reaches the same error.", to_svg(chart)};
}

NamedFigure bars_of(const Comparison& comparison, std::string_view key, const std::string& title,
                    const std::string& label, const std::string& caption) {
  const auto& figures = comparison_figures();
  const auto figure = std::find_if(figures.begin(), figures.end(),
                                   [&](const auto& candidate) { return candidate.key == key; });
  BarChart chart{.title = title, .axis = {.label = label, .minimum = 0}, .bars = {}};
  for (const ConfigurationResult& result : comparison.configurations) {
    chart.bars.push_back(bar_of(result.name, result.over_runs(figure->of_run)));
  }
  mark_best(comparison, chart.bars, false);
  return {std::string(key) + ".svg", caption, to_svg(chart)};
}

/// Points of all runs, together where they have about as many samples.
ChartSeries convergence_of(const ConfigurationResult& result) {
  struct Bin {
    std::vector<double> seconds, errors;
  };
  std::map<int, Bin> bins;
  for (const ComparisonRun& run : result.runs) {
    for (const ConvergencePoint& point : run.convergence) {
      if (!(point.mse > 0) || !(point.seconds > 0)) continue;
      Bin& bin = bins[std::bit_width(point.samples)];
      bin.seconds.push_back(point.seconds);
      bin.errors.push_back(point.mse);
    }
  }
  ChartSeries series{.name = result.name, .x = {}, .y = {}};
  for (const auto& [doublings, bin] : bins) {
    const auto seconds = geometric_interval(bin.seconds);
    const auto error = geometric_interval(bin.errors);
    series.x.push_back(seconds->value);
    series.y.push_back(error->value);
    const auto [low, high] = std::minmax_element(bin.errors.begin(), bin.errors.end());
    series.low.push_back(*low);
    series.high.push_back(*high);
  }
  series.mark = ChartMark::kBoth;
  return series;
}

/// A line of slope -1, as unbiased methods have with time, through the baseline's first point.
ChartSeries ideal_slope(const ChartSeries& baseline, const std::vector<ChartSeries>& all) {
  ChartSeries line{.name = "1/time", .x = {}, .y = {}};
  line.is_reference = true;
  if (baseline.x.empty()) return line;
  double last = 0;
  for (const ChartSeries& series : all) {
    if (!series.x.empty()) last = std::max(last, series.x.back());
  }
  for (const double x : {baseline.x.front(), last}) {
    line.x.push_back(x);
    line.y.push_back(baseline.y.front() * baseline.x.front() / x);
  }
  return line;
}

NamedFigure convergence_chart(const Comparison& comparison) {
  Chart chart{.title = "Convergence",
              .x = {.label = "time of a run [s]", .logarithmic = true},
              .y = {.label = "MSE", .logarithmic = true},
              .series = {},
              .width = 1120,
              .height = 400};
  for (const ConfigurationResult& result : comparison.configurations) {
    chart.series.push_back(convergence_of(result));
  }
  chart.series.push_back(ideal_slope(chart.series[comparison.baseline], chart.series));
  return {"convergence.svg",
          "Error against time: means of all runs, and the range that they cover. A method that "
          "is biased levels off.",
          to_svg(chart), true};
}

}  // namespace

std::vector<NamedFigure> figures_of(const Comparison& comparison) {
  return {efficiency_chart(comparison),
          bars_of(comparison, "mse", "Error", "MSE of a run",
                  "Mean squared error of a run, less the reference's variance."),
          convergence_chart(comparison),
          bars_of(comparison, "lookups_per_path", "Look-ups", "look-ups of a path",
                  "Densities read for a path with its shadow rays."),
          bars_of(comparison, "nanoseconds_per_lookup", "Cost of a look-up", "CPU time [ns]",
                  "CPU time over look-ups: all that a path costs besides is in it.")};
}

}  // namespace freepath
