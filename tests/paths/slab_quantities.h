#pragma once
/// @file What tests of slabs ask for, and how many standard errors off an answer may be.

#include <algorithm>
#include <cstddef>
#include <limits>

#include "freepath/paths/slab.h"
#include "tests/statistics.h"

namespace freepath::testing {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr std::size_t kAnswers = 50;  // z-tests of slabs, rounded up
inline constexpr double kFamilyLevel = 0.01;

/// Never above the 4 standard errors that are asked for.
inline double threshold() { return std::min(4.0, family_wise_threshold(kFamilyLevel, kAnswers)); }

enum class Quantity { kReflectance, kTransmittance, kUnscattered };

inline const Estimate& value_of(const SlabResult& result, Quantity quantity) {
  switch (quantity) {
    case Quantity::kTransmittance:
      return result.transmittance;
    case Quantity::kUnscattered:
      return result.unscattered;
    default:
      return result.reflectance;
  }
}

}  // namespace freepath::testing
