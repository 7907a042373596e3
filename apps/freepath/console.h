#pragma once
/// @file All that the program says goes through here: results to standard output, messages and the
/// line of progress to standard error. Nothing here throws. Names from outside are shown without
/// their control characters.

#include <fmt/format.h>

#include <exception>
#include <string>
#include <string_view>
#include <type_traits>

#include "freepath/base/json_text.h"
#include "freepath/base/printable.h"

namespace freepath::program {

/// Readies the standard streams: closed ones are taken by /dev/null, lest a picture become standard
/// error, and a stream that takes nothing is an error of its own instead of the program's end.
void prepare_console();

/// Tells of an exception that nobody expected.
/// @return the exit status
int tell_unexpected(const std::exception& error);

/// Writes what is left of the results.
/// @param status of the program so far
/// @return that status, but one of failure where results were lost, of which is told: 1, and 141,
///   as of a program that a pipe ended, without a word where their reader has gone
int finish_console(int status);

/// Exit status of a program that was ended before it was done, and has written what there was; as
/// EX_TEMPFAIL of sysexits.h, "try again".
inline constexpr int kPartialStatus = 75;
/// Notes that less was done than was asked for: the status is kPartialStatus where it would be 0.
void note_partial_result();

/// Adds a text to the results, as it is.
void put_output(std::string_view text);
/// Writes a message, as it is, on a line of its own. A stream that takes nothing is no error.
void put_message(std::string_view text);

/// Shows a line of progress in place of the one before, where standard error is a terminal that
/// takes it without a wait.
void show_status(std::string_view text);
/// Removes the line of progress.
void clear_status();

/// An argument as it is shown: texts printable, the rest as it is.
template <class T>
decltype(auto) shown(const T& value) {
  if constexpr (std::is_convertible_v<const T&, std::string_view>) {
    return printable(std::string_view(value));
  } else {
    return (value);
  }
}

/// Adds formatted text to the results.
template <class... Args>
void print(fmt::format_string<Args...> format, Args&&... args) {
  put_output(fmt::vformat(format, fmt::make_format_args(shown(args)...)));
}

/// Adds text of several lines to the results.
inline void print_lines(std::string_view text) { put_output(printable(text, '\n')); }

/// Adds JSON to the results.
template <class Json>
void print_json_text(const Json& json, int indent = -1) {
  put_output(json_text(json, indent) + '\n');
}

/// Writes a formatted message.
template <class... Args>
void tell(fmt::format_string<Args...> format, Args&&... args) {
  put_message(fmt::vformat(format, fmt::make_format_args(shown(args)...)));
}

/// Writes a warning, on a line.
template <class... Args>
void warn(fmt::format_string<Args...> format, Args&&... args) {
  put_message("freepath: warning: " + fmt::vformat(format, fmt::make_format_args(shown(args)...)) +
              '\n');
}

}  // namespace freepath::program
