#include "freepath/study/interval.h"

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <vector>

namespace freepath {

Interval mean_interval(std::span<const double> values) {
  if (values.empty()) return {};
  const auto count = static_cast<double>(values.size());
  double sum = 0;
  for (const double value : values) sum += value;
  Interval interval{.value = sum / count};
  if (values.size() < 2) return interval;
  double squares = 0;
  for (const double value : values) {
    squares += (value - interval.value) * (value - interval.value);
  }
  const boost::math::students_t student(count - 1);
  const double half_width = boost::math::quantile(student, 0.5 + 0.5 * kConfidence) *
                            std::sqrt(squares / (count - 1) / count);
  interval.low = interval.value - half_width;
  interval.high = interval.value + half_width;
  return interval;
}

std::optional<Interval> geometric_interval(std::span<const double> values) {
  std::vector<double> logarithms;
  for (const double value : values) {
    if (!(value > 0) || !std::isfinite(value)) return {};
    logarithms.push_back(std::log(value));
  }
  if (logarithms.empty()) return {};
  Interval interval = mean_interval(logarithms);
  interval.value = std::exp(interval.value);
  if (interval.low) interval.low = std::exp(*interval.low);
  if (interval.high) interval.high = std::exp(*interval.high);
  return interval;
}

double level_of_each(double level, std::size_t tests) {
  if (tests == 0) return level;
  return -std::expm1(std::log1p(-level) / static_cast<double>(tests));
}

double family_wise_threshold(double level, std::size_t tests) {
  return -boost::math::quantile(boost::math::normal(), 0.5 * level_of_each(level, tests));
}

}  // namespace freepath
