#pragma once
/// @file What is around the data of a chart: the range of its axes, its grid and labels.

#include <optional>
#include <string>
#include <vector>

#include "freepath/report/axis_ticks.h"
#include "freepath/report/chart.h"
#include "freepath/report/svg_writer.h"

namespace freepath {

/// The smallest and largest of the values that an axis can show.
class AxisRange {
 public:
  explicit AxisRange(bool logarithmic) : logarithmic_(logarithmic) {}

  void add(double value);
  /// An end of the interval around a value. On a logarithmic axis it may lie at any distance: it
  /// counts up to a factor of ten.
  void add_interval_end(double value, double end);

  bool is_empty() const { return is_empty_; }
  double minimum() const { return minimum_; }
  double maximum() const { return maximum_; }

 private:
  bool logarithmic_;
  bool is_empty_ = true;
  double minimum_ = 0, maximum_ = 0;
};

/// How far an axis reaches beyond the values on its own accord.
enum class AxisRoom {
  kNone,   ///< No room.
  kLittle  ///< A few percent, to a round value where it is linear.
};

/// The scale of an axis: its given ends, and for others the values.
/// @throws Error where the given ends are not finite, not in order, or not above 0 on a logarithmic
/// axis
AxisScale scale_of(const ChartAxis& axis, const AxisRange& range, AxisRoom room);

/// A scale along a side of the plot [units of the drawing].
struct PlotAxis {
  AxisScale scale;
  double from = 0, to = 0;  ///< Where its minimum and maximum are.
  std::vector<AxisTick> ticks = {};

  /// NaN where the value has no place, or is not finite. Kept within reach of the plot, so that
  /// lines to values far outside remain drawable.
  double position(double value) const;
};

/// The width of the widest label.
double widest_label(const std::vector<AxisTick>& ticks);

/// Lines of the grid across a plot; they lead from the ticks of one axis.
void draw_vertical_grid(SvgWriter& svg, const PlotAxis& axis, const SvgBox& plot);
void draw_horizontal_grid(SvgWriter& svg, const PlotAxis& axis, const SvgBox& plot);

/// The axis below a plot with its ticks' labels and its own, `kBottomAxisHeight` high.
void draw_bottom_axis(SvgWriter& svg, const PlotAxis& axis, const std::string& label,
                      const SvgBox& plot);
inline constexpr double kBottomAxisHeight = 46;

/// The axis to the left of a plot; its own label is turned, at `label_x`.
void draw_left_axis(SvgWriter& svg, const PlotAxis& axis, const std::string& label,
                    const SvgBox& plot, double label_x);

}  // namespace freepath
