#pragma once
/// @file The balance of white: pictures under a light as if it were another.

#include "freepath/base/rgb_primaries.h"
#include "freepath/spectra/rgb_color_space.h"

namespace freepath {

/// The matrix that takes R, G, B of a space to those of a film of that space that is balanced for
/// light of a temperature: daylight of that temperature becomes R = G = B. The responses of cones,
/// as Bradford's matrix estimates them, are scaled each by itself [Lam85].
/// @param temperature correlated colour temperature of CIE daylight, below 4000 K (where that is
/// not
///   defined) of a black body [K], 1000 to 25000
/// @throws Error outside that range
Matrix3d white_balance(double temperature, const RgbColorSpace& space);

}  // namespace freepath
