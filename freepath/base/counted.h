#pragma once
/// @file Numbers of things, as people write them.

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace freepath {

/// A number with what it counts: "1 thread", "2 threads", "1 pixel has", "2 pixels have".
/// @param many what follows any number but 1; `one` with an s where nothing is given
template <class Number>
std::string counted(Number number, std::string_view one, std::string_view many = {}) {
  if (number == Number{1}) return fmt::format("{} {}", number, one);
  return many.empty() ? fmt::format("{} {}s", number, one) : fmt::format("{} {}", number, many);
}

}  // namespace freepath
