#pragma once
/// @file Lists of methods.

#include <string>
#include <string_view>
#include <vector>

namespace freepath::program {

/// Splits "delta,weighted-delta:rate-scale=0.7,roulette=0.1" at the commas between methods. A part
/// with a '=' and no ':' before it is an option of the method before it.
std::vector<std::string> split_methods(std::string_view text);

}  // namespace freepath::program
