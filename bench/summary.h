#pragma once
/// @file The tables that a run ends with, and the test that its variants walked the same problem.

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

#include "tally.h"

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
  std::vector<std::string> rows;        ///< Titles of the rows.
  std::vector<std::string> benchmarks;  ///< Name of each row's benchmark.
  std::vector<Tally> tallies;           ///< What each did, in a run of its own.
};

/// Prints the table, for those rows that ran.
void print(const Table& table, const KeepingReporter& reporter);

/// Tests that all rows have the same mean number of collisions and the same mean weight as the
/// first, and names those that have not.
/// @return whether they agree within kLargestDifference standard errors
bool same_problem(const Table& table);

}  // namespace freepath::bench
