#include "freepath/report/axis_ticks.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace freepath {
namespace {

/// "text^exponent" of the labels, minor ticks left out.
std::vector<std::string> labels(double minimum, double maximum, bool logarithmic, double wanted) {
  std::vector<std::string> result;
  for (const AxisTick& tick : axis_ticks({minimum, maximum, logarithmic}, wanted)) {
    if (tick.is_minor) continue;
    const TickLabel& label = tick.label;
    result.push_back(label.exponent.empty() ? label.text : label.text + "^" + label.exponent);
  }
  return result;
}

using Labels = std::vector<std::string>;

TEST(NiceStep, IsOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(nice_step(10, 5), 2);
  EXPECT_DOUBLE_EQ(nice_step(10, 10), 1);
  EXPECT_DOUBLE_EQ(nice_step(10, 9), 2);
  EXPECT_DOUBLE_EQ(nice_step(0.03, 10), 0.005);
  EXPECT_DOUBLE_EQ(nice_step(8e6, 10), 1e6);
}

TEST(AxisTicks, LinearLabelsHaveAsManyDecimalsAsTheirStepNeeds) {
  EXPECT_EQ(labels(0, 1, false, 5), (Labels{"0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(labels(-2, 2, false, 4), (Labels{"\u22122", "\u22121", "0", "1", "2"}));
  EXPECT_EQ(labels(0, 0.1, false, 4), (Labels{"0", "0.05", "0.10"}));
}

TEST(AxisTicks, LinearTicksStayWithinTheAxis) {
  for (const AxisTick& tick : axis_ticks({0.13, 0.97, false}, 6)) {
    EXPECT_GE(tick.value, 0.13);
    EXPECT_LE(tick.value, 0.97);
  }
}

TEST(AxisTicks, LargeAndSmallNumbersShareAPowerOfTen) {
  EXPECT_EQ(labels(0, 20000, false, 2), (Labels{"0", "10\u2009000", "20\u2009000"}));
  EXPECT_EQ(labels(0, 4e6, false, 4),
            (Labels{"0", "1\u00D710^6", "2\u00D710^6", "3\u00D710^6", "4\u00D710^6"}));
  EXPECT_EQ(labels(0, 1e-5, false, 2), (Labels{"0", "0.5\u00D710^\u22125", "1.0\u00D710^\u22125"}));
}

TEST(AxisTicks, LogarithmicTicksAreDecadesWithNinthsBetween) {
  const auto ticks = axis_ticks({1, 1000, true}, 6);
  ASSERT_EQ(ticks.size(), 3 * 9 + 1U);
  for (const AxisTick& tick : ticks) {
    const double power = std::round(std::log10(tick.value));
    EXPECT_EQ(tick.is_minor, std::abs(tick.value - std::pow(10.0, power)) > 1e-6 * tick.value);
  }
  EXPECT_EQ(labels(0.01, 100, true, 6), (Labels{"0.01", "0.1", "1", "10", "100"}));
  EXPECT_EQ(labels(1e-6, 1e-3, true, 6),
            (Labels{"10^\u22126", "10^\u22125", "10^\u22124", "10^\u22123"}));
}

TEST(AxisTicks, ManyDecadesAreLabelledAtEqualStrides) {
  EXPECT_EQ(labels(1e-12, 1e12, true, 5),
            (Labels{"10^\u221210", "10^\u22125", "10^0", "10^5", "10^10"}));
}

TEST(AxisTicks, FewDecadesAreLabelledAtOneTwoAndFive) {
  EXPECT_EQ(labels(0.8, 12, true, 6), (Labels{"1", "2", "5", "10"}));
}

TEST(AxisTicks, LessThanADecadeIsLabelledInEqualSteps) {
  EXPECT_EQ(labels(105, 170, true, 4), (Labels{"120", "140", "160"}));
}

TEST(AxisScale, PlacesValuesAlongTheAxis) {
  EXPECT_DOUBLE_EQ(AxisScale(2, 6, false).position(5), 0.75);
  EXPECT_NEAR(AxisScale(0.01, 100, true).position(10), 0.75, 1e-12);
  EXPECT_TRUE(std::isnan(AxisScale(1, 10, true).position(0)));
  EXPECT_TRUE(std::isnan(AxisScale(1, 10, true).position(-1)));
  EXPECT_TRUE(std::isnan(AxisScale(1, 10, false).position(std::nan(""))));
}

TEST(ReadableNumber, HasSignificantDigitsAndPowersOfTen) {
  EXPECT_EQ(readable_number(0, 3), "0");
  EXPECT_EQ(readable_number(8.753, 3), "8.75");
  EXPECT_EQ(readable_number(-0.01234, 3), "\u22120.0123");
  EXPECT_EQ(readable_number(999.96, 4), "1000");
  EXPECT_EQ(readable_number(12345, 3), "12\u2009345");
  EXPECT_EQ(readable_number(1.5e7, 3), "1.5\u00D710\u2077");
  EXPECT_EQ(readable_number(2e-7, 3), "2\u00D710\u207B\u2077");
  EXPECT_EQ(readable_number(std::nan(""), 3), "\u2013");
}

}  // namespace
}  // namespace freepath
