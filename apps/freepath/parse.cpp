#include "apps/freepath/parse.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "apps/freepath/console.h"
#include "freepath/base/error.h"
#include "freepath/base/thread_limit.h"
#include "freepath/transport/walker.h"

namespace freepath::program {
namespace {

template <class Number>
bool read_number(std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

std::string refuse_non_finite(const std::string& text) {
  double value = 0;
  if (read_number(std::string_view(text), value) && std::isfinite(value)) return {};
  return fmt::format("'{}' is not a finite number", text);
}

std::string refuse_non_whole(const std::string& text) {
  uint64_t value = 0;
  if (read_number(std::string_view(text), value)) return {};
  return fmt::format("'{}' is not a whole number from 0 to 2^64 - 1", text);
}

}  // namespace

uint64_t parse_count(std::string_view text, std::string_view option, double least, double most) {
  const std::vector<double> numbers = parse_numbers(text, option);
  if (numbers.size() != 1 || numbers[0] < least || numbers[0] > most ||
      numbers[0] != std::floor(numbers[0])) {
    fail("{}: '{}' is not a whole number from {} to {}", option, text, least, most);
  }
  return static_cast<uint64_t>(numbers[0]);
}

const CLI::Validator kFiniteNumber(refuse_non_finite, "");
const CLI::Validator kWholeNumber(refuse_non_whole, "");

std::vector<double> parse_numbers(std::string_view text, std::string_view option) {
  std::vector<double> numbers;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view item = text.substr(0, comma);
    double value = 0;
    if (!read_number(item, value) || !std::isfinite(value)) {
      fail("{}: '{}' is not a number", option, item);
    }
    numbers.push_back(value);
    if (comma == std::string_view::npos) return numbers;
    text = text.substr(comma + 1);
  }
}

Rgb parse_spectrum(std::string_view text, std::string_view option) {
  const std::vector<double> numbers = parse_numbers(text, option);
  if (numbers.size() == 1) return Rgb(static_cast<float>(numbers[0]));
  if (numbers.size() != 3) {
    fail("{}: '{}' has {} values; give one for all channels, or three: R,G,B", option, text,
         numbers.size());
  }
  return {static_cast<float>(numbers[0]), static_cast<float>(numbers[1]),
          static_cast<float>(numbers[2])};
}

bool looks_numeric(std::string_view text) {
  const std::size_t first = text.find_first_not_of("+-.");
  if (first == std::string_view::npos || first > 2) return false;
  const std::string_view item = text.substr(0, text.find(','));
  double value = 0;
  return read_number(item, value);
}

PictureSize parse_size(std::string_view text, std::string_view option) {
  constexpr int kLargest = 32768;
  PictureSize size;
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos || !read_number(text.substr(0, cross), size.width) ||
      !read_number(text.substr(cross + 1), size.height)) {
    fail("{}: '{}' is not a size; write WIDTHxHEIGHT, as in 640x360", option, text);
  }
  if (size.width < 1 || size.height < 1 || size.width > kLargest || size.height > kLargest) {
    fail("{}: {} is outside 1x1 to {}x{}", option, text, kLargest, kLargest);
  }
  return size;
}

void fail_choice(std::string_view text, std::string_view option,
                 const std::vector<std::string_view>& names) {
  std::string list;
  for (const std::string_view name : names) {
    if (!list.empty()) list += ", ";
    list += name;
  }
  fail("{}: '{}' is not one of: {}", option, text, list);
}

int settle_threads(int wished) { return wished > 0 ? granted_threads(wished) : 0; }

Absorption parse_absorption(std::string_view text) {
  constexpr std::array kAbsorptions{Choice<Absorption>{"analog", Absorption::kAnalog},
                                    Choice<Absorption>{"weighted", Absorption::kWeighted}};
  return parse_choice(text, "--absorption", kAbsorptions);
}

void add_run_options(CLI::App& command, const RunOptions& options) {
  command.add_option("--seed", options.seed, "Seed of the random numbers")
      ->capture_default_str()
      ->check(kWholeNumber);
  command.add_option("--threads", options.threads, "Threads [all]")->check(CLI::Range(1, 1024));
  command.add_option("--batch", options.batch, "Paths in flight per thread; changes no result")
      ->capture_default_str()
      ->check(CLI::Range(1, 1 << 20));
  command.add_option("--simd", options.simd, "best, avx512, avx2, sse4 or one-lane")
      ->capture_default_str();
}

void warn_if_biased(const std::string& tracker) {
  const std::string name = parse_method(tracker, tracker_infos()).name;
  for (const MethodInfo& info : tracker_infos()) {
    if (info.name != name || !info.biased) continue;
    warn("the tracker {} is biased: {}", name, info.unbiased);
  }
}

}  // namespace freepath::program
