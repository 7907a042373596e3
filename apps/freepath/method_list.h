#pragma once
/// @file Lists of methods, as users type them.

#include <string>
#include <string_view>
#include <vector>

namespace freepath::program {

/// "delta,spectral:rate-scale=0.7,control=1.3,regular" as the methods "delta",
/// "spectral:rate-scale=0.7,control=1.3" and "regular". Commas stand between methods and between
/// the options of one: an item that has '=' and no ':' before it is a further option of the method
/// before it. Whether the methods exist is not looked at.
/// @throws Error for an empty item, and for an option without a method before it
std::vector<std::string> split_methods(std::string_view text);

}  // namespace freepath::program
