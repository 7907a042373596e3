#include "freepath/report/chart_marks.h"

#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "freepath/report/axis_ticks.h"
#include "freepath/report/markup.h"

namespace freepath {

namespace {

/// Lines without markers differ by dashes.
constexpr std::array<std::string_view, 6> kDashes = {"",          "9 4",  "2.5 3",
                                                     "9 3 2.5 3", "15 4", "5 3 2 3 2 3"};
constexpr std::string_view kReferenceDash = "6 4";

/// Markers about the origin, all of about the same area.
constexpr std::array<std::string_view, 8> kShapes = {
    "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z",
    "M-3.6-3.6h7.2v7.2h-7.2z",
    "M0-5L4.7 3.4H-4.7z",
    "M0-5.1L5.1 0L0 5.1L-5.1 0z",
    "M0 5L4.7-3.4H-4.7z",
    "M-1.6-4.8h3.2v3.2h3.2v3.2h-3.2v3.2h-3.2v-3.2h-3.2v-3.2h3.2z",
    "M0-4.7L4.5-1.4L2.8 3.8H-2.8L-4.5-1.4z",
    "M-2.2-4.4h4.4l2.2 4.4l-2.2 4.4h-4.4l-2.2-4.4z"};

bool has_intervals(const ChartSeries& series) { return !series.low.empty(); }

bool has_markers(ChartMark mark) { return mark == ChartMark::kPoints || mark == ChartMark::kBoth; }

std::string_view shape_of(const SeriesLook& look) {
  if (look.is_reference) return kShapes[0];
  // From the ninth series on, when colours repeat, shapes are shifted against them.
  return kShapes[(look.number + look.number / kShapes.size()) % kShapes.size()];
}

std::string dash_of(const SeriesLook& look, ChartMark mark) {
  const std::string_view dash = look.is_reference          ? kReferenceDash
                                : mark == ChartMark::kBoth ? std::string_view{}
                                                           : kDashes[look.number % kDashes.size()];
  return dash.empty() ? std::string{} : fmt::format(R"( stroke-dasharray="{}")", dash);
}

std::string point(double x, double y) { return coordinate(x) + " " + coordinate(y); }

/// Joins the points that have a place; a gap breaks the line. A point alone between gaps becomes a
/// dot, since a line through one point is nothing.
std::string line_path(const ChartSeries& series, const PlotAxis& x, const PlotAxis& y) {
  constexpr double kDot = 1.5;
  std::string path;
  const std::size_t count = series.y.size();
  const auto is_there = [&](std::size_t i) {
    return i < count && std::isfinite(x.position(series.x[i])) &&
           std::isfinite(y.position(series.y[i]));
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_there(i)) continue;
    const double px = x.position(series.x[i]);
    const double py = y.position(series.y[i]);
    const bool is_first = i == 0 || !is_there(i - 1);
    if (is_first && !is_there(i + 1)) {
      path += fmt::format("M{}h{}", point(px - kDot, py), coordinate(2 * kDot));
    } else {
      path += (is_first ? "M" : "L") + point(px, py);
    }
  }
  return path;
}

/// A histogram's outline: level within each bin, upright between neighbours.
std::string step_path(const ChartSeries& series, const PlotAxis& x, const PlotAxis& y) {
  std::string path;
  bool is_open = false;
  for (std::size_t i = 0; i < series.y.size(); ++i) {
    const double left = x.position(series.x[i]);
    const double right = x.position(series.x[i + 1]);
    const double level = y.position(series.y[i]);
    const bool is_there = std::isfinite(left) && std::isfinite(right) && std::isfinite(level);
    if (is_there) {
      path += is_open ? "V" + coordinate(level) : "M" + point(left, level);
      path += "H" + coordinate(right);
    }
    is_open = is_there;
  }
  return path;
}

/// The lower end of an interval may have no place on a logarithmic axis: it is below all others.
double low_position(const PlotAxis& axis, double value) {
  const double position = axis.position(value);
  return std::isnan(position) && std::isfinite(value) ? axis.from + (axis.from - axis.to)
                                                      : position;
}

/// Corners of a piece of a band: there along the upper edge, back along the lower one.
class BandPiece {
 public:
  void add(double x, double low, double high) {
    upper_ += (upper_.empty() ? "M" : "L") + point(x, high);
    lower_ = "L" + point(x, low) + lower_;
  }
  /// The closed outline; the next piece begins anew.
  std::string closed() {
    std::string path;
    if (!upper_.empty()) path = upper_ + lower_ + "z";
    upper_.clear();
    lower_.clear();
    return path;
  }

 private:
  std::string upper_, lower_;
};

std::string band_path(const ChartSeries& series, const PlotAxis& x, const PlotAxis& y) {
  const bool is_stepped = series.mark == ChartMark::kSteps;
  std::string path;
  BandPiece piece;
  for (std::size_t i = 0; i < series.y.size(); ++i) {
    const double left = x.position(series.x[i]);
    const double right = is_stepped ? x.position(series.x[i + 1]) : left;
    const double low = low_position(y, series.low[i]);
    const double high = y.position(series.high[i]);
    const bool is_there = std::isfinite(left) && std::isfinite(right) && std::isfinite(low) &&
                          std::isfinite(high) && std::isfinite(y.position(series.y[i]));
    if (!is_there) {
      path += piece.closed();
      continue;
    }
    piece.add(left, low, high);
    if (is_stepped) piece.add(right, low, high);
  }
  return path + piece.closed();
}

void draw_error_bars(SvgWriter& svg, const ChartSeries& series, const PlotAxis& x,
                     const PlotAxis& y) {
  constexpr double kCap = 3.5;
  std::string path;
  for (std::size_t i = 0; i < series.y.size(); ++i) {
    const double px = x.position(series.x[i]);
    const double low = low_position(y, series.low[i]);
    const double high = y.position(series.high[i]);
    if (!std::isfinite(px) || !std::isfinite(low) || !std::isfinite(high) ||
        !std::isfinite(y.position(series.y[i]))) {
      continue;
    }
    const std::string cap = coordinate(2 * kCap);
    path += fmt::format("M{}V{}M{}h{}M{}h{}", point(px, low), coordinate(high),
                        point(px - kCap, low), cap, point(px - kCap, high), cap);
  }
  if (!path.empty()) svg.add(R"(<path d="{}" stroke="currentColor" stroke-width="1.2"/>)", path);
}

/// What a pointer that rests on a marker is told.
std::string marker_title(const ChartSeries& series, std::size_t i) {
  constexpr int kDigits = 4;
  std::string title = fmt::format("({}, {})", readable_number(series.x[i], kDigits),
                                  readable_number(series.y[i], kDigits));
  if (has_intervals(series)) {
    title += fmt::format(" [{}, {}]", readable_number(series.low[i], kDigits),
                         readable_number(series.high[i], kDigits));
  }
  return escape_markup(series.name.empty() ? title : series.name + " " + title);
}

void draw_marker(SvgWriter& svg, const SeriesLook& look, double x, double y,
                 const std::string& title) {
  svg.add(R"svg(<path class="fpc-halo" transform="translate({})" d="{}" fill="currentColor" )svg"
          R"(stroke="#ffffff">{}</path>)",
          point(x, y), shape_of(look),
          title.empty() ? title : fmt::format("<title>{}</title>", title));
}

void draw_markers(SvgWriter& svg, const ChartSeries& series, const SeriesLook& look,
                  const PlotAxis& x, const PlotAxis& y) {
  constexpr std::size_t kMostTitles = 400;  // beyond, they would only make the file large
  for (std::size_t i = 0; i < series.y.size(); ++i) {
    const double px = x.position(series.x[i]);
    const double py = y.position(series.y[i]);
    if (!std::isfinite(px) || !std::isfinite(py)) continue;
    draw_marker(svg, look, px, py,
                series.y.size() <= kMostTitles ? marker_title(series, i) : std::string{});
  }
}

}  // namespace

void begin_look(SvgWriter& svg, const SeriesLook& look) {
  if (look.is_reference) {
    svg.begin_ink("ink");
  } else {
    svg.begin_series(look.number);
  }
}

void draw_band(SvgWriter& svg, const ChartSeries& series, const PlotAxis& x, const PlotAxis& y) {
  if (!has_intervals(series) || series.mark == ChartMark::kPoints) return;
  const std::string path = band_path(series, x, y);
  if (!path.empty()) svg.add(R"(<path d="{}" fill="currentColor" fill-opacity="0.16"/>)", path);
}

void draw_series(SvgWriter& svg, const ChartSeries& series, const SeriesLook& look,
                 const PlotAxis& x, const PlotAxis& y) {
  if (has_intervals(series) && series.mark == ChartMark::kPoints) {
    draw_error_bars(svg, series, x, y);
  }
  if (series.mark != ChartMark::kPoints) {
    const std::string path =
        series.mark == ChartMark::kSteps ? step_path(series, x, y) : line_path(series, x, y);
    if (!path.empty()) {
      svg.add(R"(<path d="{}" stroke="currentColor" stroke-width="{}" stroke-linejoin="round"{}/>)",
              path, look.is_reference ? "1.6" : "2", dash_of(look, series.mark));
    }
  }
  if (has_markers(series.mark)) draw_markers(svg, series, look, x, y);
}

void draw_legend_key(SvgWriter& svg, ChartMark mark, const SeriesLook& look, double x, double y) {
  begin_look(svg, look);
  if (mark != ChartMark::kPoints) {
    svg.line(x, y, x + 28, y, R"(stroke-width="2")" + dash_of(look, mark));
  }
  if (has_markers(mark)) draw_marker(svg, look, x + 14, y, {});
  svg.end_group();
}

}  // namespace freepath
