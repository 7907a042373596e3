#pragma once
/// @file What a misspelt name may have meant.

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace freepath {

/// Insertions, deletions, replacements and swaps of neighbours that turn one text into the other
/// (the optimal string alignment distance). Letters of different case differ by 1.
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Rows of the usual table: the one before the last, the last, and the one being filled.
  std::vector<std::size_t> older(b.size() + 1), old(b.size() + 1), row(b.size() + 1);
  std::iota(old.begin(), old.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = old[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replaced, old[j] + 1, row[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], older[j - 2] + 1);
    }
    std::swap(older, old);
    std::swap(old, row);
  }
  return old[b.size()];
}

/// The name with the smallest edit distance, the first of equals; empty if none is near, that is
/// within 1 plus a third of the length.
inline std::string_view nearest_name(std::string_view name,
                                     std::span<const std::string_view> names) {
  // The table grows with the product of the lengths, and nobody types a name like that.
  constexpr std::size_t kLongest = 100;
  std::string_view nearest;
  if (name.size() > kLongest) return nearest;
  std::size_t smallest = 2 + name.size() / 3;
  for (const std::string_view candidate : names) {
    if (candidate.empty() || candidate.size() > kLongest) continue;
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < smallest) {
      smallest = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace freepath
