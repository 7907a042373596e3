#include "freepath/report/chart.h"

#include <algorithm>
#include <cmath>

#include "freepath/base/error.h"
#include "freepath/report/chart_frame.h"
#include "freepath/report/chart_marks.h"
#include "freepath/report/markup.h"

namespace freepath {

namespace {

constexpr double kMargin = 16;
constexpr double kLegendRow = 22;
constexpr double kKeyWidth = 28;
constexpr double kKeyGap = 8;

void check_lengths(const ChartSeries& series) {
  const std::size_t needed = series.y.size() + (series.mark == ChartMark::kSteps ? 1 : 0);
  const bool is_empty = series.x.empty() && series.y.empty();
  if (series.x.size() != needed && !is_empty) {
    fail("the series '{}' has {} values of x and {} of y; it needs {} of x", series.name,
         series.x.size(), series.y.size(), needed);
  }
  const bool has_none = series.low.empty() && series.high.empty();
  if (!has_none &&
      (series.low.size() != series.y.size() || series.high.size() != series.y.size())) {
    fail("the series '{}' has {} lower and {} upper ends of intervals for {} values of y",
         series.name, series.low.size(), series.high.size(), series.y.size());
  }
}

struct Ranges {
  AxisRange x, y;
};

Ranges ranges_of(const Chart& chart) {
  Ranges ranges{AxisRange(chart.x.logarithmic), AxisRange(chart.y.logarithmic)};
  for (const ChartSeries& series : chart.series) {
    for (const double x : series.x) ranges.x.add(x);
    for (const double y : series.y) ranges.y.add(y);
    for (std::size_t i = 0; i < series.low.size(); ++i) {
      ranges.y.add_interval_end(series.y[i], series.low[i]);
      ranges.y.add_interval_end(series.y[i], series.high[i]);
    }
    // Bins are seen as areas, which begin at 0.
    if (series.mark == ChartMark::kSteps && !chart.y.logarithmic) ranges.y.add(0);
  }
  return ranges;
}

/// Markers at the ends of the x axis need some room, lines and bins do not.
AxisRoom x_room(const Chart& chart) {
  const bool has_markers =
      std::any_of(chart.series.begin(), chart.series.end(), [](const ChartSeries& series) {
        return series.mark == ChartMark::kPoints || series.mark == ChartMark::kBoth;
      });
  return has_markers ? AxisRoom::kLittle : AxisRoom::kNone;
}

/// A name in the legend, and where its key begins [units of the drawing].
struct LegendEntry {
  std::string name;
  ChartMark mark = ChartMark::kLine;
  SeriesLook look = {};
  double width = 0;
  double x = 0, y = 0;
};

std::vector<SeriesLook> looks_of(const Chart& chart) {
  std::vector<SeriesLook> looks;
  int number = 0;
  for (const ChartSeries& series : chart.series) {
    looks.push_back({series.is_reference ? 0 : number, series.is_reference});
    if (!series.is_reference) ++number;
  }
  return looks;
}

std::vector<LegendEntry> legend_of(const Chart& chart, const std::vector<SeriesLook>& looks) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const ChartSeries& series = chart.series[i];
    if (series.name.empty()) continue;
    entries.push_back({series.name, series.mark, looks[i],
                       kKeyWidth + kKeyGap + text_width(series.name, kTickSize)});
  }
  return entries;
}

double widest(const std::vector<LegendEntry>& entries) {
  double width = 0;
  for (const LegendEntry& entry : entries) width = std::max(width, entry.width);
  return width;
}

/// Places the entries in rows of equal columns below each other; returns the height.
double arrange_in_rows(std::vector<LegendEntry>& entries, double left, double width) {
  constexpr double kGap = 22;
  const double column = widest(entries) + kGap;
  const auto columns = static_cast<std::size_t>(std::max(1.0, std::floor((width + kGap) / column)));
  double row = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::size_t column_index = i % columns;
    if (column_index == 0 && i > 0) row += kLegendRow;
    entries[i].x = left + static_cast<double>(column_index) * column;
    entries[i].y = row;
  }
  return row + kLegendRow;
}

void draw_legend(SvgWriter& svg, const std::vector<LegendEntry>& entries, double top,
                 double right) {
  for (const LegendEntry& entry : entries) {
    const double room = right - entry.x - kKeyWidth - kKeyGap;
    draw_legend_key(svg, entry.mark, entry.look, entry.x, top + entry.y);
    svg.text(entry.x + kKeyWidth + kKeyGap, top + entry.y + 4, TextAnchor::kStart, kTickSize,
             escape_markup(shortened(entry.name, kTickSize, room)));
  }
}

/// "Title. x: label; y: label; 3 series: a, b, c."
std::string summary_of(const Chart& chart) {
  std::string names;
  for (const ChartSeries& series : chart.series) {
    if (!series.name.empty()) names += (names.empty() ? ": " : ", ") + series.name;
  }
  return fmt::format("{}. Across: {}; upwards: {}; {} series{}.", chart.title, chart.x.label,
                     chart.y.label, chart.series.size(), names);
}

/// Where everything is.
struct ChartLayout {
  std::vector<std::string> title;
  SvgBox plot;
  PlotAxis x, y;
  std::vector<LegendEntry> legend;
  double legend_top = 0;
};

ChartLayout layout_of(const Chart& chart, const std::vector<SeriesLook>& looks) {
  const Ranges ranges = ranges_of(chart);
  ChartLayout layout{{},
                     {},
                     {scale_of(chart.x, ranges.x, x_room(chart))},
                     {scale_of(chart.y, ranges.y, AxisRoom::kLittle)},
                     legend_of(chart, looks)};
  layout.title = wrapped(chart.title, kTitleSize, chart.width - 2 * kMargin);
  SvgBox& plot = layout.plot;
  const auto title_lines = static_cast<double>(layout.title.size());
  plot.top = layout.title.empty() ? kMargin : 26 + 20 * title_lines;
  plot.bottom = chart.height - kBottomAxisHeight - 4;
  plot.right = chart.width - 24;

  // Beside the plot where names are short, else below it.
  const double legend_width = widest(layout.legend);
  const bool is_beside = legend_width > 0 && legend_width < 0.3 * chart.width;
  if (is_beside) {
    plot.right = chart.width - kMargin - legend_width - 14;
    for (std::size_t i = 0; i < layout.legend.size(); ++i) {
      layout.legend[i].x = plot.right + 14;
      layout.legend[i].y = static_cast<double>(i) * kLegendRow;
    }
    layout.legend_top = plot.top + 10;
  } else if (!layout.legend.empty()) {
    plot.bottom -= arrange_in_rows(layout.legend, kMargin, chart.width - 2 * kMargin) + 4;
    layout.legend_top = plot.bottom + kBottomAxisHeight + 12;
  }
  layout.y.ticks = axis_ticks(layout.y.scale, std::max(2.0, plot.height() / 50));
  plot.left = kMargin + 26 + widest_label(layout.y.ticks);
  layout.x.ticks = axis_ticks(layout.x.scale, std::max(2.0, plot.width() / 75));
  layout.x.from = plot.left;
  layout.x.to = plot.right;
  layout.y.from = plot.bottom;
  layout.y.to = plot.top;
  return layout;
}

}  // namespace

std::string to_svg(const Chart& chart) {
  for (const ChartSeries& series : chart.series) check_lengths(series);
  const std::vector<SeriesLook> looks = looks_of(chart);
  const ChartLayout layout = layout_of(chart, looks);
  const SvgBox& plot = layout.plot;

  SvgWriter svg(chart.width, chart.height, chart.title, summary_of(chart));
  svg.title(layout.title);
  draw_vertical_grid(svg, layout.x, plot);
  draw_horizontal_grid(svg, layout.y, plot);
  svg.begin_clip(plot);
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    begin_look(svg, looks[i]);
    draw_band(svg, chart.series[i], layout.x, layout.y);
    svg.end_group();
  }
  // References lie below what is measured against them.
  for (const bool references : {true, false}) {
    for (std::size_t i = 0; i < chart.series.size(); ++i) {
      if (chart.series[i].is_reference != references) continue;
      begin_look(svg, looks[i]);
      draw_series(svg, chart.series[i], looks[i], layout.x, layout.y);
      svg.end_group();
    }
  }
  svg.end_clip();
  draw_bottom_axis(svg, layout.x, chart.x.label, plot);
  draw_left_axis(svg, layout.y, chart.y.label, plot, kMargin + 10);
  draw_legend(svg, layout.legend, layout.legend_top, chart.width - kMargin + 1);
  return std::move(svg).finished();
}

}  // namespace freepath
