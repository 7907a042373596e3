#pragma once
/// @file How the series of a chart look: lines, dashes, markers, bands and error bars.

#include "freepath/report/chart.h"
#include "freepath/report/chart_frame.h"
#include "freepath/report/svg_writer.h"

namespace freepath {

/// A series with its place among those that have colours.
struct SeriesLook {
  int number = 0;             ///< Decides colour, dash and shape.
  bool is_reference = false;  ///< Dashed, in the ink's colour.
};

/// Begins the group of a series in its colour; the writer's end_group() ends it.
void begin_look(SvgWriter& svg, const SeriesLook& look);

/// The shaded band around lines and steps, where the series has intervals.
void draw_band(SvgWriter& svg, const ChartSeries& series, const PlotAxis& x, const PlotAxis& y);

/// Lines, steps, error bars and markers.
void draw_series(SvgWriter& svg, const ChartSeries& series, const SeriesLook& look,
                 const PlotAxis& x, const PlotAxis& y);

/// The short piece of the series that stands in a legend, from x on, 28 wide, about the height y.
void draw_legend_key(SvgWriter& svg, ChartMark mark, const SeriesLook& look, double x, double y);

}  // namespace freepath
