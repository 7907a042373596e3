#include "freepath/base/distributions.h"

#include <numeric>

namespace freepath {

std::vector<AliasEntry> make_alias_table(std::span<const double> weights) {
  const std::size_t size = weights.size();
  const double mean = std::accumulate(weights.begin(), weights.end(), 0.0) / size;
  std::vector<double> height(weights.begin(), weights.end());
  std::vector<uint32_t> low;
  std::vector<uint32_t> high;
  for (std::size_t i = 0; i < size; ++i) {
    height[i] /= mean;
    (height[i] < 1 ? low : high).push_back(static_cast<uint32_t>(i));
  }
  // Every column starts full; columns below the mean are filled up from those above it.
  std::vector<AliasEntry> table(size);
  for (std::size_t i = 0; i < size; ++i) table[i] = {1, static_cast<uint32_t>(i)};
  while (!low.empty() && !high.empty()) {
    const uint32_t taker = low.back();
    const uint32_t giver = high.back();
    low.pop_back();
    table[taker] = {static_cast<float>(height[taker]), giver};
    height[giver] -= 1 - height[taker];
    if (height[giver] < 1) {
      high.pop_back();
      low.push_back(giver);
    }
  }
  // What remains in either list is full but for rounding. A column without weight can't remain so:
  // it would never be filled, and must not be drawn.
  for (const uint32_t column : low) {
    if (weights[column] == 0) {
      const auto heaviest = std::max_element(weights.begin(), weights.end());
      table[column] = {0, static_cast<uint32_t>(heaviest - weights.begin())};
    }
  }
  return table;
}

}  // namespace freepath
