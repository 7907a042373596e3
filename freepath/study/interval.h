#pragma once
/// @file What repeated measurements say: means and ratios with confidence intervals, and levels of
/// families of tests.

#include <cstddef>
#include <optional>
#include <span>

namespace freepath {

/// Confidence of every interval that reports state.
inline constexpr double kConfidence = 0.95;

/// A value and the interval that holds the true one with probability kConfidence.
struct Interval {
  double value = 0;
  std::optional<double> low = {}, high = {};  ///< None where there was one measurement alone.
};

/// Mean of values, with Student's interval.
Interval mean_interval(std::span<const double> values);

/// Geometric mean of positive values, with Student's interval of their logarithms: for ratios,
/// which vary by factors. Nothing where a value is not positive or not finite.
std::optional<Interval> geometric_interval(std::span<const double> values);

/// Level of each of so many independent tests, so that any of them raises a false alarm with
/// probability `level` (Šidák).
double level_of_each(double level, std::size_t tests);

/// Largest |z| to accept in each of `tests` two-sided tests so that all of them together raise a
/// false alarm with probability `level` (Šidák).
double family_wise_threshold(double level, std::size_t tests);

}  // namespace freepath
