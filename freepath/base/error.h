#pragma once
/// @file The one exception type of the project. The library throws it and never exits or prints.

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace freepath {

/// Bad input or a failed operation. The message says what is wrong, where (file, line, grid, voxel)
/// and what to do; a program prints it as it is.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws an Error with a formatted message.
template <class... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
  throw Error(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace freepath
