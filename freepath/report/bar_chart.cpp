#include <algorithm>
#include <cmath>

#include "freepath/base/error.h"
#include "freepath/report/chart.h"
#include "freepath/report/chart_frame.h"
#include "freepath/report/markup.h"

namespace freepath {

namespace {

constexpr double kBarMargin = 16;
constexpr double kRow = 32;  // height of a bar and the gap to the next, if nothing else is given
constexpr double kNameGap = 10;
constexpr double kValueGap = 8;
constexpr int kValueDigits = 3;

AxisRange range_of(const BarChart& chart) {
  AxisRange range(chart.axis.logarithmic);
  for (const ChartBar& bar : chart.bars) {
    range.add(bar.value);
    for (const std::optional<double>& end : {bar.low, bar.high}) {
      if (end) range.add_interval_end(bar.value, *end);
    }
  }
  if (chart.mark_at) range.add(*chart.mark_at);
  if (!chart.axis.logarithmic) {
    range.add(0);
  } else if (!range.is_empty() && !chart.axis.minimum) {
    // The shortest bar has a length: from the power of ten that is clearly below it.
    range.add(std::pow(10.0, std::floor(std::log10(range.minimum() * 0.8))));
  }
  return range;
}

std::string value_text(const ChartBar& bar) { return readable_number(bar.value, kValueDigits); }

/// Where everything is.
struct BarLayout {
  std::vector<std::string> title;
  SvgBox plot;
  PlotAxis axis;
  double row = kRow;
  double base = 0;  ///< x at which bars begin.
  double height = 0;

  double thickness() const { return std::min(0.56 * row, 28.0); }
  /// The height in the drawing of a bar's middle.
  double middle(std::size_t bar) const { return plot.top + (static_cast<double>(bar) + 0.5) * row; }
};

/// The right end of a bar with its error bar, where its value is written.
double right_end(const ChartBar& bar, const BarLayout& layout) {
  double end = layout.base;
  for (const std::optional<double>& value : {std::optional(bar.value), bar.low, bar.high}) {
    const double position = value ? layout.axis.position(*value) : std::nan("");
    if (std::isfinite(position)) end = std::max(end, position);
  }
  return std::min(end, layout.plot.right);
}

BarLayout layout_of(const BarChart& chart) {
  BarLayout layout{wrapped(chart.title, kTitleSize, chart.width - 2 * kBarMargin),
                   {},
                   {scale_of(chart.axis, range_of(chart), AxisRoom::kNone)}};
  double names = 0;
  double values = 0;
  for (const ChartBar& bar : chart.bars) {
    constexpr double kBold = 1.08;  // bold letters are wider
    names = std::max(names, (bar.is_best ? kBold : 1) * text_width(bar.name, kLabelSize));
    values = std::max(values, text_width(value_text(bar), kTickSize));
  }
  const auto title_lines = static_cast<double>(layout.title.size());
  SvgBox& plot = layout.plot;
  plot.top = layout.title.empty() ? kBarMargin : 24 + 20 * title_lines;
  const auto rows = static_cast<double>(std::max<std::size_t>(1, chart.bars.size()));
  if (chart.height > 0) {
    layout.row = std::max(12.0, (chart.height - plot.top - kBottomAxisHeight - 4) / rows);
  }
  plot.bottom = plot.top + layout.row * rows;
  plot.left = kBarMargin + std::min(names, 0.45 * chart.width) + kNameGap;
  // Beyond the longest bar there is room for its value.
  plot.right = chart.width - kBarMargin - values - kValueGap;
  layout.height = plot.bottom + kBottomAxisHeight + 4;
  PlotAxis& axis = layout.axis;
  axis.from = plot.left;
  axis.to = plot.right;
  axis.ticks = axis_ticks(axis.scale, std::max(2.0, plot.width() / 75));
  const double zero = axis.scale.logarithmic() ? plot.left : axis.position(0);
  layout.base = std::clamp(zero, plot.left, plot.right);
  return layout;
}

void draw_bar(SvgWriter& svg, const ChartBar& bar, const BarLayout& layout, double middle) {
  const double end = layout.axis.position(bar.value);
  if (!std::isfinite(end)) return;
  svg.begin_ink(bar.is_best ? "best" : "bar");
  svg.add(R"(<rect x="{}" y="{}" width="{}" height="{}" fill="currentColor"/>)",
          coordinate(std::min(layout.base, end)), coordinate(middle - layout.thickness() / 2),
          coordinate(std::abs(end - layout.base)), coordinate(layout.thickness()));
  svg.end_group();
  if (!bar.low || !bar.high) return;
  const double high = layout.axis.position(*bar.high);
  double low = layout.axis.position(*bar.low);
  // On a logarithmic axis 0 and less is beyond the left end.
  if (std::isnan(low) && std::isfinite(*bar.low)) low = layout.plot.left - 10;
  if (!std::isfinite(low) || !std::isfinite(high)) return;
  svg.add(R"(<path d="M{0} {1}H{2}M{0} {3}v8M{2} {3}v8" stroke="currentColor" )"
          R"(stroke-width="1.3"/>)",
          coordinate(low), coordinate(middle), coordinate(high), coordinate(middle - 4));
}

std::string summary_of(const BarChart& chart) {
  std::string values;
  for (const ChartBar& bar : chart.bars) {
    values += fmt::format("{}{} {}", values.empty() ? "" : ", ", bar.name, value_text(bar));
  }
  return fmt::format("{}. {}: {}.", chart.title, chart.axis.label, values);
}

}  // namespace

std::string to_svg(const BarChart& chart) {
  const BarLayout layout = layout_of(chart);
  const SvgBox& plot = layout.plot;
  SvgWriter svg(chart.width, layout.height, chart.title, summary_of(chart));
  svg.title(layout.title);
  draw_vertical_grid(svg, layout.axis, plot);
  svg.begin_clip(plot);
  for (std::size_t i = 0; i < chart.bars.size(); ++i) {
    draw_bar(svg, chart.bars[i], layout, layout.middle(i));
  }
  if (chart.mark_at) {
    const double x = layout.axis.position(*chart.mark_at);
    if (std::isfinite(x)) svg.line(x, plot.top, x, plot.bottom, R"(stroke-dasharray="5 3")");
  }
  svg.end_clip();
  draw_bottom_axis(svg, layout.axis, chart.axis.label, plot);
  const double names = plot.left - kNameGap - kBarMargin;
  for (std::size_t i = 0; i < chart.bars.size(); ++i) {
    const ChartBar& bar = chart.bars[i];
    const double baseline = layout.middle(i) + 4.5;
    const std::string_view weight = bar.is_best ? R"(font-weight="600")" : "";
    svg.text(plot.left - kNameGap, baseline, TextAnchor::kEnd, kLabelSize,
             escape_markup(shortened(bar.name, kLabelSize, names)), weight);
    // A halo keeps the mark's line and the grid off the digits.
    svg.text(right_end(bar, layout) + kValueGap, baseline, TextAnchor::kStart, kTickSize,
             escape_markup(value_text(bar)),
             fmt::format(R"(class="fpc-halo" stroke="#ffffff" stroke-width="4" )"
                         R"(paint-order="stroke" {})",
                         weight));
  }
  return std::move(svg).finished();
}

}  // namespace freepath
