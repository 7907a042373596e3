#pragma once
/// @file The whole program as a function.

#include <functional>

namespace freepath::program {

/// Parses a command line and runs its subcommand, which prints its results on standard output. An
/// error becomes one line on standard error.
/// @param argv as main's, the program's name first
/// @param clock by which `render` measures its time [s] (RenderSettings::clock); empty: the
///   system's
/// @return the exit status, 0 for success
int run(int argc, const char* const* argv, const std::function<double()>& clock = {});

}  // namespace freepath::program
