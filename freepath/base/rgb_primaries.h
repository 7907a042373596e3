#pragma once
/// @file What R, G and B of a linear colour space are: the chromaticities of its primaries and
/// white.

#include <algorithm>
#include <cmath>

#include "freepath/base/vector.h"

namespace freepath {

/// Matrix for vectors as rows, as all of the project: `xyz = rgb * rgb_to_xyz`.
using Matrix3d = Imath::M33d;

/// A colour without its luminance: x = X / (X + Y + Z), and y likewise.
struct Chromaticity {
  double x = 0, y = 0;
};

/// X, Y, Z of a chromaticity with Y = 1.
inline Vec3d xyz_of(const Chromaticity& chromaticity) {
  const auto [x, y] = chromaticity;
  return {x / y, 1, (1 - x - y) / y};
}

/// Chromaticities of the three colours that a space mixes.
struct RgbPrimaries {
  Chromaticity red, green, blue;
};

/// Chromaticities of the primaries and the white point of a linear RGB space; those of sRGB (Rec.
/// 709) where nothing is said [IEC61966].
struct RgbChromaticities {
  RgbPrimaries primaries = {{0.640, 0.330}, {0.300, 0.600}, {0.150, 0.060}};
  Chromaticity white = {0.3127, 0.3290};
};

/// Whether both mean the same space, as exactly as files and standards agree about one.
inline bool are_same(const RgbChromaticities& a, const RgbChromaticities& b) {
  const auto near = [](const Chromaticity& c, const Chromaticity& d) {
    return std::max(std::abs(c.x - d.x), std::abs(c.y - d.y)) < 5e-4;
  };
  return near(a.primaries.red, b.primaries.red) && near(a.primaries.green, b.primaries.green) &&
         near(a.primaries.blue, b.primaries.blue) && near(a.white, b.white);
}

/// The matrix from RGB to XYZ that makes (1, 1, 1) the white point with Y = 1.
inline Matrix3d rgb_to_xyz_matrix(const RgbPrimaries& primaries, const Chromaticity& white) {
  // With z = 1 - x - y in place of X, Y, Z there is no division by the y of a primary, which is
  // negative in the case of ACES.
  const auto row = [](const Chromaticity& c) { return Vec3d(c.x, c.y, 1 - c.x - c.y); };
  const Vec3d red = row(primaries.red), green = row(primaries.green), blue = row(primaries.blue);
  const Matrix3d unscaled(red.x, red.y, red.z, green.x, green.y, green.z, blue.x, blue.y, blue.z);
  const Vec3d amounts = xyz_of(white) * unscaled.inverse(true);
  const Vec3d r = red * amounts.x, g = green * amounts.y, b = blue * amounts.z;
  return {r.x, r.y, r.z, g.x, g.y, g.z, b.x, b.y, b.z};
}

/// The matrix from the RGB of a space to that of another, by way of XYZ: a colour stays the same
/// light, and white need not stay (1, 1, 1).
inline Matrix3d rgb_to_rgb_matrix(const RgbChromaticities& from, const RgbChromaticities& to) {
  return rgb_to_xyz_matrix(from.primaries, from.white) *
         rgb_to_xyz_matrix(to.primaries, to.white).inverse(true);
}

}  // namespace freepath
