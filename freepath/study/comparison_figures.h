#pragma once
/// @file The figures of a configuration that tables show, by name.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/study/comparison.h"

namespace freepath {

/// A column of numbers.
struct ComparisonFigure {
  std::string_view key;      ///< Name in JSON and CSV.
  std::string_view name;     ///< Name in tables.
  std::string_view meaning;  ///< One sentence.
  std::function<double(const ComparisonRun&)> of_run;
};

/// All that are means over runs, in the order of the table.
const std::vector<ComparisonFigure>& comparison_figures();

/// A number with so many significant digits, without an exponent where it is short: "0.0123",
/// "12300", "1.2e-07"; "-" where it is not finite.
std::string number_text(double value, int digits);

}  // namespace freepath
