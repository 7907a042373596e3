#pragma once
/// @file A picture as a set of estimates: means, how far they are to be trusted, and sums of them.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "freepath/io/image.h"
#include "freepath/sensors/film.h"

namespace freepath {

/// R, G and B of every pixel, row after row, and the variance of each.
struct PixelEstimates {
  int width = 0, height = 0;
  /// Primaries of the space of R, G and B, where it is not sRGB's.
  std::optional<RgbChromaticities> chromaticities = {};
  std::vector<float> mean = {};      ///< Three a pixel.
  std::vector<float> variance = {};  ///< Variances of the means; three a pixel.
  std::vector<float> samples = {};   ///< Samples, one number a pixel; 1 where they are not known.
  bool knows_samples = true;
  std::vector<float> lookups = {};  ///< Look-ups of a path, on average; one a pixel, or none.

  std::size_t pixel_count() const { return static_cast<std::size_t>(width) * height; }
};

PixelEstimates estimates_of(const Film& film);
/// R, G and B of a film alone, three a pixel.
std::vector<float> colours_of(const Film& film);

/// Estimates from a picture in a file: its variances stand in variance.R, G and B, or follow from
/// the halves A.R, ... and B.R, ...
/// @param name of the file, for messages
/// @throws Error where it has no colour, values that are not finite or variances below 0
/// @param variance_known tells whether it has either; where not, variances are 0
PixelEstimates estimates_of(const Image& image, const std::string& name, bool& variance_known);

/// An image of R, G, B, variances and samples.
Image to_image(const PixelEstimates& estimates);

/// Estimates from the samples of all of them together; each pixel of each counts by its samples.
/// @param parts at least one, of one size
PixelEstimates merged(const std::vector<const PixelEstimates*>& parts);

}  // namespace freepath
