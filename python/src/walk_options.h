#pragma once
/// @file Settings of walks by the names that users give.

#include <cstdint>
#include <string>

#include "freepath/transport/walker.h"

namespace freepath::python {

/// Which methods to walk with, as text.
struct WalkOptions {
  std::string tracker = "delta";
  std::string transmittance = "ratio";
  std::string interpolation = "stochastic";  ///< Or nearest, trilinear.
  std::string absorption = "weighted";       ///< Or analog.
  std::string emission = "collision";        ///< Or analog.
  std::string simd = "best";
  uint64_t seed = 0;
};

/// @throws Error for a word that is none, listing those there are
WalkSettings walk_settings(const WalkOptions& options);

}  // namespace freepath::python
