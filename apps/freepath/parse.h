#pragma once
/// @file Values of options: numbers, lists, sizes, choices. Each error names the option.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "freepath/base/error.h"
#include "freepath/base/rgb.h"
#include "freepath/tracking/walk_modes.h"

namespace freepath::program {

/// "1,2.5,3" as numbers. @throws Error naming the option, for what is not a finite number
std::vector<double> parse_numbers(std::string_view text, std::string_view option);

/// A whole number from `least` to `most`, which may be written 1e6; a double counts all up to 2^53.
/// @throws Error naming the option and the range
uint64_t parse_count(std::string_view text, std::string_view option, double least, double most);

/// Checks that an option's value is a finite number: C's notion of numbers has nan and inf too.
extern const CLI::Validator kFiniteNumber;

/// Checks that it is a whole number from 0 to 2^64 - 1: unsigned options would take -1 for the
/// largest.
extern const CLI::Validator kWholeNumber;

/// What `read` returns; the message of an Error it throws gets the option's name in front.
template <class Read>
auto read_option(std::string_view option, Read read) {
  try {
    return read();
  } catch (const Error& error) {
    fail("{}: {}", option, error.what());
  }
}

/// One value for all channels, or three. @throws Error for another count or not a number
Rgb parse_spectrum(std::string_view text, std::string_view option);

/// Whether a text begins like a number, to tell a spectrum from a name or a file.
bool looks_numeric(std::string_view text);

struct PictureSize {
  int width = 0;
  int height = 0;
};

/// "640x360". @throws Error for another form, or sizes outside 1 to 32768
PictureSize parse_size(std::string_view text, std::string_view option);

/// A name among those given with their values.
/// @throws Error listing the names
template <class Value>
struct Choice {
  std::string_view name;
  Value value;
};

[[noreturn]] void fail_choice(std::string_view text, std::string_view option,
                              const std::vector<std::string_view>& names);

template <class Value, std::size_t kCount>
Value parse_choice(std::string_view text, std::string_view option,
                   const std::array<Choice<Value>, kCount>& choices) {
  std::vector<std::string_view> names;
  for (const Choice<Value>& choice : choices) {
    if (choice.name == text) return choice.value;
    names.push_back(choice.name);
  }
  fail_choice(text, option, names);
}

/// The threads to work on: as many as are wished, or as the system grants if those are fewer.
/// @param wished 0: as many as the machine has
int settle_threads(int wished);

/// "analog" or "weighted". @throws Error naming --absorption
Absorption parse_absorption(std::string_view text);

/// Variables that --seed, --threads, --batch and --simd are written to.
struct RunOptions {
  uint64_t& seed;
  int& threads;
  std::size_t& batch;
  std::string& simd;
};
/// Adds the options on what paths run on, which change no result but for the seed.
void add_run_options(CLI::App& command, const RunOptions& options);

/// Prints a warning for a tracker that is biased.
void warn_if_biased(const std::string& tracker);

}  // namespace freepath::program
