#include "freepath/report/axis_ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace freepath {

namespace {

constexpr std::string_view kMinus = "\u2212";
constexpr std::string_view kTimes = "\u00D7";
constexpr std::string_view kThinSpace = "\u2009";
// Rounding of a value that is meant to be a multiple of a step.
constexpr double kSlack = 1e-9;

/// With a minus, and thin spaces between thousands from five digits on.
std::string typeset(std::string number) {
  std::string sign;
  if (!number.empty() && number[0] == '-') {
    number.erase(0, 1);
    // No "−0.0".
    if (number.find_first_not_of("0.") != std::string::npos) sign = kMinus;
  }
  const std::size_t point = std::min(number.find('.'), number.size());
  if (point > 4) {
    for (std::size_t offset = point - 3;; offset -= 3) {
      number.insert(offset, kThinSpace);
      if (offset <= 3) break;
    }
  }
  return sign + number;
}

int exponent_of(double value) { return static_cast<int>(std::floor(std::log10(value) + kSlack)); }

/// Labels for multiples of a step: all with as many decimals, all with the same power of ten.
class StepLabels {
 public:
  StepLabels(double largest, double step) : step_(step) {
    if (largest >= 1e6 || largest < 1e-3) exponent_ = exponent_of(largest);
    decimals_ = std::clamp((exponent_ ? exponent_ : 0) - exponent_of(step), 0, 12);
  }

  TickLabel label(double value) const {
    if (std::abs(value) < step_ * kSlack) return {"0"};
    const std::string mantissa = typeset(fmt::format("{:.{}f}", scaled(value), decimals_));
    if (exponent_ == 0) return {mantissa};
    return {fmt::format("{}{}10", mantissa, kTimes), typeset(fmt::format("{}", exponent_))};
  }

 private:
  double scaled(double value) const {
    return exponent_ == 0 ? value : value / std::pow(10.0, exponent_);
  }

  double step_;
  int exponent_ = 0;  ///< 0: written without one.
  int decimals_ = 0;
};

std::vector<AxisTick> linear_ticks(double minimum, double maximum, double wanted) {
  const double step = nice_step(maximum - minimum, wanted);
  const StepLabels labels(std::max(std::abs(minimum), std::abs(maximum)), step);
  std::vector<AxisTick> ticks;
  const double first = std::ceil(minimum / step - kSlack);
  const double count = std::floor(maximum / step + kSlack) - first;
  for (double i = 0; i <= std::min(count, 100.0); ++i) {
    const double value = (first + i) * step;
    ticks.push_back({value, labels.label(value)});
  }
  return ticks;
}

/// Powers of ten are written out where all of them are short.
TickLabel log_label(int mantissa, int exponent, bool written_out) {
  if (written_out) {
    return {typeset(
        fmt::format("{:.{}f}", mantissa * std::pow(10.0, exponent), std::max(0, -exponent)))};
  }
  const std::string power = typeset(fmt::format("{}", exponent));
  if (mantissa == 1) return {"10", power};
  return {fmt::format("{}{}10", mantissa, kTimes), power};
}

/// m · 10^e, for m from 1 to 9, from minimum to maximum.
struct LogValue {
  double value = 0;
  int mantissa = 1, exponent = 0;
};

std::vector<LogValue> log_values(double minimum, double maximum) {
  std::vector<LogValue> values;
  const int last = exponent_of(maximum);
  for (int exponent = exponent_of(minimum); exponent <= last; ++exponent) {
    for (int mantissa = 1; mantissa <= 9; ++mantissa) {
      const double value = mantissa * std::pow(10.0, exponent);
      if (value >= minimum * (1 - kSlack) && value <= maximum * (1 + kSlack)) {
        values.push_back({value, mantissa, exponent});
      }
    }
  }
  return values;
}

std::vector<AxisTick> log_ticks(double minimum, double maximum, double wanted) {
  const std::vector<LogValue> values = log_values(minimum, maximum);
  const auto count = [&](auto&& is_counted) {
    return std::count_if(values.begin(), values.end(), is_counted);
  };
  const auto is_power = [](const LogValue& v) { return v.mantissa == 1; };
  const auto is_125 = [](const LogValue& v) {
    return v.mantissa == 1 || v.mantissa == 2 || v.mantissa == 5;
  };
  const auto powers = count(is_power);
  const bool by_decades = powers >= 3;
  if (!by_decades && count(is_125) < 3) return linear_ticks(minimum, maximum, wanted);

  const bool written_out = minimum >= 0.9e-3 && maximum < (by_decades ? 2e4 : 2e5);
  const int stride =
      std::max(1, static_cast<int>(std::ceil(static_cast<double>(powers) / std::max(wanted, 2.0))));
  std::vector<AxisTick> ticks;
  for (const LogValue& value : values) {
    const bool is_labelled =
        by_decades ? is_power(value) && value.exponent % stride == 0 : is_125(value);
    // Where decades are left out, only they are marked.
    if (!is_labelled && stride > 1 && !is_power(value)) continue;
    ticks.push_back(
        {value.value,
         is_labelled ? log_label(value.mantissa, value.exponent, written_out) : TickLabel{},
         !is_labelled});
  }
  return ticks;
}

std::string superscript(int exponent) {
  constexpr std::array<std::string_view, 10> kDigits = {"⁰", "¹", "²", "³", "⁴",
                                                        "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string result;
  for (const char digit : fmt::format("{}", exponent)) {
    result += digit == '-' ? std::string_view("⁻") : kDigits[digit - '0'];
  }
  return result;
}

}  // namespace

AxisScale::AxisScale(double minimum, double maximum, bool logarithmic)
    : minimum_(minimum), maximum_(maximum), logarithmic_(logarithmic) {}

double AxisScale::position(double value) const {
  if (!logarithmic_) return (value - minimum_) / (maximum_ - minimum_);
  if (!(value > 0)) return std::nan("");
  // A difference of logarithms: the ratio of large and small numbers may be too large for one.
  const double begin = std::log(minimum_);
  return (std::log(value) - begin) / (std::log(maximum_) - begin);
}

double nice_step(double length, double wanted) {
  const double rough = length / std::max(wanted, 1.0);
  const double power = std::pow(10.0, exponent_of(rough));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1 - kSlack)) return factor * power;
  }
  return 10 * power;
}

std::vector<AxisTick> axis_ticks(const AxisScale& scale, double wanted) {
  return scale.logarithmic() ? log_ticks(scale.minimum(), scale.maximum(), wanted)
                             : linear_ticks(scale.minimum(), scale.maximum(), wanted);
}

std::string readable_number(double value, int digits) {
  if (std::isnan(value)) return "\u2013";
  if (std::isinf(value)) return value > 0 ? "\u221E" : fmt::format("{}\u221E", kMinus);
  if (value == 0) return "0";
  // Rounded first: 999.96 with four digits is 1000.
  const std::string scientific = fmt::format("{:.{}e}", value, digits - 1);
  const std::size_t e = scientific.find('e');
  const int exponent = std::stoi(scientific.substr(e + 1));
  if (exponent < -4 || exponent >= 6) {
    std::string mantissa = scientific.substr(0, e);
    if (mantissa.find('.') != std::string::npos) {
      mantissa.erase(mantissa.find_last_not_of('0') + 1);
      if (mantissa.back() == '.') mantissa.pop_back();
    }
    return fmt::format("{}{}10{}", typeset(mantissa), kTimes, superscript(exponent));
  }
  return typeset(fmt::format("{:.{}f}", value, std::max(0, digits - 1 - exponent)));
}

}  // namespace freepath
