#include "bench/summary.h"

#include <fmt/format.h>

#include "bench/agreement.h"
#include "bench/timing.h"

namespace freepath::bench {
namespace {

Mean mean_collisions(const Tally& tally) {
  return mean(tally.collisions, tally.collisions_squared, tally.rays);
}

Mean mean_weight(const Tally& tally) {
  return mean(tally.weight, tally.weight_squared, tally.rays);
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
  return found == times_.end() ? 0 : bench::median(found->second);
}

bool report(const Table& table, const KeepingReporter& reporter) {
  double first_time = 0;
  Tally first;
  bool same = true;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const double time = reporter.median(table.benchmarks[row]);
    if (time == 0) continue;
    const Tally tally = table.tallies[row]();
    if (first_time == 0) {
      first_time = time;
      first = tally;
      fmt::print("\n{}\n{:32} {:>13} {:>8} {:>15} {:>12}\n", table.title, "", "ns/collision",
                 "ratio", "collisions/ray", "mean weight");
    }
    const bool agrees = agree(mean_collisions(first), mean_collisions(tally)) &&
                        agree(mean_weight(first), mean_weight(tally));
    fmt::print("{:32} {:13.2f} {:7.1f}x {:15.3f} {:12.4f}{}\n", table.rows[row], time,
               first_time / time, mean_collisions(tally).value, mean_weight(tally).value,
               agrees ? "" : "  differs from the first row");
    same &= agrees;
  }
  return same;
}

}  // namespace freepath::bench
