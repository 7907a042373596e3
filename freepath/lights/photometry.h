#pragma once
/// @file How bright the lights of a scene are, and whether their numbers can be light.

#include <optional>
#include <string>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/io/image.h"
#include "freepath/spectra/spectrum_table.h"

namespace freepath {

/// The factor that gives an emitted spectrum the brightness pbrt-v4 means by it: a luminance of 1
/// before `scale`, so that only its shape counts. RgbSpectrum::illuminant counts as it is, since
/// pbrt-v4 normalises only the illuminant under it, which has a luminance of 1 here: the observer
/// sees exactly the RGB given. Hence `power` and `illuminance` are those of the light for all other
/// spectra, and for RGB are multiplied by its luminance. A spectrum without luminance keeps its
/// values.
double photometric_scale(const SpectralDistribution& spectrum);

/// Luminance of (1, 0, 0), (0, 1, 0) and (0, 0, 1).
Vec3d luminance_weights(const RgbColorSpace& space);

/// A measure to choose lights by: the luminance; positive unless the spectrum is black.
double brightness(const SpectralDistribution& spectrum);

/// The factor for a spectrum: scale · photometric_scale, or what gives a target of 1 · target.
/// @param scale,target as described
/// @param flux_of_one what the target measures for a luminance of 1 (4π for a point's power)
/// @throws Error that names the light, for values that are negative or not finite, a spectrum with
///   negative values, and a target that cannot be reached since the light is black
double light_factor(const SpectralDistribution& spectrum, double scale,
                    const std::optional<double>& target, double flux_of_one,
                    const std::string& name);
/// The factor of lights whose colours are an image's: no spectrum is to be normalised.
double light_factor(double scale, const std::optional<double>& target, double flux_of_image,
                    const std::string& name);

/// The colours of an image, row by row. Negative values, which filters leave at sharp edges, are
/// taken as 0.
/// @throws Error that names the image and the pixel, if a value is infinite or NaN
std::vector<Vec3f> light_colours(const Image& image, const std::string& name);

/// @throws Error that names the image unless it is square and not empty
void check_octahedral(const Image& image, const std::string& name);

}  // namespace freepath
