#pragma once
/// @file Tiles: bands of rows that a picture is cut into.

#include <cstdint>

#include "freepath/sensors/pixel_window.h"

namespace freepath {

/// One of the tiles that a picture is cut into.
struct Tile {
  uint32_t number = 1;  ///< Counted from 1.
  uint32_t count = 1;
};

/// The rows of a window that a tile has, as a crop of the picture in pixels.
/// @throws Error for more tiles than rows
Crop tile_of(const PixelWindow& window, const Tile& tile);

}  // namespace freepath
