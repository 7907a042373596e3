#include "freepath/sensors/pixel_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "tests/statistics.h"

namespace freepath {
namespace {

using testing::check_mean;
using testing::family_wise_threshold;
using testing::RunningStatistics;

struct FilterCase {
  std::string name;
  FilterModel model;
  bool is_positive;
};

/// All filters with the defaults, and with parameters that put zeros and edges off the tables'
/// nodes.
std::vector<FilterCase> cases() {
  return {{"box", BoxFilter{}, true},
          {"box 1.3 x 0.4", BoxFilter{1.3, 0.4}, true},
          {"gaussian", GaussianFilter{}, true},
          {"gaussian, narrow", GaussianFilter{3, 2, 0.07}, true},
          {"gaussian, wide", GaussianFilter{0.9, 1.7, 50}, true},
          {"mitchell", MitchellFilter{}, false},
          {"mitchell, Catmull-Rom", MitchellFilter{1.1, 3, 0, 0.5}, false},
          {"mitchell, B-spline", MitchellFilter{2, 2, 1, 0}, true},
          {"sinc", SincFilter{}, false},
          {"sinc 2.7 x 3.3, tau 1.9", SincFilter{2.7, 3.3, 1.9}, false},
          {"sinc, long", SincFilter{7, 5, 7}, false},
          {"triangle", TriangleFilter{}, true},
          {"triangle 0.6 x 1.2", TriangleFilter{0.6, 1.2}, true}};
}

double integrate(const auto& f, double from, double to) {
  constexpr int kSteps = 2000;
  const double h = (to - from) / kSteps;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += f(from + (i + 0.5) * h) * h;
  return sum;
}

TEST(PixelFilter, HasTheShapesOfTheSceneLanguage) {
  const auto gaussian = [](double x, double radius, double sigma) {
    const auto bell = [&](double t) { return std::exp(-t * t / (2 * sigma * sigma)); };
    const double integral =
        sigma * std::sqrt(2 * std::numbers::pi) * std::erf(radius / (sigma * std::sqrt(2.0)));
    return (bell(x) - bell(radius)) / (integral - 2 * radius * bell(radius));
  };
  const auto sinc = [](double x) {
    return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
  };
  const PixelFilter box(BoxFilter{1.5, 0.25});
  const PixelFilter bell(GaussianFilter{1.5, 2, 0.6});
  const PixelFilter triangle(TriangleFilter{2, 1});
  const PixelFilter mitchell(MitchellFilter{});
  const PixelFilter lanczos(SincFilter{});
  const double sinc_integral =
      integrate([&](double t) { return sinc(t) * sinc(t / 3); }, -4.0, 4.0);
  for (const double x : {-1.4, -0.7, 0.0, 0.3, 1.1}) {
    for (const double y : {-0.2, 0.0, 0.15}) {
      EXPECT_NEAR(box.evaluate(x, y), 1 / 1.5, 1e-12);
      EXPECT_NEAR(bell.evaluate(x, y) / (gaussian(x, 1.5, 0.6) * gaussian(y, 2, 0.6)), 1, 1e-7);
      EXPECT_NEAR(triangle.evaluate(x, y), (2 - std::abs(x)) / 4 * (1 - std::abs(y)), 1e-12);
      EXPECT_NEAR(lanczos.evaluate(x, y),
                  sinc(x) * sinc(x / 3) * sinc(y) * sinc(y / 3) / (sinc_integral * sinc_integral),
                  1e-6);
    }
  }
  // With B = C = 1/3 and a radius of 2 the cubic is 16/18 at 0, 1/18 at 1 and 0 at 2, and negative
  // between the last two, where it is (-7/3 x³ + 12 x² - 20 x + 32/3) / 6.
  EXPECT_NEAR(mitchell.evaluate(0, 0), 16.0 / 18 * 16 / 18, 1e-7);
  EXPECT_NEAR(mitchell.evaluate(-1, 0), 1.0 / 18 * 16 / 18, 1e-7);
  EXPECT_NEAR(mitchell.evaluate(0, 1.5),
              (-7.0 / 3 * 3.375 + 12 * 2.25 - 30 + 32.0 / 3) / 6 * 16 / 18, 1e-7);
  EXPECT_LT(mitchell.evaluate(0, 1.5), 0);
}

TEST(PixelFilter, IntegratesToOneWithinItsRadii) {
  for (const FilterCase& test : cases()) {
    SCOPED_TRACE(test.name);
    const PixelFilter filter(test.model);
    const double rx = filter.x_radius();
    const double ry = filter.y_radius();
    const double x_factor =
        integrate([&](double x) { return filter.evaluate(x, 0); }, -rx, rx) / filter.evaluate(0, 0);
    EXPECT_NEAR(x_factor * integrate([&](double y) { return filter.evaluate(0, y); }, -ry, ry), 1,
                1e-5);
    EXPECT_EQ(filter.evaluate(rx * 1.0001, 0), 0);
    EXPECT_EQ(filter.evaluate(0, -ry * 1.0001), 0);
  }
}

TEST(PixelFilter, SamplesReproduceTheFilter) {
  constexpr int kSamples = 500'000;
  constexpr int kSide = 12;
  for (const FilterCase& test : cases()) {
    SCOPED_TRACE(test.name);
    const PixelFilter filter(test.model);
    const double rx = filter.x_radius();
    const double ry = filter.y_radius();
    std::vector<double> sums(kSide * kSide);
    std::vector<double> squares(kSide * kSide);
    RunningStatistics weights;
    RunningStatistics x_squared;
    RunningStatistics y_squared;
    RunningStatistics xs;
    RandomStream random(11, 0, 0, 0);
    for (int i = 0; i < kSamples; ++i) {
      const float u = random.uniform();
      const FilterSample sample = filter.sample(u, random.uniform());
      ASSERT_LE(std::abs(sample.x), rx * (1 + 1e-6));
      ASSERT_LE(std::abs(sample.y), ry * (1 + 1e-6));
      ASSERT_TRUE(sample.weight >= 0 || !test.is_positive);
      const double w = sample.weight;
      weights.add(w);
      xs.add(w * sample.x);
      x_squared.add(w * sample.x * sample.x);
      y_squared.add(w * sample.y * sample.y);
      const auto bin = [](double t) {
        return std::clamp(static_cast<int>((t + 1) / 2 * kSide), 0, kSide - 1);
      };
      const int cell = bin(sample.y / ry) * kSide + bin(sample.x / rx);
      sums[cell] += w;
      squares[cell] += w * w;
    }
    EXPECT_TRUE(
        check_mean("weight", weights, 1, {.absolute = 2e-7, .largest_relative_error = 0.004}));
    EXPECT_TRUE(check_mean("x", xs, 0));
    // Moments of one factor: the filter along an axis, normalised.
    const auto factor_x = [&](double x) { return filter.evaluate(x, 0); };
    const auto factor_y = [&](double y) { return filter.evaluate(0, y); };
    const double total_x = integrate(factor_x, -rx, rx);
    const double total_y = integrate(factor_y, -ry, ry);
    const double second_x =
        integrate([&](double x) { return x * x * factor_x(x); }, -rx, rx) / total_x;
    const double second_y =
        integrate([&](double y) { return y * y * factor_y(y); }, -ry, ry) / total_y;
    EXPECT_TRUE(check_mean("x²", x_squared, second_x, {.absolute = 1e-6 * rx * rx}));
    EXPECT_TRUE(check_mean("y²", y_squared, second_y, {.absolute = 1e-6 * ry * ry}));
    const double threshold = family_wise_threshold(1e-4, kSide * kSide);
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        const auto edge = [](int i, double radius) { return radius * (2.0 * i / kSide - 1); };
        const double expected = integrate(factor_x, edge(column, rx), edge(column + 1, rx)) /
                                total_x * integrate(factor_y, edge(row, ry), edge(row + 1, ry)) /
                                total_y;
        const int cell = row * kSide + column;
        const double mean = sums[cell] / kSamples;
        const double error =
            std::sqrt(std::max(0.0, squares[cell] / kSamples - mean * mean) / kSamples);
        // Five samples' worth: cells that hardly any reach are not normally distributed.
        EXPECT_TRUE(check_mean("cell", mean, error, kSamples, expected,
                               {.z = threshold, .absolute = 5.0 / kSamples}));
      }
    }
  }
}

TEST(PixelFilter, SamplesNextToProportionallyToTheFilter) {
  for (const FilterCase& test : cases()) {
    SCOPED_TRACE(test.name);
    const PixelFilter filter(test.model);
    const double rx = filter.x_radius();
    const double ry = filter.y_radius();
    const auto absolute_share = [&](const auto& f, double radius) {
      return integrate([&](double t) { return std::abs(f(t)); }, -radius, radius) /
             integrate(f, -radius, radius);
    };
    const double magnitude = absolute_share([&](double x) { return filter.evaluate(x, 0); }, rx) *
                             absolute_share([&](double y) { return filter.evaluate(0, y); }, ry);
    RandomStream random(12, 0, 0, 0);
    int negative = 0;
    int off = 0;
    constexpr int kSamples = 20'000;
    for (int i = 0; i < kSamples; ++i) {
      const float u = random.uniform();
      const float weight = filter.sample(u, random.uniform()).weight;
      if (weight < 0) ++negative;
      if (std::abs(std::abs(weight) / magnitude - 1) > 0.01) ++off;
      EXPECT_LE(std::abs(weight), 1.05 * magnitude);
    }
    EXPECT_EQ(negative > 0, !test.is_positive);
    // Only where |f| has a kink, or ends flat, does its interpolant differ.
    EXPECT_LE(off, kSamples / 50);
  }
  for (const FilterModel& model : {FilterModel(BoxFilter{}), FilterModel(TriangleFilter{})}) {
    const PixelFilter filter(model);
    RandomStream random(13, 0, 0, 0);
    for (int i = 0; i < 1000; ++i) {
      const float u = random.uniform();
      EXPECT_NEAR(filter.sample(u, random.uniform()).weight, 1, 1e-6);
    }
  }
}

TEST(PixelFilter, KeepsTheOrderOfTheNumbers) {
  for (const FilterCase& test : cases()) {
    SCOPED_TRACE(test.name);
    const PixelFilter filter(test.model);
    FilterSample last = filter.sample(0, 0);
    EXPECT_NEAR(last.x, -filter.x_radius(), 1e-3 * filter.x_radius());
    for (int i = 1; i < 10'000; ++i) {
      const float u = static_cast<float>(i) / 10'000;
      const FilterSample next = filter.sample(u, u);
      EXPECT_GE(next.x, last.x);
      EXPECT_GE(next.y, last.y);
      EXPECT_TRUE(std::isfinite(next.weight));
      last = next;
    }
    EXPECT_EQ(filter.sample(0.5F, 0.5F).x, 0);
  }
}

TEST(PixelFilter, RefusesWhatIsNoFilter) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1.0, kNan, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(PixelFilter(BoxFilter{bad, 1}), Error);
    EXPECT_THROW(PixelFilter(BoxFilter{1, bad}), Error);
    EXPECT_THROW(PixelFilter(TriangleFilter{bad, 1}), Error);
    EXPECT_THROW(PixelFilter(GaussianFilter{bad, 1, 1}), Error);
    EXPECT_THROW(PixelFilter(GaussianFilter{1, 1, bad}), Error);
    EXPECT_THROW(PixelFilter(SincFilter{1, 1, bad}), Error);
    EXPECT_THROW(PixelFilter(MitchellFilter{1, bad}), Error);
  }
  EXPECT_THROW(PixelFilter(MitchellFilter{2, 2, kNan, 0}), Error);
  EXPECT_THROW(PixelFilter(GaussianFilter{1, 1, 1e-9}), Error);
  EXPECT_THROW(PixelFilter(SincFilter{1e6, 1, 3}), Error);
}

}  // namespace
}  // namespace freepath
