#include "freepath/spectra/linear_spectrum.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <system_error>
#include <utility>

#include "freepath/base/counted.h"
#include "freepath/base/error.h"

namespace freepath {
namespace {

/// The inverse of the distance of samples that stand exactly at first + step * index, else 0.
double find_inverse_step(std::span<const double> wavelengths) {
  if (wavelengths.size() < 2) return 0;
  const double step = wavelengths[1] - wavelengths[0];
  for (std::size_t i = 0; i < wavelengths.size(); ++i) {
    if (wavelengths[i] != wavelengths[0] + step * static_cast<double>(i)) return 0;
  }
  return 1 / step;
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ','; }

/// The numbers of a text, with the line that each stands in.
struct Number {
  double value = 0;
  int line = 1;
};

std::vector<Number> read_numbers(std::string_view text, std::string_view source) {
  std::vector<Number> numbers;
  int line = 1;
  std::size_t offset = 0;
  while (offset < text.size()) {
    if (is_space(text[offset])) {
      if (text[offset] == '\n') ++line;
      ++offset;
    } else if (text[offset] == '#') {
      offset = std::min(text.find('\n', offset), text.size());
    } else {
      std::size_t end = offset;
      while (end < text.size() && !is_space(text[end]) && text[end] != '#') ++end;
      std::string_view word = text.substr(offset, end - offset);
      offset = end;
      const std::string_view written = word.substr(0, 40);
      if (word.starts_with('+')) word.remove_prefix(1);
      double value = 0;
      const auto [rest, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (problem != std::errc() || rest != word.data() + word.size() || !std::isfinite(value)) {
        fail("{}:{}: '{}' is not a finite number", source, line, written);
      }
      numbers.push_back({value, line});
    }
  }
  return numbers;
}

}  // namespace

LinearSpectrum::LinearSpectrum(std::vector<double> wavelengths, std::vector<double> values,
                               OutsideSamples outside) {
  if (wavelengths.empty()) fail("a sampled spectrum needs at least one wavelength and value");
  if (wavelengths.size() != values.size()) {
    fail("a sampled spectrum has {} but {}", counted(wavelengths.size(), "wavelength"),
         counted(values.size(), "value"));
  }
  for (std::size_t i = 0; i < wavelengths.size(); ++i) {
    if (!std::isfinite(wavelengths[i]) || !std::isfinite(values[i])) {
      fail("sample {} of a spectrum is not finite: {} nm, {}", i, wavelengths[i], values[i]);
    }
    if (i > 0 && wavelengths[i] <= wavelengths[i - 1]) {
      fail("the wavelengths of a sampled spectrum have to increase: {} nm follows {} nm",
           wavelengths[i], wavelengths[i - 1]);
    }
  }
  const double inverse_step = find_inverse_step(wavelengths);
  samples_ = std::make_shared<const Samples>(
      Samples{std::move(wavelengths), std::move(values), outside, inverse_step});
}

double LinearSpectrum::operator()(double wavelength) const {
  const std::vector<double>& wavelengths = samples_->wavelengths;
  const std::vector<double>& values = samples_->values;
  const bool is_outside = !(wavelength >= wavelengths.front() && wavelength <= wavelengths.back());
  if (is_outside && samples_->outside == OutsideSamples::kZero) return 0;
  if (wavelength >= wavelengths.back()) return values.back();
  if (!(wavelength > wavelengths.front())) return values.front();
  std::size_t right = 0;
  if (samples_->inverse_step > 0) {
    const double position = (wavelength - wavelengths.front()) * samples_->inverse_step;
    right = std::min(static_cast<std::size_t>(position) + 1, wavelengths.size() - 1);
  } else {
    right = static_cast<std::size_t>(std::ranges::upper_bound(wavelengths, wavelength) -
                                     wavelengths.begin());
  }
  const double share =
      (wavelength - wavelengths[right - 1]) / (wavelengths[right] - wavelengths[right - 1]);
  return values[right - 1] + share * (values[right] - values[right - 1]);
}

LinearSpectrum LinearSpectrum::scaled(double factor) const {
  std::vector<double> values = samples_->values;
  for (double& value : values) value *= factor;
  return {samples_->wavelengths, std::move(values), samples_->outside};
}

LinearSpectrum read_linear_spectrum(std::string_view text, std::string_view source,
                                    OutsideSamples outside) {
  const std::vector<Number> numbers = read_numbers(text, source);
  if (numbers.empty()) {
    fail("{}: there is no sample; write pairs of a wavelength in nm and a value", source);
  }
  if (numbers.size() % 2 != 0) {
    fail("{}:{}: the wavelength {} nm has no value", source, numbers.back().line,
         numbers.back().value);
  }
  std::vector<double> wavelengths, values;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    const auto [wavelength, line] = numbers[i];
    if (!wavelengths.empty() && wavelength <= wavelengths.back()) {
      fail("{}:{}: wavelengths have to increase, but {} nm follows {} nm", source, line, wavelength,
           wavelengths.back());
    }
    wavelengths.push_back(wavelength);
    values.push_back(numbers[i + 1].value);
  }
  return {std::move(wavelengths), std::move(values), outside};
}

}  // namespace freepath
