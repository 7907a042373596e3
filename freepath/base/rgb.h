#pragma once
/// @file A value per channel.

#include <algorithm>
#include <cmath>

#include <Imath/ImathColor.h>

namespace freepath {

inline constexpr int kChannels = 3;

/// One value for each of the three channels R, G, B (linear, Rec. 709 primaries).
using Rgb = Imath::C3f;

inline float largest(const Rgb& s) { return std::max({s.x, s.y, s.z}); }
inline float mean(const Rgb& s) { return (s.x + s.y + s.z) / 3.0F; }
inline bool is_grey(const Rgb& s) { return s.x == s.y && s.y == s.z; }
inline bool is_finite(const Rgb& s) {
  return std::isfinite(s.x) && std::isfinite(s.y) && std::isfinite(s.z);
}
/// Relative luminance of linear Rec. 709 values.
inline float luminance(const Rgb& s) { return 0.2126F * s.x + 0.7152F * s.y + 0.0722F * s.z; }

}  // namespace freepath
