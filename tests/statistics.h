#pragma once
/// @file Statistics for tests of Monte Carlo code: estimates with their standard errors, z-tests,
/// chi-square and binomial tests, and the level of a family of tests. How they are used, and why
/// with fixed seeds, is told in docs/testing.md.
/// @note Within namespace freepath GoogleTest's own names need a leading colon: `::testing::Test`.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace freepath::testing {

/// Mean and variance of a stream of values, by Welford's update: no cancellation for means that are
/// large against the spread.
class RunningStatistics {
 public:
  void add(double value) {
    ++count_;
    const double before = value - mean_;
    mean_ += before / static_cast<double>(count_);
    sum_of_squares_ += before * (value - mean_);
  }

  /// Adds what another accumulator saw, as if its values had been added here.
  void merge(const RunningStatistics& other) {
    if (other.count_ == 0) return;
    const auto mine = static_cast<double>(count_);
    const auto theirs = static_cast<double>(other.count_);
    const double apart = other.mean_ - mean_;
    count_ += other.count_;
    const double share = theirs / (mine + theirs);
    mean_ += apart * share;
    sum_of_squares_ += other.sum_of_squares_ + apart * apart * mine * share;
  }

  uint64_t count() const { return count_; }
  double mean() const { return mean_; }
  /// Unbiased estimate of the variance of one value; 0 for fewer than two values.
  double variance() const {
    return count_ < 2 ? 0 : sum_of_squares_ / static_cast<double>(count_ - 1);
  }
  /// Standard deviation of mean().
  double standard_error() const {
    return count_ == 0 ? 0 : std::sqrt(variance() / static_cast<double>(count_));
  }

 private:
  uint64_t count_ = 0;
  double mean_ = 0;
  double sum_of_squares_ = 0;  // of the distances from the mean
};

/// How many standard errors an estimate lies from what is expected. Infinite where an estimate
/// without error is off; NaN where an input is.
inline double z_score(double mean, double standard_error, double expected) {
  if (mean == expected && standard_error == 0) return 0;
  return (mean - expected) / standard_error;
}

/// P(Z ≤ z) of the standard normal distribution.
inline double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

/// P(|Z| ≥ |z|) of the standard normal distribution, accurate far into the tails.
inline double two_sided_p(double z) { return std::erfc(std::abs(z) / std::numbers::sqrt2); }

/// The z with P(Z ≤ z) = probability, for a probability in (0, 1).
inline double normal_quantile(double probability) {
  if (!(probability > 0 && probability < 1)) {
    throw std::invalid_argument("normal_quantile: the probability must lie in (0, 1)");
  }
  if (probability > 0.5) return -normal_quantile(1 - probability);
  double low = -40;  // below it the distribution function underflows
  double high = 0;
  for (int halving = 0; halving < 100; ++halving) {
    const double middle = 0.5 * (low + high);
    (normal_cdf(middle) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Level of each of `tests` independent tests so that all of them together raise a false alarm with
/// probability `level` (Šidák).
inline double family_wise_level(double level, std::size_t tests) {
  return -std::expm1(std::log1p(-level) / static_cast<double>(tests));
}

/// Largest |z| to accept in each of `tests` two-sided z-tests for a family-wise level.
inline double family_wise_threshold(double level, std::size_t tests) {
  return -normal_quantile(0.5 * family_wise_level(level, tests));
}

/// Q(a, x) = Γ(a, x) / Γ(a), the regularised upper incomplete gamma function, for a > 0, x ≥ 0:
/// the power series of 1 − Q left of the peak, Legendre's continued fraction right of it (evaluated
/// from the front by Lentz's method).
inline double upper_gamma(double a, double x) {
  if (!(a > 0) || !(x >= 0)) throw std::invalid_argument("upper_gamma: needs a > 0 and x >= 0");
  if (x == 0) return 1;
  if (std::isinf(x)) return 0;
  const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
  constexpr double kPrecision = 1e-16;
  constexpr int kMaxTerms = 1'000'000;
  if (x < a + 1) {
    double term = 1 / a;
    double sum = term;
    for (int n = 1; n < kMaxTerms && term > kPrecision * sum; ++n) {
      term *= x / (a + n);
      sum += term;
    }
    return 1 - scale * sum;
  }
  constexpr double kTiny = 1e-300;  // stands for a zero denominator
  double partial = x + 1 - a;
  double numerator_ratio = 1 / kTiny;
  double denominator_ratio = 1 / partial;
  double fraction = denominator_ratio;
  for (int n = 1; n < kMaxTerms; ++n) {
    const double factor = n * (a - n);
    partial += 2;
    denominator_ratio = partial + factor * denominator_ratio;
    if (std::abs(denominator_ratio) < kTiny) denominator_ratio = kTiny;
    denominator_ratio = 1 / denominator_ratio;
    numerator_ratio = partial + factor / numerator_ratio;
    if (std::abs(numerator_ratio) < kTiny) numerator_ratio = kTiny;
    const double step = numerator_ratio * denominator_ratio;
    fraction *= step;
    if (std::abs(step - 1) < kPrecision * 10) break;
  }
  return scale * fraction;
}

/// Result of a chi-square test.
struct ChiSquare {
  double statistic = 0;
  std::size_t degrees_of_freedom = 0;
  double p_value = 1;  ///< Probability of a statistic at least as large by chance.
};

/// Pearson's chi-square test of counts against expected counts of the same total. The bins with the
/// smallest expectations are pooled until no expected count is below 5, where the statistic would
/// not be chi-square distributed. A hit where none can be gives p = 0.
/// @param fitted how many parameters of the expectation were fitted to the counts
inline ChiSquare chi_square_test(std::span<const uint64_t> observed,
                                 std::span<const double> expected, std::size_t fitted = 0) {
  if (observed.size() != expected.size()) {
    throw std::invalid_argument("chi_square_test: as many counts as expectations are needed");
  }
  constexpr double kSmallestExpectation = 5;
  std::vector<std::size_t> order(observed.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
  ChiSquare result;
  std::vector<double> counts;
  std::vector<double> expectations;
  for (const std::size_t bin : order) {
    const auto count = static_cast<double>(observed[bin]);
    if (expected[bin] <= 0) {
      if (count > 0) return {std::numeric_limits<double>::infinity(), observed.size(), 0};
      continue;
    }
    if (expectations.empty() || expectations.back() >= kSmallestExpectation) {
      counts.push_back(count);
      expectations.push_back(expected[bin]);
    } else {
      counts.back() += count;
      expectations.back() += expected[bin];
    }
  }
  if (counts.size() > 1 && expectations.back() < kSmallestExpectation) {
    const double count = counts.back();
    const double expectation = expectations.back();
    counts.pop_back();
    expectations.pop_back();
    counts.back() += count;
    expectations.back() += expectation;
  }
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    const double difference = counts[bin] - expectations[bin];
    result.statistic += difference * difference / expectations[bin];
  }
  if (counts.size() <= fitted + 1) return {result.statistic, 0, 1};
  result.degrees_of_freedom = counts.size() - 1 - fitted;
  result.p_value =
      upper_gamma(0.5 * static_cast<double>(result.degrees_of_freedom), 0.5 * result.statistic);
  return result;
}

/// Two-sided p-value of `hits` in `trials`, each with the given probability: twice the exact tail
/// on the side of the outcome, at most 1. For counts too small for a z-test.
inline double binomial_two_sided_p(uint64_t hits, uint64_t trials, double probability) {
  if (hits > trials || !(probability >= 0 && probability <= 1)) {
    throw std::invalid_argument("binomial_two_sided_p: needs hits <= trials, probability in [0,1]");
  }
  if (probability == 0) return hits == 0 ? 1 : 0;
  if (probability == 1) return hits == trials ? 1 : 0;
  const auto n = static_cast<double>(trials);
  auto k = static_cast<double>(hits);
  const double odds = probability / (1 - probability);
  double term = std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) +
                         k * std::log(probability) + (n - k) * std::log1p(-probability));
  const double direction = k <= n * probability ? -1 : 1;
  double tail = term;
  // Away from the mean the terms fall faster than a geometric series.
  while (term > 1e-18 * tail && (direction < 0 ? k > 0 : k < n)) {
    term *= direction < 0 ? k / ((n - k + 1) * odds) : (n - k) * odds / (k + 1);
    k += direction;
    tail += term;
  }
  return std::min(1.0, 2 * tail);
}

/// What check_mean accepts.
struct MeanTolerance {
  double z = 4;         ///< Largest distance in standard errors.
  double absolute = 0;  ///< Allowed on top of it, for rounding.
  /// Largest standard error as a fraction of the expected value: how sharp a test must be to count.
  double largest_relative_error = std::numeric_limits<double>::infinity();
};

/// Success if an estimate agrees with what is expected, else a text with name, estimate, standard
/// error, expectation, z and n. Use: `EXPECT_TRUE(check_mean("reflectance", ...))`.
inline ::testing::AssertionResult check_mean(std::string_view name, double mean,
                                             double standard_error, uint64_t count, double expected,
                                             const MeanTolerance& tolerance = {}) {
  const double z = z_score(mean, standard_error, expected);
  // Written so that a NaN fails.
  const bool agrees =
      std::abs(mean - expected) <= tolerance.z * standard_error + tolerance.absolute;
  const bool sharp = !(standard_error > tolerance.largest_relative_error * std::abs(expected));
  auto result = agrees && sharp ? ::testing::AssertionSuccess() : ::testing::AssertionFailure();
  result << name << ": estimate " << mean << " +- " << standard_error << ", expected " << expected
         << ", z = " << z << " (at most " << tolerance.z << "), n = " << count;
  if (!sharp) {
    result << "; the standard error is more than " << tolerance.largest_relative_error
           << " of the expected value: take more samples";
  }
  return result;
}

inline ::testing::AssertionResult check_mean(std::string_view name,
                                             const RunningStatistics& statistics, double expected,
                                             const MeanTolerance& tolerance = {}) {
  return check_mean(name, statistics.mean(), statistics.standard_error(), statistics.count(),
                    expected, tolerance);
}

/// Success if a chi-square test does not reject at the level given, else a text with its numbers.
inline ::testing::AssertionResult check_chi_square(std::string_view name, const ChiSquare& test,
                                                   double level = 1e-4) {
  auto result =
      test.p_value >= level ? ::testing::AssertionSuccess() : ::testing::AssertionFailure();
  return result << name << ": chi-square " << test.statistic << " with " << test.degrees_of_freedom
                << " degrees of freedom, p = " << test.p_value << " (at least " << level << ")";
}

}  // namespace freepath::testing
