#include "freepath/report/chart_frame.h"

#include <algorithm>
#include <cmath>

#include "freepath/base/error.h"
#include "freepath/report/markup.h"

namespace freepath {

namespace {

void check_ends(const ChartAxis& axis) {
  for (const std::optional<double>& end : {axis.minimum, axis.maximum}) {
    if (!end) continue;
    if (!std::isfinite(*end)) fail("the axis '{}' would end at {}", axis.label, *end);
    if (axis.logarithmic && *end <= 0) {
      fail("the axis '{}' is logarithmic and would end at {}; give an end above 0", axis.label,
           *end);
    }
  }
  if (axis.minimum && axis.maximum && !(*axis.minimum < *axis.maximum)) {
    fail("the axis '{}' would reach from {} to {}; the first must be smaller", axis.label,
         *axis.minimum, *axis.maximum);
  }
}

/// Moves ends that nobody gave apart, where there is nothing between them.
void widen(const ChartAxis& axis, double& minimum, double& maximum) {
  const double size = std::max(std::abs(minimum), std::abs(maximum));
  const bool is_narrow =
      axis.logarithmic ? !(maximum > minimum * (1 + 1e-6)) : !(maximum - minimum > 1e-9 * size);
  if (!is_narrow) return;
  const double half = axis.logarithmic || size == 0 ? 1 : size / 2;
  if (!axis.maximum) {
    maximum = axis.logarithmic ? std::max(minimum, maximum) * 2 : std::max(minimum, maximum) + half;
  }
  if (!axis.minimum) {
    minimum = axis.logarithmic ? std::min(minimum, maximum) / 2 : std::min(minimum, maximum) - half;
  }
}

void draw_grid_lines(SvgWriter& svg, const PlotAxis& axis, const SvgBox& plot, bool is_vertical) {
  svg.begin_ink("grid");
  for (const AxisTick& tick : axis.ticks) {
    const double position = axis.position(tick.value);
    const std::string_view attributes = tick.is_minor ? R"(stroke-opacity="0.45")" : "";
    if (is_vertical) {
      svg.line(position, plot.top, position, plot.bottom, attributes);
    } else {
      svg.line(plot.left, position, plot.right, position, attributes);
    }
  }
  svg.end_group();
}

}  // namespace

void AxisRange::add(double value) {
  if (!std::isfinite(value) || (logarithmic_ && value <= 0)) return;
  // Lengths and ends of axes must be finite numbers too.
  constexpr double kLargest = 1e290;
  value = std::clamp(value, logarithmic_ ? 1 / kLargest : -kLargest, kLargest);
  minimum_ = is_empty_ ? value : std::min(minimum_, value);
  maximum_ = is_empty_ ? value : std::max(maximum_, value);
  is_empty_ = false;
}

void AxisRange::add_interval_end(double value, double end) {
  if (!logarithmic_) return add(end);
  if (value > 0 && end > 0 && std::isfinite(value)) add(std::clamp(end, value / 10, value * 10));
}

AxisScale scale_of(const ChartAxis& axis, const AxisRange& range, AxisRoom room) {
  check_ends(axis);
  double minimum = range.is_empty() ? (axis.logarithmic ? 1 : 0) : range.minimum();
  double maximum = range.is_empty() ? (axis.logarithmic ? 10 : 1) : range.maximum();
  minimum = axis.minimum.value_or(minimum);
  maximum = axis.maximum.value_or(maximum);
  widen(axis, minimum, maximum);
  if (room == AxisRoom::kLittle && axis.logarithmic) {
    const double factor = std::exp(0.04 * (std::log(maximum) - std::log(minimum)));
    if (!axis.minimum) minimum /= factor;
    if (!axis.maximum) maximum *= factor;
  } else if (room == AxisRoom::kLittle) {
    // A plot of things that are never negative begins at 0 if that is near.
    if (minimum > 0 && minimum < 0.4 * maximum && !axis.minimum) minimum = 0;
    const double step = nice_step(maximum - minimum, 8) / 4;
    if (!axis.minimum) minimum = std::floor(minimum / step + 1e-9) * step;
    if (!axis.maximum) maximum = std::ceil(maximum / step - 1e-9) * step;
  }
  return {minimum, maximum, axis.logarithmic};
}

double PlotAxis::position(double value) const {
  constexpr double kReach = 20;  // lengths of the axis
  const double position = scale.position(value);
  if (std::isnan(position) || !std::isfinite(value)) return std::nan("");
  return from + (to - from) * std::clamp(position, -kReach, kReach);
}

double widest_label(const std::vector<AxisTick>& ticks) {
  double width = 0;
  for (const AxisTick& tick : ticks) width = std::max(width, text_width(tick.label, kTickSize));
  return width;
}

void draw_vertical_grid(SvgWriter& svg, const PlotAxis& axis, const SvgBox& plot) {
  draw_grid_lines(svg, axis, plot, true);
}

void draw_horizontal_grid(SvgWriter& svg, const PlotAxis& axis, const SvgBox& plot) {
  draw_grid_lines(svg, axis, plot, false);
}

void draw_bottom_axis(SvgWriter& svg, const PlotAxis& axis, const std::string& label,
                      const SvgBox& plot) {
  svg.begin_ink("soft");
  svg.line(plot.left, plot.bottom, plot.right, plot.bottom);
  for (const AxisTick& tick : axis.ticks) {
    const double x = axis.position(tick.value);
    svg.line(x, plot.bottom, x, plot.bottom + (tick.is_minor ? 3 : 5));
    if (tick.label.text.empty()) continue;
    svg.label(x, plot.bottom + 19, TextAnchor::kMiddle, tick.label);
  }
  svg.end_group();
  svg.text((plot.left + plot.right) / 2, plot.bottom + 40, TextAnchor::kMiddle, kLabelSize,
           escape_markup(label));
}

void draw_left_axis(SvgWriter& svg, const PlotAxis& axis, const std::string& label,
                    const SvgBox& plot, double label_x) {
  svg.begin_ink("soft");
  svg.line(plot.left, plot.top, plot.left, plot.bottom);
  for (const AxisTick& tick : axis.ticks) {
    const double y = axis.position(tick.value);
    svg.line(plot.left - (tick.is_minor ? 3 : 5), y, plot.left, y);
    if (tick.label.text.empty()) continue;
    svg.label(plot.left - 9, y + 4, TextAnchor::kEnd, tick.label);
  }
  svg.end_group();
  const double middle = (plot.top + plot.bottom) / 2;
  svg.text(label_x, middle, TextAnchor::kMiddle, kLabelSize, escape_markup(label),
           fmt::format(R"svg(transform="rotate(-90 {} {})")svg", coordinate(label_x),
                       coordinate(middle)));
}

}  // namespace freepath
