#pragma once
/// @file Images as bytes of EXR and PNG files, by these formats' own libraries: writing needs no
/// other, and is there at once.

#include <cstdint>
#include <string>
#include <vector>

#include "freepath/io/image.h"

namespace freepath {

/// Writes an EXR file. Whole numbers of the metadata that its integers can't hold become texts.
/// @return the reason why it could not; empty: it is written
std::string write_exr_values(const std::string& name, const Image& image, const ExrFormat& format);

/// Encodes sRGB pixels as a PNG file.
/// @param rgb 3 · width · height values
/// @return the reason why it could not; empty: it is done
std::string encode_png_pixels(int width, int height, const uint8_t* rgb,
                              std::vector<uint8_t>& encoded);

}  // namespace freepath
