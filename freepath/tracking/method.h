#pragma once
/// @file What a tracker or transmittance estimator says of itself, and how a user names it.

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace freepath {

/// One option of a method: a number, or one of some words.
struct MethodOption {
  std::string_view name;
  float default_value = 0;  ///< Value when nothing is said.
  float minimum = 0;
  float maximum = 0;
  std::string_view meaning;
  /// The words, if it takes words; the option's value is then a place among them.
  std::span<const std::string_view> choices{};
};

/// What users may know of a method. All trackers and estimators carry one, and every list, help
/// text and parser is made from these.
struct MethodInfo {
  std::string_view name;  ///< Name, the same in C++, on the command line and in scenes.
  std::string_view summary;
  std::string_view needs;     ///< What the medium must be like; empty: anything.
  std::string_view unbiased;  ///< When it is unbiased.
  std::string_view source;    ///< Citation key and equation.
  std::span<const MethodOption> options;
  /// Whether one path carries channels whose extinctions differ; else each takes a path of its own.
  bool chromatic = false;
  bool biased = false;
  bool one_channel = false;  ///< Gives each channel its own path, always.
};

inline constexpr int kMaxMethodOptions = 4;

inline constexpr std::string_view kNoYes[] = {"no", "yes"};

/// A method with the values of its options, in the order of MethodInfo::options.
struct Method {
  std::string name;
  std::array<float, kMaxMethodOptions> options{};
};

/// Whether a Method has room for the options of one; every registry asserts it.
constexpr bool has_room_for(const MethodInfo& info) {
  return info.options.size() <= std::size_t{kMaxMethodOptions};
}

/// Reads "name" or "name:option=value,option=value", where a value is a number or one of the words
/// that the option knows.
/// @throws Error for an unknown name or option, listing those there are, and for a value that is no
///   number or out of range
Method parse_method(std::string_view text, std::span<const MethodInfo> known);

/// The spelling that parse_method reads, with the options that differ from their standard.
std::string to_string(const Method& method, std::span<const MethodInfo> known);

}  // namespace freepath
