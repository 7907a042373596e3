#pragma once
/// @file Images of the whole sphere in latitude-longitude form: where a direction stands in one.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "freepath/base/distributions.h"
#include "freepath/base/turn.h"
#include "freepath/base/up_axis.h"
#include "freepath/base/vector.h"

namespace freepath {

/// A point of a latitude-longitude image; both coordinates run from 0 to 1, (0, 0) is the upper
/// left corner. The convention is OpenEXR's: with y up, the centre of the image is the direction
/// +z, +x lies a quarter to the left of it, -x a quarter to the right, and the top row is the
/// zenith. With z up the centre is -y (up_axis.h).
struct LatLong {
  float u, v;
};

/// The point of such an image that a direction sees.
/// @param direction unit [world]
inline LatLong lat_long(const Vec3f& direction, UpAxis up) {
  const Vec3f d = to_y_up(direction, up);
  constexpr float kInversePi = std::numbers::inv_pi_v<float>;
  return {0.5F - fast_atan2(d.x, d.z) * (0.5F * kInversePi),
          fast_atan2(std::sqrt(d.x * d.x + d.z * d.z), d.y) * kInversePi};
}

/// The inverse of lat_long.
/// @param u horizontal coordinate in [0, 1]
/// @param height cosine of the angle from the zenith
inline Vec3f lat_long_direction(float u, float height, UpAxis up) {
  const SinCos longitude = sincos_of_turn(u);  // from -z
  const float reach = std::sqrt(std::max(0.0F, (1.0F - height) * (1.0F + height)));
  return from_y_up({reach * longitude.sine, height, -reach * longitude.cosine}, up);
}

/// The pixels of a latitude-longitude image, at most 2^32; pixel (column, row) has the number
/// row · width + column.
struct LatLongGrid {
  int width = 1, height = 1;
  UpAxis up = UpAxis::kY;
};

/// Where a point stands between the centres of four pixels, as a bilinear interpolant takes them;
/// it wraps around horizontally and is continued by the last row at the poles.
struct LatLongPlace {
  /// Numbers of the upper left pixel, the upper right, the lower left and the lower right.
  std::array<uint32_t, 4> corners;
  float right, down;  ///< How far the point is from the first, in pixels, in [0, 1).
};

/// The place of a point of an image.
/// @param x in pixels from the left edge
/// @param y in pixels from the top
[[gnu::always_inline]] inline LatLongPlace place_of(const LatLongGrid& grid, float x, float y) {
  // Not below -1, so that truncating x + 1 rounds x down.
  int left = static_cast<int>((x - 0.5F) + 1.0F) - 1;
  const int above = static_cast<int>((y - 0.5F) + 1.0F) - 1;
  LatLongPlace place;
  place.right = (x - 0.5F) - static_cast<float>(left);
  place.down = (y - 0.5F) - static_cast<float>(above);
  int right = left + 1;
  if (left < 0) left += grid.width;
  if (right >= grid.width) right -= grid.width;
  const auto row_begin = [&](int row) {
    return static_cast<uint32_t>(std::clamp(row, 0, grid.height - 1)) *
           static_cast<uint32_t>(grid.width);
  };
  const uint32_t upper = row_begin(above);
  const uint32_t lower = row_begin(above + 1);
  const auto columns = std::array{static_cast<uint32_t>(left), static_cast<uint32_t>(right)};
  place.corners = {upper + columns[0], upper + columns[1], lower + columns[0], lower + columns[1]};
  return place;
}

/// The number of the pixel that holds that point.
[[gnu::always_inline]] inline uint32_t pixel_at(const LatLongGrid& grid, float x, float y) {
  const int column = std::clamp(static_cast<int>(x), 0, grid.width - 1);
  const int row = std::clamp(static_cast<int>(y), 0, grid.height - 1);
  return static_cast<uint32_t>(row) * static_cast<uint32_t>(grid.width) +
         static_cast<uint32_t>(column);
}

/// Directions, and where they stand in a latitude-longitude image, in rows that lanes read and
/// write.
struct LatLongStream {
  static constexpr std::size_t kCapacity = 64;
  template <class T>
  struct alignas(64) Row : std::array<T, kCapacity> {};

  std::size_t count = 0;
  std::array<Row<float>, 3> direction{};   ///< Unit [world]; those behind the last are finite.
  Row<uint32_t> pixel{};                   ///< pixel_at()
  std::array<Row<uint32_t>, 4> corners{};  ///< LatLongPlace::corners
  Row<float> right{}, down{};              ///< Those of LatLongPlace.

  LatLongPlace place(std::size_t i) const {
    return {{corners[0][i], corners[1][i], corners[2][i], corners[3][i]}, right[i], down[i]};
  }
};

/// Fills the rows of a stream behind its directions.
using LocateDirections = void (*)(const LatLongGrid& grid, LatLongStream& stream);

}  // namespace freepath
