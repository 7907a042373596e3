#include "freepath/sensors/tile.h"

#include "freepath/base/error.h"

namespace freepath {

Crop tile_of(const PixelWindow& window, const Tile& tile) {
  const auto rows = static_cast<uint32_t>(window.height);
  if (tile.count > rows) {
    fail("{} tiles of {} rows of pixels; give at most as many tiles as rows", tile.count, rows);
  }
  const auto row = [&](uint32_t number) {
    const uint64_t first = uint64_t{rows} * number / tile.count;
    return window.y + static_cast<double>(first);
  };
  return {static_cast<double>(window.x), row(tile.number - 1),
          static_cast<double>(window.x + window.width), row(tile.number)};
}

}  // namespace freepath
