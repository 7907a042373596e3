#pragma once
/// @file First and second moments of independent values.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace freepath {

/// A mean and its standard error, from the variance of single values.
struct Estimate {
  double mean = 0;
  double error = 0;
  /// Upper limit at a confidence of 95 %, where no value was other than 0 although some could be:
  /// the mean and the error are 0 then, and say nothing.
  std::optional<double> upper;
};

/// Sums over values, most of which may be 0 and are not added. Sums depend on the order in double
/// precision's last digits, so it should always be the same.
struct Moments {
  double sum = 0;
  double squares = 0;
  uint64_t contributions = 0;  ///< Values that were not 0.

  void add(double value) {
    sum += value;
    squares += value * value;
    if (value != 0) ++contributions;
  }
  void merge(const Moments& other) {
    sum += other.sum;
    squares += other.squares;
    contributions += other.contributions;
  }
  /// Mean of all values.
  /// @param count of all values, here and below
  double mean(uint64_t count) const { return sum / static_cast<double>(count); }
  /// Variance of single values; infinite where a square is. Of one value alone its square stands
  /// in, which is not below the variance on average.
  double variance(uint64_t count) const {
    const auto n = static_cast<double>(count);
    if (count < 2 || !std::isfinite(squares)) return squares / n;
    return std::max(0.0, squares - sum / n * sum) / (n - 1);
  }
  /// Standard error of the mean.
  double standard_error(uint64_t count) const {
    return std::sqrt(variance(count) / static_cast<double>(count));
  }
  /// @param possible whether values can be other than 0 at all
  Estimate estimate(uint64_t count, bool possible = true) const {
    Estimate estimate{mean(count), standard_error(count), {}};
    // With 95 % confidence fewer than this share of the values are not 0.
    if (possible && contributions == 0) {
      estimate.upper = 1 - std::pow(0.05, 1 / static_cast<double>(count));
    }
    return estimate;
  }
};

}  // namespace freepath
