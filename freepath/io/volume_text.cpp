#include "freepath/io/volume_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "freepath/base/error.h"
#include "freepath/base/printable.h"

namespace freepath::io {
namespace {

constexpr std::size_t kLongestLine = std::size_t{1} << 16;

bool is_text_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

}  // namespace

std::optional<double> number_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (end != word.data() + word.size() || word.empty()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    // Too small for a double is 0; too large is what it is.
    const bool small = word.find("e-") != word.npos || word.find("E-") != word.npos;
    return small ? 0 : word.starts_with('-') ? -HUGE_VAL : HUGE_VAL;
  }
  if (error != std::errc()) return std::nullopt;
  return number;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_text_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_text_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::vector<std::string> split_words(std::string_view text, std::string_view further) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (!is_text_blank(c) && c != ',' && further.find(c) == further.npos) {
      words.back() += c;
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

std::string TextCursor::line() {
  std::string line;
  while (!at_end()) {
    const char c = take();
    if (c == '\n') break;
    line += c;
    if (line.size() > kLongestLine) {
      file().fail_damaged(fmt::format("a line of more than {} characters", kLongestLine));
    }
  }
  if (line.ends_with('\r')) line.pop_back();
  return line;
}

std::string TextCursor::word() {
  std::string word;
  while (!at_end()) {
    const char c = take();
    if (!is_text_blank(c)) {
      word += c;
    } else if (!word.empty()) {
      break;
    }
    if (word.size() > kLongestLine) {
      file().fail_damaged(fmt::format("a word of more than {} characters", kLongestLine));
    }
  }
  return word;
}

std::vector<double> header_numbers(const VolumeFile& file, std::string_view what,
                                   std::string_view text, std::size_t count) {
  std::vector<double> numbers;
  for (const std::string& word : split_words(text)) {
    const std::optional<double> number = number_of(word);
    if (!number || !std::isfinite(*number)) {
      fail("{}: '{}' of {} in its header is no finite number; correct it", file.name(),
           excerpt(word), what);
    }
    numbers.push_back(*number);
  }
  if (numbers.size() != count) {
    fail("{}: {} in its header has {} numbers, where {} belong; correct it", file.name(), what,
         numbers.size(), count);
  }
  return numbers;
}

std::shared_ptr<const VolumeFile> beside(const VolumeFile& header, const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(header.name()).parent_path();
  try {
    return std::make_shared<const VolumeFile>(folder / name);
  } catch (const Error& error) {
    fail("{}: the file with its values can't be read: {}", header.name(), error.what());
  }
}

std::optional<std::string> HeaderFields::find(std::initializer_list<const char*> names) const {
  for (const char* const name : names) {
    const auto found = fields_.find(name);
    if (found != fields_.end()) return found->second;
  }
  return std::nullopt;
}

std::string HeaderFields::get(std::initializer_list<const char*> names) const {
  const std::optional<std::string> value = find(names);
  if (!value) fail("{}: its header has no field '{}'; add it", file_.name(), *names.begin());
  return *value;
}

}  // namespace freepath::io
