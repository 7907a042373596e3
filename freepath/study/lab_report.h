#pragma once
/// @file The laboratory's report: a page, its plots and its numbers.

#include <string>
#include <vector>

#include "freepath/study/lab.h"

namespace freepath {

/// A file of the report, to be written as it is.
struct LabFile {
  std::string name;
  std::string content;
};

/// report.html, lab.json, lab.csv, and every plot as <setting>-<plot>.svg.
/// @param command that makes the report again, which it shows; may be empty
std::vector<LabFile> lab_files(const LabResult& result, const std::string& command = {});

}  // namespace freepath
