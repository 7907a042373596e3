#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/media/phase/parse_phase_function.h"

namespace freepath {
namespace {

PhaseFunction read(const std::string& text) {
  std::istringstream input(text);
  return read_phase_table(input, "table.txt");
}

std::string message(const std::string& text) {
  try {
    read(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

double at_angle(const PhaseFunction& function, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return function.evaluate(
      {0, 0, 1}, {static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))});
}

TEST(PhaseTable, IsNormalisedWhateverItsScale) {
  for (const std::string scale : {"", "e-300", "e300"}) {
    const PhaseFunction function = read(fmt::format("0 4{0}\n180 4{0}\n", scale));
    EXPECT_NEAR(at_angle(function, 70), 1 / (4 * std::numbers::pi), 1e-7) << scale;
    EXPECT_NEAR(function.mean_cosine(), 0, 1e-7) << scale;
  }
}

// p = (1 + cosine) / (4π): its mean cosine is half the integral of c + c² from -1 to 1, 1/3.
TEST(PhaseTable, IsLinearInTheCosine) {
  const PhaseFunction function = read("0 2\n180 0\n");
  for (const double angle : {0.0, 10.0, 60.0, 90.0, 135.0, 180.0}) {
    EXPECT_NEAR(at_angle(function, angle),
                (1 + std::cos(angle * std::numbers::pi / 180)) / (4 * std::numbers::pi), 1e-7);
  }
  EXPECT_NEAR(function.mean_cosine(), 1.0 / 3, 1e-6);
}

TEST(PhaseTable, GoesThroughItsPoints) {
  const PhaseFunction function = read("0 9\n0.01 8\n3 2\n90 1\n179.99 3\n180 4\n");
  const double unit = at_angle(function, 90);
  EXPECT_NEAR(at_angle(function, 0) / unit, 9, 1e-5);
  EXPECT_NEAR(at_angle(function, 0.01) / unit, 8, 1e-4);
  EXPECT_NEAR(at_angle(function, 3) / unit, 2, 1e-4);
  EXPECT_NEAR(at_angle(function, 179.99) / unit, 3, 1e-2);  // as far as a float's 180 degrees go
  EXPECT_NEAR(at_angle(function, 180) / unit, 4, 1e-5);
}

TEST(PhaseTable, MayHaveCommentsBlankLinesAndWindowsLineEnds) {
  const PhaseFunction function = read("# water, 550 nm\r\n\r\n  0\t2 # forward\r\n180 0\r\n");
  EXPECT_NEAR(at_angle(function, 90), 1 / (4 * std::numbers::pi), 1e-7);
}

TEST(PhaseTable, SaysWhatIsWrongAndWhere) {
  const std::string shape = "should read 'angle value', two numbers, the angle in degrees";
  EXPECT_EQ(message("0 1\n90 x\n180 1\n"), "table.txt:2: '90 x' " + shape);
  EXPECT_EQ(message("0 1\n\n90\n180 1\n"), "table.txt:3: '90' " + shape);
  EXPECT_EQ(message("0 1\n90 1 2\n180 1\n"), "table.txt:2: '90 1 2' " + shape);
  EXPECT_EQ(message("0, 1\n"), "table.txt:1: '0, 1' " + shape);
  EXPECT_EQ(message("0 1\n90 1e999\n180 1\n"), "table.txt:2: '90 1e999' " + shape);
  EXPECT_EQ(message("0 1\n90 nan\n180 1\n"), "table.txt:2: the value is not finite");
  EXPECT_EQ(message("0 inf\n180 1\n"), "table.txt:1: the value is not finite");
  EXPECT_EQ(message("0 1\nnan 1\n180 1\n"), "table.txt:2: the angle is not finite");
  EXPECT_EQ(message("0 1\n90 -0.5\n180 1\n"), "table.txt:2: the value -0.5 is negative");
  EXPECT_EQ(message("1 1\n180 1\n"), "table.txt:1: the first angle must be 0 and is 1");
  EXPECT_EQ(message("-1 1\n180 1\n"), "table.txt:1: the first angle must be 0 and is -1");
  EXPECT_EQ(message("0 1\n# the end\n179 1\n"),
            "table.txt:3: the last angle must be 180 and is 179");
  EXPECT_EQ(message("0 1\n180 1\n181 1\n"), "table.txt:3: the angle 181 is above 180 degrees");
  EXPECT_EQ(message("0 1\n90 1\n90 2\n180 1\n"),
            "table.txt:3: angles must rise by 1e-05 or more, and 90 follows 90");
  EXPECT_EQ(message("0 1\n90 1\n80 2\n180 1\n"),
            "table.txt:3: angles must rise by 1e-05 or more, and 80 follows 90");
  EXPECT_EQ(message("0 0\n90 0\n180 0\n"), "table.txt:3: all values are 0");
  const std::string few = "a phase function needs two points or more, at 0 and 180 degrees";
  EXPECT_EQ(message(""), "table.txt:1: " + few);
  EXPECT_EQ(message("# nothing\n\n"), "table.txt:2: " + few);
  EXPECT_EQ(message("\n0 1\n"), "table.txt:2: " + few);
}

TEST(PhaseTable, NamesThePointWithoutAFile) {
  const std::vector<PhaseTablePoint> points = {{0, 1}, {90, -1}, {180, 1}};
  try {
    PhaseFunction::tabulated(points);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "phase table, point 1: the value -1 is negative");
  }
}

}  // namespace
}  // namespace freepath
