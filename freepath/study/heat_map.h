#pragma once
/// @file Numbers as colours.

#include <cstdint>
#include <span>
#include <vector>

#include "freepath/io/image.h"

namespace freepath {

/// How numbers become colours.
struct ColorScale {
  double low = 0, high = 1;
  bool logarithmic = false;
  /// Whether colours go from blue over white to red, for values on both sides of the middle; else
  /// from dark to bright (the colours of viridis).
  bool diverging = false;

  /// Position on the scale, 0 to 1; beyond its ends the ends.
  double position(double value) const;
  /// The value at a position.
  double value(double position) const;
};

/// A picture of values, linear sRGB; a value that is not finite is grey.
/// @param values one a pixel, row after row
Image heat_map(std::span<const float> values, int width, int height, const ColorScale& scale);

/// The colours of a scale from left to right.
Image color_bar(const ColorScale& scale);

/// A logarithmic scale that holds most values of several maps: from their 2nd percentile to their
/// 99.8th, those that are not above 0 left out.
ColorScale logarithmic_scale(const std::vector<std::span<const float>>& maps);

}  // namespace freepath
