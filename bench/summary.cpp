#include "summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace freepath::bench {
namespace {

/// Standard errors; with some tens of comparisons one chance in ten thousand.
constexpr double kLargestDifference = 4.5;

struct Mean {
  double value;
  double variance;  ///< Of the mean.
};

Mean mean(double sum, double sum_squared, double count) {
  const double value = sum / count;
  return {value, (sum_squared / count - value * value) / (count - 1)};
}

bool agree(const Table& table, std::size_t row, const char* what, const Mean& a, const Mean& b) {
  const double error = std::sqrt(a.variance + b.variance);
  if (std::abs(a.value - b.value) <= kLargestDifference * error) return true;
  fmt::print(stderr, "{}: '{}' and '{}' differ: {} {:.5g} and {:.5g}, standard error {:.2g}\n",
             table.title, table.rows[0], table.rows[row], what, a.value, b.value, error);
  return false;
}

}  // namespace

void KeepingReporter::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    const auto counter = run.counters.find(kTimeCounter);
    if (run.run_type != Run::RT_Iteration || counter == run.counters.end()) continue;
    times_[run.run_name.function_name].push_back(counter->second.value);
  }
  // The console shows a median for the repetitions, where there are any.
  std::vector<Run> shown;
  for (const Run& run : runs) {
    if (run.aggregate_name == "median" || run.repetitions < 2) shown.push_back(run);
  }
  if (!shown.empty()) benchmark::ConsoleReporter::ReportRuns(shown);
}

double KeepingReporter::median(const std::string& name) const {
  const auto found = times_.find(name);
  if (found == times_.end()) return 0;
  std::vector<double> times = found->second;
  std::sort(times.begin(), times.end());
  const std::size_t middle = times.size() / 2;
  return times.size() % 2 == 1 ? times[middle] : (times[middle - 1] + times[middle]) / 2;
}

void print(const Table& table, const KeepingReporter& reporter) {
  const double first = reporter.median(table.benchmarks[0]);
  fmt::print("\n{}\n{:44} {:>10} {:>8} {:>12} {:>8}\n", table.title, "", "ns", "ratio", "collisions",
             "weight");
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const double time = reporter.median(table.benchmarks[row]);
    if (time == 0) continue;
    const Tally& tally = table.tallies[row];
    fmt::print("{:44} {:10.2f} {:7.1f}x {:12.2f} {:8.4f}\n", table.rows[row], time, first / time,
               tally.collisions / tally.rays, tally.weight / tally.rays);
  }
}

bool same_problem(const Table& table) {
  const Tally& first = table.tallies[0];
  bool same = true;
  for (std::size_t row = 1; row < table.rows.size(); ++row) {
    const Tally& other = table.tallies[row];
    same &= agree(table, row, "collisions a ray",
                  mean(first.collisions, first.collisions_squared, first.rays),
                  mean(other.collisions, other.collisions_squared, other.rays));
    same &= agree(table, row, "mean weight",
                  mean(first.weight, first.weight_squared, first.rays),
                  mean(other.weight, other.weight_squared, other.rays));
  }
  return same;
}

}  // namespace freepath::bench
