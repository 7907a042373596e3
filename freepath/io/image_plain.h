#pragma once
/// @file Image formats that are plain enough to be written here: PFM and QOI.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "freepath/io/image.h"

namespace freepath {

/// Whether the extension is that of a plain format: ".pfm" or ".qoi".
bool is_plain_image(const std::string& path);

/// Writes the colour to a PFM or QOI file, in the same two steps as write_exr.
/// @param look of a QOI file
/// @throws Error that names the file
void write_plain_image(const std::string& path, const Image& image, const PictureLook& look = {});

/// The colour as pixels of three bytes: times 2^exposure, through the view transform, clipped to
/// [0, 1], with the sRGB transfer function; NaN is black.
/// @param name what to call the image in a message
/// @throws Error if there is no colour, or the exposure is not finite
std::vector<uint8_t> srgb_pixels(const Image& image, const PictureLook& look,
                                 const std::string& name);

/// The bytes of a PFM file of the colour: R, G and B as they are, in single precision.
/// @param name what to call the image in a message
/// @throws Error if there is no colour
std::vector<uint8_t> encode_pfm(const Image& image, const std::string& name);

/// The bytes of a QOI file [Szablewski21], "quite OK image", of sRGB pixels of three bytes, row by
/// row from the top.
/// @param pixels 3 · width · height
std::vector<uint8_t> encode_qoi(int width, int height, std::span<const uint8_t> pixels);

}  // namespace freepath
