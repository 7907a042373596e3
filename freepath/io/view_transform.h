#pragma once
/// @file What becomes of light that is brighter than a screen's white.

#include "freepath/base/vector.h"

namespace freepath {

/// Light of a scene → light of a screen, both linear sRGB.
enum class ViewTransform {
  kStandard,  ///< Colours as they are; what is brighter than the screen is clipped.
  kNeutral,   ///< The neutral tone mapper of [KhronosNeutral].
};

/// The value for a screen; what is outside [0, 1] still is to be clipped.
///
/// The neutral transform takes off what a glossy surface reflects of its surroundings, leaves all
/// below 0.76 in its hue and brightness otherwise, and lets the rest roll off towards white, so
/// that a sunlit cloud keeps its relief.
/// @param light not negative
Vec3f view_transform(const Vec3f& light, ViewTransform transform);

}  // namespace freepath
