#pragma once
/// @file Seeds of runs that have to be independent of each other.

#include <cstddef>
#include <cstdint>

#include "freepath/base/random.h"

namespace freepath {

/// A seed for each run of each configuration of an experiment, as good as independent of the
/// others.
/// @param seed of the experiment
inline uint64_t run_seed(uint64_t seed, std::size_t configuration, int run) {
  constexpr uint32_t kPurpose = 0x636F6D70U;  // apart from the numbers of pixels and samples
  constexpr int kRounds = 10;
  const auto words =
      philox({static_cast<uint32_t>(configuration), static_cast<uint32_t>(run), kPurpose, 0},
             {static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)}, kRounds);
  return (uint64_t{words[1]} << 32) | words[0];
}

}  // namespace freepath
