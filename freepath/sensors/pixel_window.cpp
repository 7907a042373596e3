#include "freepath/sensors/pixel_window.h"

#include <cmath>

#include "freepath/base/error.h"

namespace freepath {
namespace {

/// So that 0.7 of 10 pixels are 7, whichever way it is rounded.
constexpr double kRounding = 1e-4;

}  // namespace

PixelWindow pixel_window(const std::optional<Crop>& crop, int width, int height) {
  if (!crop) return PixelWindow::whole(width, height);
  const double x_scale = crop->fractions ? width : 1;
  const double y_scale = crop->fractions ? height : 1;
  const double x0 = std::ceil(crop->x0 * x_scale - kRounding);
  const double y0 = std::ceil(crop->y0 * y_scale - kRounding);
  const double x1 = std::ceil(crop->x1 * x_scale - kRounding);
  const double y1 = std::ceil(crop->y1 * y_scale - kRounding);
  if (!(x0 >= 0 && y0 >= 0 && x1 <= width && y1 <= height)) {
    fail("the crop from {},{} to before {},{} is not within the picture of {}x{} pixels", x0, y0,
         x1, y1, width, height);
  }
  if (!(x0 < x1 && y0 < y1)) {
    fail("the crop from {},{} to before {},{} has no pixel", x0, y0, x1, y1);
  }
  return {static_cast<int>(x0),
          static_cast<int>(y0),
          static_cast<int>(x1 - x0),
          static_cast<int>(y1 - y0),
          width,
          height};
}

}  // namespace freepath
