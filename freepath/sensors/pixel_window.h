#pragma once
/// @file The part of a picture that is rendered.

#include <cstddef>
#include <optional>

namespace freepath {

/// A rectangle of pixels in a picture; row 0 is the top.
struct PixelWindow {
  int x = 0, y = 0;                     ///< Position of its first pixel in the picture.
  int width = 0, height = 0;            ///< Size of the window.
  int full_width = 0, full_height = 0;  ///< Size of the picture.

  static constexpr PixelWindow whole(int width, int height) {
    return {0, 0, width, height, width, height};
  }
  constexpr bool operator==(const PixelWindow&) const = default;
  constexpr bool is_whole() const { return width == full_width && height == full_height; }
  /// Where in the picture (row · full_width + column) a pixel of the window is, which is
  /// numbered row by row.
  /// @param pixel below 2^32
  constexpr uint32_t in_picture(std::size_t pixel) const {
    // Divisions of 32 bits take a third of the time.
    const auto number = static_cast<uint32_t>(pixel);
    if (width == full_width) return y * full_width + number;
    const auto columns = static_cast<uint32_t>(width);
    return (y + number / columns) * full_width + x + number % columns;
  }
};

/// What to cut out of a picture whose size may not be known yet: from (x0, y0) to before (x1, y1).
struct Crop {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool fractions = false;  ///< Whether in fractions of width and height, else in pixels.
};

/// The pixels that a crop leaves: fractions begin and end at the next whole pixel, as in pbrt.
/// @param crop none: the whole picture
/// @throws Error for one that is not within the picture, or without a pixel
PixelWindow pixel_window(const std::optional<Crop>& crop, int width, int height);

}  // namespace freepath
