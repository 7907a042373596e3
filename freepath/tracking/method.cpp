#include "freepath/tracking/method.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "freepath/base/error.h"

namespace freepath {
namespace {

template <class Range>
std::string list_names(const Range& range) {
  std::string names;
  for (const auto& item : range) {
    if (!names.empty()) names += ", ";
    names += item.name;
  }
  return names.empty() ? "none" : names;
}

const MethodInfo& find_method(std::string_view name, std::span<const MethodInfo> known) {
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const MethodInfo& info) { return info.name == name; });
  if (found == known.end()) {
    fail("there is no method '{}'; known are: {}", name, list_names(known));
  }
  return *found;
}

void set_option(Method& method, const MethodInfo& info, std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string_view name = assignment.substr(0, equals);
  const auto found = std::find_if(info.options.begin(), info.options.end(),
                                  [&](const MethodOption& option) { return option.name == name; });
  if (found == info.options.end()) {
    fail("'{}' has no option '{}'; its options are: {}", info.name, name, list_names(info.options));
  }
  if (equals == std::string_view::npos) {
    fail("option '{}' of '{}' needs a value: {}:{}={}", name, info.name, info.name, name,
         found->default_value);
  }
  const std::string_view text = assignment.substr(equals + 1);
  float& target = method.options[found - info.options.begin()];
  if (!found->choices.empty()) {
    const auto choice = std::find(found->choices.begin(), found->choices.end(), text);
    if (choice == found->choices.end()) {
      fail("option '{}' of '{}': there is no '{}'; known are: {}", name, info.name, text,
           fmt::join(found->choices, ", "));
    }
    target = static_cast<float>(choice - found->choices.begin());
    return;
  }
  float value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    fail("option '{}' of '{}': '{}' is not a number", name, info.name, text);
  }
  if (value < found->minimum || value > found->maximum) {
    fail("option '{}' of '{}': {} is outside {} to {}", name, info.name, value, found->minimum,
         found->maximum);
  }
  target = value;
}

}  // namespace

Method parse_method(std::string_view text, std::span<const MethodInfo> known) {
  const std::size_t colon = text.find(':');
  const MethodInfo& info = find_method(text.substr(0, colon), known);
  if (!has_room_for(info)) {
    fail("method '{}' has {} options, but there is room for {}", info.name, info.options.size(),
         kMaxMethodOptions);
  }
  Method method;
  method.name = info.name;
  for (std::size_t i = 0; i < info.options.size(); ++i) {
    method.options[i] = info.options[i].default_value;
  }
  if (colon == std::string_view::npos) return method;
  std::string_view rest = text.substr(colon + 1);
  while (true) {
    const std::size_t comma = rest.find(',');
    set_option(method, info, rest.substr(0, comma));
    if (comma == std::string_view::npos) break;
    rest = rest.substr(comma + 1);
  }
  return method;
}

std::string to_string(const Method& method, std::span<const MethodInfo> known) {
  const MethodInfo& info = find_method(method.name, known);
  std::string text = method.name;
  char separator = ':';
  for (std::size_t i = 0; i < info.options.size(); ++i) {
    if (method.options[i] == info.options[i].default_value) continue;
    const MethodOption& option = info.options[i];
    const float value = method.options[i];
    text += option.choices.empty() ? fmt::format("{}{}={}", separator, option.name, value)
                                   : fmt::format("{}{}={}", separator, option.name,
                                                 option.choices[static_cast<std::size_t>(value)]);
    separator = ',';
  }
  return text;
}

}  // namespace freepath
