#include "freepath/study/lab_statistics.h"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numbers>
#include <vector>

namespace freepath {
namespace {

/// Fewer contributions than this are counted, not averaged.
constexpr uint64_t kFew = 500;
/// An expectation that so few contributions of 1 would make up says nothing about rare events.
constexpr double kFewExpected = 100;
constexpr double kLargestSkewness = 0.05;
constexpr double kLargestExcess = 0.01;
/// Single precision, relative to what is expected: some hundred terms of a sum.
constexpr double kWeightRounding = 2e-5;
/// Bins of the test of a distribution, at most.
constexpr double kTestBins = 32;
/// What a bin of it expects at least, in weights of 1, and the contributions that it needs.
constexpr double kFewestInTestBin = 1500;
constexpr uint64_t kFewInBin = 100;
/// What stands for an infinite distance.
constexpr double kFar = 1000;

/// |z| of a normal deviate that is as unlikely as p.
double z_of_p(double p) {
  if (!(p > 0)) return 40;
  double low = 0;
  double high = 40;  // beyond it p underflows
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (normal_two_sided_p(middle) > p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Neighbouring bins, together.
struct MergedBin {
  LabMoments moments;
  double exact = 0;

  /// Mean square of what paths contribute, in proportion to the exact mean: of fewer paths than
  /// expected the squares are too small by as much as the sum. Unless the sum is lost in its noise.
  double mean_square(uint64_t paths) const {
    const double ratio = moments.squares / moments.sum;
    const bool clear = moments.mean(paths) > 5 * moments.standard_error(paths);
    return clear ? ratio * exact : moments.squares / static_cast<double>(paths);
  }
};

/// Merges neighbours until each expects its share, by what is exact alone: a choice by what was
/// seen would spoil the test.
std::vector<MergedBin> merge_bins(std::span<const LabMoments> bins, std::span<const double> exact,
                                  double paths) {
  double whole = 0;
  for (const double expected : exact) whole += expected;
  const double share = std::max(whole / kTestBins, kFewestInTestBin / paths);
  std::vector<MergedBin> merged(1);
  double left = whole;
  for (std::size_t bin = 0; bin < bins.size(); ++bin) {
    if (merged.back().exact >= share && left >= share) merged.emplace_back();
    merged.back().moments.merge(bins[bin]);
    merged.back().exact += exact[bin];
    left -= exact[bin];
  }
  return merged;
}

}  // namespace

bool LabMoments::has_normal_mean(uint64_t paths) const {
  const auto n = static_cast<double>(paths);
  const double m = mean(paths);
  const double spread = variance(paths);
  if (spread <= 1e-10 * m * m) return true;
  const double third = cubes / n - 3 * m * squares / n + 2 * m * m * m;
  const double fourth =
      fourths / n - 4 * m * cubes / n + 6 * m * m * squares / n - 3 * m * m * m * m;
  const double skewness = third / (spread * std::sqrt(spread));
  const double kurtosis = fourth / (spread * spread);
  return std::abs(skewness) <= kLargestSkewness * std::sqrt(n) && kurtosis <= kLargestExcess * n;
}

LabCheck check_mean(const LabMoments& moments, uint64_t paths, double exact) {
  LabCheck check;
  check.exact = exact;
  check.estimate = moments.mean(paths);
  check.standard_error = moments.standard_error(paths);
  const double off = check.estimate - exact;
  if (!std::isfinite(off)) {  // no mean at all: that counts
    check.z = kFar;
    check.p = 0;
    return check;
  }
  const double beyond = std::max(0.0, std::abs(off) - kWeightRounding * std::abs(exact));
  const double z = beyond == 0 ? 0 : beyond / check.standard_error;
  check.z = std::copysign(std::min(z, kFar), off);
  check.p = normal_two_sided_p(check.z);
  if (moments.contributions < kFew || exact * static_cast<double>(paths) < kFewExpected) {
    check.standing = LabStanding::kRare;
  } else if (!moments.has_normal_mean(paths)) {
    check.standing = LabStanding::kHeavy;
  }
  return check;
}

LabCheck check_distribution(std::span<const LabMoments> bins, std::span<const double> exact,
                            uint64_t paths) {
  LabCheck check;
  const auto n = static_cast<double>(paths);
  double distance = 0;
  double across = 0;
  double inner = 0;
  std::size_t freedom = 0;
  std::size_t heavy = 0;
  for (const MergedBin& bin : merge_bins(bins, exact, n)) {
    check.estimate += bin.moments.sum / n;
    check.exact += bin.exact;
    if (!std::isfinite(bin.moments.sum)) {
      check.z = kFar;
      check.p = 0;
      return check;
    }
    const bool few = bin.moments.contributions < kFewInBin;
    if (few || !bin.moments.has_normal_mean(paths)) {  // counts with the escapes, so to speak
      heavy += few ? 0 : 1;
      continue;
    }
    ++freedom;
    const double square = bin.mean_square(paths);
    const double apart = bin.moments.sum / n - bin.exact;
    distance += apart * apart / square;
    across += apart * bin.exact / square;
    inner += bin.exact * bin.exact / square;
  }
  if (freedom < 2) {
    check.standing = heavy > 0 ? LabStanding::kHeavy : LabStanding::kRare;
    return check;
  }
  // Where hardly a path ends elsewhere or with another weight, the last distance follows from the
  // others.
  const bool complete = n * (1 - inner) < kFewExpected;
  const double statistic = n * (complete ? distance : distance + across * across / (1 - inner));
  const auto degrees = static_cast<double>(complete ? freedom - 1 : freedom);
  check.p = std::isfinite(statistic) ? boost::math::gamma_q(0.5 * degrees, 0.5 * statistic) : 0;
  check.z = z_of_p(check.p);
  return check;
}

double normal_two_sided_p(double z) { return std::erfc(std::abs(z) / std::numbers::sqrt2); }

}  // namespace freepath
