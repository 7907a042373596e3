#pragma once
/// @file What becomes of values that can't be used: NaN, infinite, or out of the range of float.
/// One rule for voxels and for pixels.

#include <string>

#include "freepath/io/image.h"

namespace freepath {

/// What to do about a value that is NaN, infinite or out of the range of float: refuse the input,
/// or put 0 in its place and say how many there were.
enum class InvalidPolicy { kError, kZero };

/// Puts 0 in place of the invalid values in the channels of colour and alpha of an image (R, G, B,
/// Y, A, or the only one), or refuses it.
/// @param name of the image, the beginning of messages
/// @return a warning with the number of pixels and the place of the first, empty if there are none
/// @throws Error that names the first pixel, under InvalidPolicy::kError
std::string mend_invalid_pixels(Image& image, const std::string& name, InvalidPolicy policy);

}  // namespace freepath
