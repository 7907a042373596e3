#include "freepath/report/chart.h"

#include <cmath>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "freepath/base/error.h"
#include "freepath/report/chart_colors.h"
#include "tests/report/well_formed.h"

namespace freepath {
namespace {

using testing::count;
using testing::xml_fault;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Numbers that a pattern finds in its only group.
std::vector<double> numbers(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<double> result;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) {
    result.push_back(std::stod((*it)[1]));
  }
  return result;
}

/// x of the marker of each point.
std::vector<double> marker_x(const std::string& svg) {
  return numbers(svg, R"(translate\(([-\d.]+) )");
}
std::vector<double> marker_y(const std::string& svg) {
  return numbers(svg, R"(translate\([-\d.]+ ([-\d.]+)\))");
}

/// Points with the values given.
Chart points(std::vector<double> x, std::vector<double> y) {
  Chart chart{"A title", {"x"}, {"y"}, {}};
  chart.series.push_back({"", std::move(x), std::move(y), {}, {}, ChartMark::kPoints});
  return chart;
}

TEST(Chart, IsWellFormedWithEveryMark) {
  Chart chart{"All", {"x"}, {"y"}, {}};
  for (const ChartMark mark :
       {ChartMark::kLine, ChartMark::kSteps, ChartMark::kPoints, ChartMark::kBoth}) {
    ChartSeries series{"name", {1, 2, 3}, {1, 4, 2}, {0, 3, 1}, {2, 5, 3}, mark};
    if (mark == ChartMark::kSteps) series.x.push_back(4);
    chart.series.push_back(series);
    series.is_reference = true;
    chart.series.push_back(series);
  }
  for (const bool logarithmic : {false, true}) {
    chart.x.logarithmic = chart.y.logarithmic = logarithmic;
    EXPECT_EQ(xml_fault(to_svg(chart)), "");
  }
}

TEST(Chart, DecadesOfALogarithmicAxisAreEquallyFarApart) {
  Chart chart = points({0.1, 1, 10, 100}, {1e-4, 1e-2, 1, 1e2});
  chart.x.logarithmic = chart.y.logarithmic = true;
  const std::string svg = to_svg(chart);
  const std::vector<double> x = marker_x(svg);
  const std::vector<double> y = marker_y(svg);
  ASSERT_EQ(x.size(), 4U);
  for (int i = 1; i < 3; ++i) {
    // Coordinates are rounded to a hundredth.
    EXPECT_NEAR(x[i] - x[i - 1], x[i + 1] - x[i], 0.02);
    EXPECT_NEAR(y[i] - y[i - 1], y[i + 1] - y[i], 0.02);
  }
  EXPECT_GT(x[1], x[0]);
  EXPECT_LT(y[1], y[0]) << "larger values are further up";
}

TEST(Chart, PointsStandAboveTheTicksOfTheirValues) {
  Chart chart = points({0, 1, 2}, {0, 5, 10});
  chart.x.minimum = 0;
  chart.x.maximum = 2;
  const std::string svg = to_svg(chart);
  const std::vector<double> label = numbers(
      svg, R"svg(<text x="([-\d.]+)"[^>]*text-anchor="middle" font-size="12"[^>]*>1\.00?<)svg");
  ASSERT_EQ(label.size(), 1U);
  EXPECT_NEAR(marker_x(svg)[1], label[0], 0.01);
}

TEST(Chart, GivenEndsAreTheEndsOfThePlot) {
  Chart chart = points({1, 2, 3}, {10, 20, 30});
  chart.x.minimum = 1;
  chart.x.maximum = 3;
  const std::string svg = to_svg(chart);
  const std::vector<double> left = numbers(svg, R"rx(<svg x="([\d.]+)")rx");
  const std::vector<double> width =
      numbers(svg, R"rx(<svg x="[^"]*" y="[^"]*" width="([\d.]+)")rx");
  ASSERT_EQ(left.size(), 1U);
  EXPECT_NEAR(marker_x(svg).front(), left[0], 0.02);
  EXPECT_NEAR(marker_x(svg).back(), left[0] + width[0], 0.02);
}

TEST(Chart, ValuesThatAreNotFiniteAreGaps) {
  Chart chart{"", {"x"}, {"y"}, {}};
  chart.series.push_back({"", {0, 1, 2, 3, 4, 5}, {1, 2, kNan, 3, kInfinity, 4}});
  const std::string svg = to_svg(chart);
  EXPECT_EQ(xml_fault(svg), "");
  const std::regex line(R"svg(<path d="([^"]*)" stroke="currentColor" stroke-width="2")svg");
  std::smatch path;
  ASSERT_TRUE(std::regex_search(svg, path, line));
  EXPECT_EQ(count(path[1], "M"), 3U) << "two joined, one alone, one alone";
  EXPECT_EQ(count(path[1], "L"), 1U);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(Chart, LogarithmicAxesLeaveOutWhatIsNotAboveZero) {
  Chart chart = points({-1, 0, 1, 10}, {1, 1, 1, 10});
  chart.x.logarithmic = true;
  EXPECT_EQ(marker_x(to_svg(chart)).size(), 2U);
}

TEST(Chart, IntervalsToZeroDoNotStretchALogarithmicAxis) {
  Chart chart{"", {"x"}, {"y", true}, {}};
  chart.series.push_back({"", {1, 2}, {1, 100}, {0, 90}, {2, 110}, ChartMark::kPoints});
  const std::vector<double> with = marker_y(to_svg(chart));
  chart.series[0].low[0] = 1;
  EXPECT_EQ(with, marker_y(to_svg(chart)));
}

TEST(Chart, SurvivesNothingAndSingleValues) {
  for (const bool logarithmic : {false, true}) {
    for (Chart chart : {Chart{}, points({}, {}), points({3}, {7}), points({3, 3}, {0, 0}),
                        points({kNan}, {kNan}), points({1e300, -1e300}, {1e-300, 1})}) {
      chart.x.logarithmic = chart.y.logarithmic = logarithmic;
      const std::string svg = to_svg(chart);
      EXPECT_EQ(xml_fault(svg), "");
      EXPECT_EQ(svg.find("nan"), std::string::npos);
    }
  }
  Chart steps;
  steps.series.push_back({"empty", {}, {}, {}, {}, ChartMark::kSteps});
  EXPECT_EQ(xml_fault(to_svg(steps)), "");
}

TEST(Chart, EscapesItsTexts) {
  Chart chart = points({1, 2}, {1, 2});
  chart.title = "a < b & \"c\" \xFF \x01";
  chart.x.label = "<script>";
  chart.series[0].name = "]]> 'q' µ";
  const std::string svg = to_svg(chart);
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_EQ(svg.find("<script>"), std::string::npos);
  EXPECT_NE(svg.find("a &lt; b &amp; &quot;c&quot; \uFFFD \uFFFD"), std::string::npos);
  EXPECT_NE(svg.find("]]&gt; &#39;q&#39; µ"), std::string::npos);
}

TEST(Chart, RefusesLengthsThatDoNotFit) {
  const auto with = [](const ChartSeries& series) {
    Chart chart;
    chart.series.push_back(series);
    return chart;
  };
  EXPECT_THROW(to_svg(with({"a", {1, 2}, {1}})), Error);
  EXPECT_THROW(to_svg(with({"a", {1, 2}, {1, 2}, {1}, {2}})), Error);
  EXPECT_THROW(to_svg(with({"a", {1, 2}, {1, 2}, {1, 2}, {}})), Error);
  EXPECT_THROW(to_svg(with({"a", {1, 2}, {1, 2}, {}, {}, ChartMark::kSteps})), Error);
  EXPECT_NO_THROW(to_svg(with({"a", {1, 2, 3}, {1, 2}, {}, {}, ChartMark::kSteps})));
}

TEST(Chart, RefusesEndsThatAreNoAxis) {
  Chart chart = points({1, 2}, {1, 2});
  chart.x.minimum = 3;
  chart.x.maximum = 2;
  EXPECT_THROW(to_svg(chart), Error);
  chart.x.minimum = kNan;
  EXPECT_THROW(to_svg(chart), Error);
  chart.x.minimum = 0;
  EXPECT_NO_THROW(to_svg(chart));
  chart.x.logarithmic = true;
  EXPECT_THROW(to_svg(chart), Error);
}

TEST(Chart, GivesTheSameBytesAgain) {
  const Chart chart = points({1, 2, 3.7}, {1, 0.2, 1e-5});
  EXPECT_EQ(to_svg(chart), to_svg(chart));
}

TEST(Chart, HoldsTheColoursOfBothSchemesAndOfPaper) {
  const std::string svg = to_svg(points({1}, {1}));
  for (std::size_t i = 0; i < kLightPalette.size(); ++i) {
    const std::string name = ".fpc-s" + std::to_string(i + 1) + "{color:";
    EXPECT_NE(svg.find(name + std::string(kLightPalette[i])), std::string::npos);
    EXPECT_NE(svg.find(name + std::string(kDarkPalette[i])), std::string::npos);
  }
  EXPECT_NE(svg.find("prefers-color-scheme:dark"), std::string::npos);
  EXPECT_NE(svg.find("data-theme=dark"), std::string::npos);
  EXPECT_NE(svg.find("@media print"), std::string::npos);
  EXPECT_EQ(svg.find("var("), std::string::npos) << "converters know no variables, and draw black";
}

TEST(Chart, CanStandBesideOthersInOnePage) {
  const std::string svg = to_svg(points({1}, {1}));
  EXPECT_EQ(svg.find(" id="), std::string::npos) << "names would clash";
  const std::regex other_class(R"rx(class="(?!fpc))rx");
  EXPECT_FALSE(std::regex_search(svg, other_class));
}

TEST(Chart, SaysWhatItShowsToThoseWhoDoNotSeeIt) {
  Chart chart = points({1}, {1});
  chart.series[0].name = "delta";
  const std::string svg = to_svg(chart);
  EXPECT_NE(
      svg.find("role=\"img\" aria-label=\"A title. Across: x; upwards: y; 1 series: delta.\""),
      std::string::npos);
  EXPECT_NE(svg.find("<title>A title</title>"), std::string::npos);
}

/// Relative luminance of "#rrggbb" (WCAG 2.1).
double luminance(std::string_view colour) {
  double sum = 0;
  constexpr double kWeights[] = {0.2126, 0.7152, 0.0722};
  for (int i = 0; i < 3; ++i) {
    const double value = std::stoi(std::string(colour.substr(1 + 2 * i, 2)), nullptr, 16) / 255.0;
    sum +=
        kWeights[i] * (value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
  }
  return sum;
}

double contrast(std::string_view a, std::string_view b) {
  const double first = luminance(a) + 0.05;
  const double second = luminance(b) + 0.05;
  return std::max(first, second) / std::min(first, second);
}

// WCAG 2.1: 3:1 for graphics (1.4.11), 4.5:1 for text (1.4.3).
TEST(ChartColours, StandOutFromThePaper) {
  for (const std::string_view colour : kLightPalette) {
    EXPECT_GE(contrast(colour, kLightInks.paper), 3) << colour;
  }
  for (const std::string_view colour : kDarkPalette) {
    EXPECT_GE(contrast(colour, kDarkInks.paper), 3) << colour;
  }
  for (const ChartInks& inks : {kLightInks, kDarkInks}) {
    EXPECT_GE(contrast(inks.ink, inks.paper), 4.5);
    EXPECT_GE(contrast(inks.soft, inks.paper), 4.5);
  }
}

BarChart three_bars() {
  return {"Bars", {"times"}, {{"one", 1}, {"two", 2, 1.5, 2.5, true}, {"four", 4}}};
}

/// Attributes of the bars, without the paper's rectangle.
std::vector<double> bar_attribute(const std::string& svg, const std::string& name) {
  return numbers(svg, "<rect (?=x=)[^>]*\\b" + name + "=\"([-\\d.]+)\"");
}

TEST(BarChart, LengthsAreInProportionToValues) {
  const std::string svg = to_svg(three_bars());
  EXPECT_EQ(xml_fault(svg), "");
  const std::vector<double> widths = bar_attribute(svg, "width");
  ASSERT_EQ(widths.size(), 3U);
  EXPECT_NEAR(widths[1], 2 * widths[0], 0.05);
  EXPECT_NEAR(widths[2], 4 * widths[0], 0.05);
}

TEST(BarChart, NegativeValuesGoToTheLeftOfZero) {
  BarChart chart = three_bars();
  chart.bars[0].value = -1;
  const std::string svg = to_svg(chart);
  const std::vector<double> x = bar_attribute(svg, "x");
  const std::vector<double> widths = bar_attribute(svg, "width");
  ASSERT_EQ(x.size(), 3U);
  EXPECT_NEAR(x[0] + widths[0], x[1], 0.02);
}

TEST(BarChart, LogarithmicBarsBeginAtTheLeftEnd) {
  BarChart chart = three_bars();
  chart.axis.logarithmic = true;
  chart.axis.minimum = 0.5;
  const std::vector<double> widths = bar_attribute(to_svg(chart), "width");
  ASSERT_EQ(widths.size(), 3U);
  EXPECT_NEAR(widths[1], 2 * widths[0], 0.05);  // 1 is one octave above 0.5, 2 are two
  EXPECT_NEAR(widths[2], 3 * widths[0], 0.05);
}

TEST(BarChart, LongNamesAreCutBetweenCharacters) {
  BarChart chart = three_bars();
  for (int i = 0; i < 100; ++i) chart.bars[0].name += "µ";
  const std::string svg = to_svg(chart);
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_NE(svg.find("µ\u2026</text>"), std::string::npos);
  EXPECT_EQ(svg.find("\uFFFD"), std::string::npos);
}

TEST(BarChart, BestBarStandsOutAndBrokenOnesHaveNoBar) {
  BarChart chart = three_bars();
  chart.bars.push_back({"broken", kNan, kNan, kNan});
  chart.mark_at = 1;
  const std::string svg = to_svg(chart);
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_EQ(count(svg, "<g class=\"fpc-best\""), 1U);
  EXPECT_EQ(bar_attribute(svg, "width").size(), 3U);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(xml_fault(to_svg(BarChart{})), "");
}

}  // namespace
}  // namespace freepath
