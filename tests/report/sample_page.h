#pragma once
/// @file A page with every kind of block, as a comparison of trackers would fill it.

#include "freepath/report/chart.h"
#include "freepath/report/page.h"

namespace freepath::testing {

/// Colour of a pixel, each channel in [0, 255].
struct Rgb {
  int red = 0, green = 0, blue = 0;
};

/// A PNG file with a colour for each (column, row).
template <class Function>
PngBytes make_png(int width, int height, Function&& colour);

/// PNG file of pixels, row by row from the top, three bytes each.
PngBytes encode_png(int width, int height, const std::vector<uint8_t>& pixels);

template <class Function>
PngBytes make_png(int width, int height, Function&& colour) {
  std::vector<uint8_t> pixels;
  pixels.reserve(static_cast<std::size_t>(width) * height * 3);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Rgb rgb = colour(column, row);
      for (const int value : {rgb.red, rgb.green, rgb.blue}) {
        pixels.push_back(static_cast<uint8_t>(value));
      }
    }
  }
  return encode_png(width, height, pixels);
}

/// Six lines with bands and markers, and a reference.
Chart sample_chart();
/// Six bars with errors, a best one and a mark.
BarChart sample_bars();
/// All kinds of blocks.
Page sample_page();

}  // namespace freepath::testing
