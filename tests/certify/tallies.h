#pragma once
/// @file What certification gathers of paths.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace freepath::testing {

/// The mean of n values is taken for normal far into its tails if their skewness is below the first
/// times √n, and their kurtosis below the second times n (the next terms of Edgeworth's series).
inline constexpr double kLargestSkewness = 0.05;
inline constexpr double kLargestKurtosis = 0.01;

/// Power sums of what paths contribute.
struct PowerSums {
  uint64_t count = 0;  ///< Of contributions that are not 0.
  double sum = 0, squares = 0, cubes = 0, fourths = 0;
  bool unit = true;  ///< Whether every contribution was 1.

  void add(double value) {
    if (value == 0) return;
    ++count;
    sum += value;
    squares += value * value;
    cubes += value * value * value;
    fourths += value * value * value * value;
    unit = unit && value == 1;
  }
  double variance(double paths) const {
    return std::max(0.0, squares / paths - sum / paths * (sum / paths));
  }
  double skewness(double paths) const {
    const double spread = variance(paths);
    const double mean = sum / paths;
    if (spread <= 1e-10 * mean * mean) return 0;
    const double third = cubes / paths - 3 * mean * squares / paths + 2 * mean * mean * mean;
    return third / (spread * std::sqrt(spread));
  }
  /// How many paths make their mean normal.
  double paths_for_normal_mean(double paths) const {
    const double spread = variance(paths);
    const double mean = sum / paths;
    if (spread <= 1e-10 * mean * mean) return 0;
    const double fourth = fourths / paths - 4 * mean * cubes / paths +
                          6 * mean * mean * squares / paths - 3 * std::pow(mean, 4);
    const double kurtosis = fourth / (spread * spread);
    return std::max(std::pow(skewness(paths) / kLargestSkewness, 2), kurtosis / kLargestKurtosis);
  }
};

/// What is gathered of one channel.
struct ChannelTally {
  std::vector<double> edges;  ///< Of the bins [world].
  PowerSums radiance;
  PowerSums escaped;
  std::vector<PowerSums> bins;
};

}  // namespace freepath::testing
