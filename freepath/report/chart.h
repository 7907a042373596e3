#pragma once
/// @file Charts: curves, steps, points and bars, drawn as SVG.

#include <optional>
#include <string>
#include <vector>

namespace freepath {

/// How values are laid out along a side of a chart.
struct ChartAxis {
  std::string label;         ///< Label with its unit: "time [s]".
  bool logarithmic = false;  ///< Values that are not above 0 are left out.
  /// Ends of the axis; where one is not given, the values decide.
  std::optional<double> minimum = {}, maximum = {};
};

/// How the values of a series are drawn.
enum class ChartMark {
  kLine,    ///< Joined by straight lines.
  kSteps,   ///< A histogram: y[i] from x[i] to x[i+1]; x has one value more.
  kPoints,  ///< A dot each.
  kBoth,    ///< Dots, joined.
};

/// Values that belong together. Those that are not finite are gaps.
struct ChartSeries {
  std::string name;  ///< Name in the legend; empty: not there.
  std::vector<double> x, y;
  /// Ends of an interval around each y, or empty: a shaded band around lines and steps, error bars
  /// on points.
  std::vector<double> low = {}, high = {};
  ChartMark mark = ChartMark::kLine;
  bool is_reference = false;  ///< What others are measured against: dashed, in the ink's colour.
};

/// Series over one pair of axes. Colours follow the order of the series that are no references; a
/// legend stands beside them.
struct Chart {
  std::string title;
  ChartAxis x, y;
  std::vector<ChartSeries> series;
  int width = 640, height = 420;  ///< Size of the drawing, whose letters have a height of 12 to 16.
};

/// One bar of a chart.
struct ChartBar {
  std::string name;
  double value = 0;
  std::optional<double> low = {}, high = {};  ///< Ends of its error bar.
  bool is_best = false;                       ///< Stands out.
};

/// Horizontal bars, one below the other, each with its name and value.
struct BarChart {
  std::string title;
  ChartAxis axis;  ///< Where it is logarithmic, bars begin at its left end.
  std::vector<ChartBar> bars;
  std::optional<double> mark_at = {};  ///< A line across all bars, such as 1 for "the same".
  int width = 640;                     ///< Width of the drawing.
  int height = 0;                      ///< 0: what its bars need.
};

/// A whole SVG file, which needs no other: its colours are its own, and follow the viewer's choice
/// of light or dark. Text in it is text. The same chart gives the same bytes.
/// @throws Error where the lengths of a series' vectors do not fit together, or the ends that are
/// given for an axis are no axis
std::string to_svg(const Chart& chart);
std::string to_svg(const BarChart& chart);

}  // namespace freepath
