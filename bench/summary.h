#pragma once
/// @file The tables that a run ends with, and the test that its variants walked the same problem.

#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bench/tally.h"

namespace freepath::bench {

/// Name of the counter that holds nanoseconds per tentative collision.
inline constexpr const char* kTimeCounter = "ns_per_collision";

/// Prints medians to the console, and keeps the figure of every repetition.
class KeepingReporter : public benchmark::ConsoleReporter {
 public:
  using ConsoleReporter::ConsoleReporter;
  void ReportRuns(const std::vector<Run>& runs) override;

  /// Median over repetitions of a benchmark by its name [ns], 0 if it did not run.
  double median(const std::string& name) const;

 private:
  std::map<std::string, std::vector<double>> times_;
};

/// Rows that are compared with the first of them.
struct Table {
  std::string title;
  std::vector<std::string> rows;                ///< Titles of the rows.
  std::vector<std::string> benchmarks;          ///< Name of each row's benchmark.
  std::vector<std::function<Tally()>> tallies;  ///< What each does, walked once more.
};

/// Prints the rows that ran, and tests that they have the same mean number of collisions and the
/// same mean weight as the first of them, naming those that have not.
/// @return whether all agree (see agree())
bool report(const Table& table, const KeepingReporter& reporter);

}  // namespace freepath::bench
