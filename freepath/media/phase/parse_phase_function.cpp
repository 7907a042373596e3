#include "freepath/media/phase/parse_phase_function.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/input_file.h"
#include "freepath/base/nearest_name.h"

namespace freepath {
namespace {

constexpr std::size_t kLongestQuote = 60;
constexpr std::string_view kBlanks = " \t\r\n\v\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

/// What a message quotes of the user's text.
std::string_view quote(std::string_view text) { return text.substr(0, kLongestQuote); }

/// The number that is the whole text, if it is one.
template <class T>
std::optional<T> number(std::string_view text) {
  T value;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The values of "key=value,key=value": every key given once, and no other.
template <std::size_t kCount>
std::array<float, kCount> parse_parameters(std::string_view function, std::string_view text,
                                           const std::array<std::string_view, kCount>& keys) {
  std::array<std::optional<float>, kCount> values;
  while (!text.empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    const std::string_view item = trimmed(text.substr(0, comma));
    text.remove_prefix(std::min(comma + 1, text.size()));
    if (kCount == 0) fail("{}: takes no parameters, and has '{}'", function, quote(item));
    const std::size_t equals = item.find('=');
    if (equals == std::string_view::npos) {
      fail("{}: '{}' should read {}=NUMBER", function, quote(item), fmt::join(keys, "=NUMBER or "));
    }
    const std::string_view key = trimmed(item.substr(0, equals));
    const auto found = std::find(keys.begin(), keys.end(), key);
    if (found == keys.end()) {
      fail("{}: there is no parameter '{}'; it takes {}", function, quote(key),
           fmt::join(keys, " and "));
    }
    auto& value = values[static_cast<std::size_t>(found - keys.begin())];
    if (value) fail("{}: {} is given twice", function, key);
    const std::string_view digits = trimmed(item.substr(equals + 1));
    value = number<float>(digits);
    if (!value) fail("{}: {} is '{}', which is no number", function, key, quote(digits));
  }
  std::array<float, kCount> result;
  for (std::size_t i = 0; i < kCount; ++i) {
    if (!values[i])
      fail("{}: {} is missing: {}:{}=NUMBER", function, keys[i], function,
           fmt::join(keys, "=NUMBER,"));
    result[i] = *values[i];
  }
  return result;
}

using Folder = std::filesystem::path;

PhaseFunction read_table_file(std::string_view file, const Folder& folder) {
  if (file.empty()) fail("tabulated: the name of a file is missing: tabulated:FILE");
  const std::filesystem::path path = folder / file;
  constexpr uint64_t kLargestTable = uint64_t{1} << 28;  // 10 million angles
  std::istringstream input(read_input_file(path, "a table of a phase function", kLargestTable));
  return read_phase_table(input, path.string());
}

/// A name and what makes a function from the text behind its colon.
struct Entry {
  std::string_view name;
  PhaseFunction (*make)(std::string_view text, const Folder& folder);
};

constexpr Entry kEntries[] = {
    {"isotropic",
     [](std::string_view text, const Folder&) {
       parse_parameters<0>("isotropic", text, {});
       return PhaseFunction::isotropic();
     }},
    {"henyey-greenstein",
     [](std::string_view text, const Folder&) {
       const auto [g] = parse_parameters<1>("henyey-greenstein", text, {"g"});
       return PhaseFunction::henyey_greenstein(g);
     }},
    {"rayleigh",
     [](std::string_view text, const Folder&) {
       parse_parameters<0>("rayleigh", text, {});
       return PhaseFunction::rayleigh();
     }},
    {"draine",
     [](std::string_view text, const Folder&) {
       const auto [g, alpha] = parse_parameters<2>("draine", text, {"g", "alpha"});
       return PhaseFunction::draine(g, alpha);
     }},
    {"droplets",
     [](std::string_view text, const Folder&) {
       const auto [diameter] = parse_parameters<1>("droplets", text, {"diameter"});
       return PhaseFunction::droplets(diameter);
     }},
    {"tabulated", read_table_file},
};

constexpr auto kNames = [] {
  std::array<std::string_view, std::size(kEntries)> names;
  std::ranges::transform(kEntries, names.begin(), &Entry::name);
  return names;
}();

PhaseFunction parse_one(std::string_view text, const Folder& folder) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const std::string_view name = trimmed(text.substr(0, colon));
  const std::string_view rest = trimmed(text.substr(std::min(colon + 1, text.size())));
  if (const auto* const found = std::ranges::find(kEntries, name, &Entry::name);
      found != std::end(kEntries)) {
    return found->make(rest, folder);
  }
  const std::string_view nearest = nearest_name(name, kNames);
  if (nearest.empty()) {
    fail("there is no phase function '{}'; there are {}", quote(name), fmt::join(kNames, ", "));
  }
  fail("there is no phase function '{}'; did you mean '{}'?", quote(name), nearest);
}

struct Weighted {
  float weight;
  std::string_view rest;
};

/// The weight in "0.7*rayleigh" and what stands behind it.
std::optional<Weighted> leading_weight(std::string_view text) {
  const std::size_t star = text.find('*');
  if (star == std::string_view::npos) return std::nullopt;
  const auto weight = number<float>(trimmed(text.substr(0, star)));
  if (!weight) return std::nullopt;
  return Weighted{*weight, trimmed(text.substr(star + 1))};
}

/// Where the first part of a mixture ends: at a + with a weight behind it. A lone + may belong to
/// the name of a file or to an exponent.
std::size_t end_of_part(std::string_view text) {
  for (std::size_t plus = text.find('+'); plus != std::string_view::npos;
       plus = text.find('+', plus + 1)) {
    if (leading_weight(text.substr(plus + 1))) return plus;
  }
  return text.size();
}

}  // namespace

std::span<const std::string_view> phase_function_names() { return kNames; }

PhaseFunction parse_phase_function(std::string_view text, const std::filesystem::path& folder) {
  text = trimmed(text);
  if (end_of_part(text) == text.size() && !leading_weight(text)) return parse_one(text, folder);
  std::vector<std::pair<float, PhaseFunction>> parts;
  while (!text.empty()) {
    const std::size_t end = end_of_part(text);
    const std::string_view part = trimmed(text.substr(0, end));
    text = trimmed(text.substr(std::min(end + 1, text.size())));
    const auto weighted = leading_weight(part);
    if (!weighted) {
      fail("a mixture of phase functions: '{}' needs a weight, as in 0.5*rayleigh", quote(part));
    }
    parts.emplace_back(weighted->weight, parse_one(weighted->rest, folder));
  }
  return PhaseFunction::mixture(parts);
}

std::vector<std::filesystem::path> phase_function_files(std::string_view text,
                                                        const std::filesystem::path& folder) {
  constexpr std::string_view kTabulated = "tabulated:";
  std::vector<std::filesystem::path> files;
  text = trimmed(text);
  while (!text.empty()) {
    const std::size_t end = end_of_part(text);
    std::string_view part = trimmed(text.substr(0, end));
    text = trimmed(text.substr(std::min(end + 1, text.size())));
    if (const auto weighted = leading_weight(part)) part = weighted->rest;
    if (part.substr(0, kTabulated.size()) != kTabulated) continue;
    files.push_back(folder / trimmed(part.substr(kTabulated.size())));
  }
  return files;
}

PhaseFunction read_phase_table(std::istream& input, std::string_view name) {
  std::vector<PhaseTablePoint> points;
  std::vector<std::size_t> lines;  // of the points
  std::string text;
  std::size_t line = 0;
  while (std::getline(input, text)) {
    ++line;
    const std::string_view row = trimmed(std::string_view(text).substr(0, text.find('#')));
    if (row.empty()) continue;
    const std::size_t blank = std::min(row.find_first_of(kBlanks), row.size());
    const auto angle = number<double>(row.substr(0, blank));
    const auto value = number<double>(trimmed(row.substr(blank)));
    if (!angle || !value) {
      fail("{}:{}: '{}' should read 'angle value', two numbers, the angle in degrees", name, line,
           quote(row));
    }
    points.push_back({*angle, *value});
    lines.push_back(line);
  }
  if (input.bad()) fail("{}:{}: cannot be read", name, line + 1);
  if (const auto fault = find_fault(points)) {
    fail("{}:{}: {}", name, lines.empty() ? std::max<std::size_t>(line, 1) : lines[fault->point],
         fault->what);
  }
  return PhaseFunction::tabulated(points);
}

}  // namespace freepath
