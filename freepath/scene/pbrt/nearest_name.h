#pragma once
/// @file What a misspelt name may have meant.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace freepath {

/// Insertions, deletions, replacements and swaps of neighbours that turn one text into the other
/// (the optimal string alignment distance). Letters of different case differ by 1.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name with the smallest edit distance, the first of equals; empty if none is near, that is
/// within 1 plus a third of the length.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> names);

/// "; did you mean 'x'?" for the nearest name, or nothing.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> names);

}  // namespace freepath
