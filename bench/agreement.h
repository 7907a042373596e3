#pragma once
/// @file The test that variants of a benchmark walk the same problem: their means are the same.

#include <cmath>

namespace freepath::bench {

/// Standard errors that means may differ by; with a hundred comparisons less than one chance in a
/// thousand.
inline constexpr double kLargestDifference = 4.5;

struct Mean {
  double value;
  double variance;  ///< Of the mean.
};

inline Mean mean(double sum, double sum_squared, double count) {
  const double value = sum / count;
  return {value, (sum_squared / count - value * value) / (count - 1)};
}

inline bool agree(const Mean& a, const Mean& b) {
  return std::abs(a.value - b.value) <= kLargestDifference * std::sqrt(a.variance + b.variance);
}

}  // namespace freepath::bench
