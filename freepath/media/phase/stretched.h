#pragma once
/// @file One random number for two decisions.

#include <algorithm>

namespace freepath {

/// The part of [0, 1) from `begin` on with the given width, that `u` lies in, stretched to [0, 1).
inline float stretched(float u, float begin, float width) {
  constexpr float kLast = 1.0F - 0x1p-24F;
  return std::clamp((u - begin) / width, 0.0F, kLast);
}

}  // namespace freepath
