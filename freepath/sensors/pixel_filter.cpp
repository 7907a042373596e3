#include "freepath/sensors/pixel_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "freepath/base/error.h"

namespace freepath {
namespace {

// One factor of each filter at a distance x >= 0 from the centre, not beyond the radius, up to a
// constant; and the distance over which it changes, which the steps of a table must resolve.

double shape(const BoxFilter& /*filter*/, double /*x*/, double /*radius*/) { return 1; }
double detail(const BoxFilter& /*filter*/, double radius) { return radius; }

double shape(const TriangleFilter& /*filter*/, double x, double radius) { return 1 - x / radius; }
double detail(const TriangleFilter& /*filter*/, double radius) { return radius; }

double shape(const GaussianFilter& filter, double x, double radius) {
  // exp(-here) - exp(-edge), without the cancellation that a wide Gaussian would suffer.
  const double inverse = 0.5 / (filter.sigma * filter.sigma);
  const double edge = radius * radius * inverse;
  const double here = x * x * inverse;
  return -std::expm1(here - edge) * std::exp(-here);
}
double detail(const GaussianFilter& filter, double radius) {
  return std::min(radius, filter.sigma);
}

double shape(const MitchellFilter& filter, double x, double radius) {
  const double b = filter.b;
  const double c = filter.c;
  const double t = 2 * x / radius;
  if (t < 1) return ((12 - 9 * b - 6 * c) * t + (-18 + 12 * b + 6 * c)) * t * t + (6 - 2 * b);
  return (((-b - 6 * c) * t + (6 * b + 30 * c)) * t + (-12 * b - 48 * c)) * t + (8 * b + 24 * c);
}
double detail(const MitchellFilter& /*filter*/, double radius) { return 0.25 * radius; }

double sinc(double x) {
  const double angle = std::numbers::pi * x;
  return std::abs(angle) < 1e-8 ? 1 : std::sin(angle) / angle;
}

double shape(const SincFilter& filter, double x, double /*radius*/) {
  return sinc(x) * sinc(x / filter.tau);
}
double detail(const SincFilter& filter, double radius) {
  return std::min({radius, 0.5, 0.5 * filter.tau});
}

double shape_of(const FilterModel& model, double x, double radius) {
  return std::visit([&](const auto& filter) { return shape(filter, x, radius); }, model);
}

void check_positive(const char* what, double value) {
  if (!(value > 0) || !std::isfinite(value)) {
    fail("the filter's {} is {}; it must be more than 0 and finite", what, value);
  }
}

const FilterModel& checked(const FilterModel& model) {
  std::visit(
      [](const auto& filter) {
        check_positive("xradius", filter.x_radius);
        check_positive("yradius", filter.y_radius);
      },
      model);
  if (const auto* gaussian = std::get_if<GaussianFilter>(&model)) {
    check_positive("sigma", gaussian->sigma);
  } else if (const auto* sinc_filter = std::get_if<SincFilter>(&model)) {
    check_positive("tau", sinc_filter->tau);
  } else if (const auto* mitchell = std::get_if<MitchellFilter>(&model)) {
    if (!std::isfinite(mitchell->b) || !std::isfinite(mitchell->c)) {
      fail("the filter's B and C are {} and {}; they must be finite", mitchell->b, mitchell->c);
    }
  }
  return model;
}

/// How many steps a table of [0, radius] needs.
std::size_t step_count(const FilterModel& model, double radius) {
  // One step holds the box and the triangle exactly.
  if (std::holds_alternative<BoxFilter>(model) || std::holds_alternative<TriangleFilter>(model)) {
    return 1;
  }
  const double features =
      radius / std::visit([&](const auto& filter) { return detail(filter, radius); }, model);
  constexpr double kMostFeatures = 4096;
  if (!(features <= kMostFeatures)) {
    fail("the filter changes {:.0f} times within its radius of {} pixels; choose a smaller radius",
         features, radius);
  }
  constexpr double kStepsPerFeature = 32;
  constexpr double kFewestSteps = 128;
  return static_cast<std::size_t>(std::ceil(std::max(kFewestSteps, kStepsPerFeature * features)));
}

}  // namespace

PixelFilter::Axis::Axis(const FilterModel& filter, double reach)
    : model(filter), radius(reach), is_box(std::holds_alternative<BoxFilter>(filter)) {
  const std::size_t steps = step_count(model, radius);
  const double width = radius / static_cast<double>(steps);
  const auto value = [&](double node) {
    return shape_of(model, std::min(node * width, radius), radius);
  };
  density.resize(steps + 1);
  cdf.resize(steps + 1);
  double integral = 0;
  density[0] = std::abs(value(0));
  for (std::size_t i = 0; i < steps; ++i) {
    const auto node = static_cast<double>(i);
    // Simpson's rule: the steps are short enough for seven digits.
    integral += (value(node) + 4 * value(node + 0.5) + value(node + 1)) * width / 6;
    density[i + 1] = std::abs(value(node + 1));
    cdf[i + 1] = cdf[i] + 0.5 * (density[i] + density[i + 1]) * width;
  }
  // Of a kernel with lobes that cancel nothing but noise would be left.
  constexpr double kSmallestShare = 1e-3;
  if (!(integral > kSmallestShare * cdf.back())) {
    fail(
        "the filter's positive and negative lobes cancel: its integral is {:g} of that of its "
        "absolute value",
        integral / cdf.back());
  }
  scale = 0.5 / integral;
  for (double& node : density) node *= 0.5 / cdf.back();
  for (std::size_t i = 0; i < steps; ++i) cdf[i] /= cdf.back();
  cdf.back() = 1;
}

double PixelFilter::Axis::evaluate(double x) const {
  const double distance = std::abs(x);
  return distance <= radius ? scale * shape_of(model, distance, radius) : 0;
}

PixelFilter::AxisSample PixelFilter::Axis::sample(float u) const {
  if (is_box) return {static_cast<float>(radius) * (2 * u - 1), 1};
  const double side = 2 * static_cast<double>(u) - 1;
  const double target = std::abs(side);
  const auto above = std::upper_bound(cdf.begin() + 1, cdf.end() - 1, target);
  const auto step = static_cast<std::size_t>(above - cdf.begin()) - 1;
  const double below = cdf[step];
  const double share = std::min((target - below) / (*above - below), 1.0);
  // The inverse of the integral of the density, linear from d0 to d1, without cancellation.
  const double d0 = density[step];
  const double d1 = density[step + 1];
  const double root = std::sqrt(d0 * d0 + share * (d1 * d1 - d0 * d0));
  const double t = share > 0 ? share * (d0 + d1) / (d0 + root) : 0;
  const auto steps = static_cast<double>(cdf.size() - 1);
  const double distance = std::min((static_cast<double>(step) + t) * (radius / steps), radius);
  const double used = d0 + t * (d1 - d0);
  const double weight = used > 0 ? scale * shape_of(model, distance, radius) / used : 0;
  return {static_cast<float>(std::copysign(distance, side)), static_cast<float>(weight)};
}

PixelFilter::PixelFilter(const FilterModel& model)
    : x_(checked(model), std::visit([](const auto& filter) { return filter.x_radius; }, model)),
      y_(model, std::visit([](const auto& filter) { return filter.y_radius; }, model)) {}

FilterSample PixelFilter::sample(float u0, float u1) const {
  const AxisSample x = x_.sample(u0);
  const AxisSample y = y_.sample(u1);
  return {x.x, y.x, x.weight * y.weight};
}

}  // namespace freepath
