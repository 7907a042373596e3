#pragma once
/// @file Places in scene files, and errors that begin with one.

#include <fmt/format.h>

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "freepath/base/error.h"

namespace freepath {

/// A place in a scene file. Lines and columns count from 1; a column is a character of UTF-8.
struct SourceLocation {
  std::shared_ptr<const std::string> file;
  int line = 1;
  int column = 1;
};

/// "file:line:column", as editors and compilers write it.
std::string to_string(const SourceLocation& location);

/// Text from a file as a message may show it: in single quotes, what cannot be printed as \xNN, and
/// shortened where it is long.
std::string in_quotes(std::string_view text);

/// Throws an Error "file:line:column: message".
template <class... Args>
[[noreturn]] void fail_at(const SourceLocation& location, fmt::format_string<Args...> format,
                          Args&&... args) {
  fail("{}: {}", to_string(location), fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace freepath
