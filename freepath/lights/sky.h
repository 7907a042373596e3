#pragma once
/// @file The sky on a clear day, and the ground under it.

#include "freepath/base/up_axis.h"
#include "freepath/lights/environment.h"
#include "freepath/lights/sun.h"

namespace freepath {

/// What an observer sees around, some hundred metres above a ground of gentle hues, baked into an
/// image of 512×256 pixels: the sky of an Atmosphere without the sun's disc, and below the horizon
/// the sunlit ground, which fades into haze with distance.
/// @param sun its irradiance, where it is given, lights the ground; the sky is that of the real sun
/// @throws Error for a sun below the horizon, which lights no sky, or a turbidity not in [2, 10]
ImageEnvironment make_sky(const SunParameters& sun, UpAxis up);

}  // namespace freepath
