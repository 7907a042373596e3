#pragma once
/// @file Spectra that scenes name.

#include <span>
#include <string_view>

#include "freepath/spectra/linear_spectrum.h"

namespace freepath {

/// All names, which are those of pbrt's scenes: "stdillum-D65", "metal-Au-eta", "glass-BK7" (and
/// "stdillum-E"). Pbrt's "metal-CuZn" and its spectra of cameras' sensors are not among them.
std::span<const std::string_view> spectrum_names();

/// The spectrum of this name. Illuminants have a luminance of 1; metals are n ("eta") and k of a
/// complex refractive index; glasses are a refractive index.
/// @throws Error with the nearest name for an unknown one
LinearSpectrum named_spectrum(std::string_view name);

}  // namespace freepath
