#pragma once
/// @file Words whose bits are in reverse: what low-discrepancy sequences are made of.

#include <cstdint>

namespace freepath {

/// The bits of a word in reverse.
constexpr uint32_t reversed_bits(uint32_t word) {
  word = __builtin_bswap32(word);
  word = ((word >> 4) & 0x0F0F0F0FU) | ((word & 0x0F0F0F0FU) << 4);
  word = ((word >> 2) & 0x33333333U) | ((word & 0x33333333U) << 2);
  return ((word >> 1) & 0x55555555U) | ((word & 0x55555555U) << 1);
}

}  // namespace freepath
