#pragma once
/// @file What a comparison says, for people and for programs.

#include <string>
#include <vector>

#include "freepath/report/page.h"
#include "freepath/study/comparison.h"

namespace freepath {

/// What a report tells besides what was measured.
struct ReportContext {
  std::string target;   ///< "cloud.vdb"
  std::string command;  ///< Command that makes the same report, as typed.
  std::string machine;  ///< One line: processor, threads, instructions.
  std::string date;     ///< Date as in ISO 8601.
  double exposure = 0;  ///< Exposure of the pictures [stops].
};

/// One line on this machine: its processor, how many threads run, the instructions that walks use.
std::string machine_text(const RenderSettings& settings);

/// The report: findings first, then table, figures, pictures, maps, and how it was made.
Page page_of(const Comparison& comparison, const ReportContext& context);

/// All that was measured but the pictures. What can't be told is null.
std::string json_of(const Comparison& comparison, const ReportContext& context);

/// A row for each configuration, with the figures of the table and the ends of their intervals.
std::string csv_of(const Comparison& comparison);

/// Short lines on what came out: the most efficient, and which tests failed.
std::vector<std::string> findings_of(const Comparison& comparison);

}  // namespace freepath
