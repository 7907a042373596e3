#pragma once
/// @file Image formats to read, by OpenImageIO, in a library of their own: it brings 250 others,
/// which take longer to load than most runs of the program take, and is loaded when the first image
/// is read.

#include <cstdint>
#include <string>
#include <vector>

#include "freepath/io/image.h"

namespace freepath {

/// Functions of the library of image formats.
struct ImageCodec {
  /// The version of freepath that it was built with.
  const char* version;
  /// Reads the first part of a file, as it is stored; memory grows with what the file delivers.
  /// @param stored size of the file [bytes]
  /// @param srgb set where the values are of the sRGB transfer function
  /// @param alpha number of the channel that holds no colour; -1: none
  /// @return the reason why it could not; empty: it is done
  std::string (*read)(const std::string& path, uint64_t stored, Image& image, bool& srgb,
                      int& alpha);
};

/// The function that the library exports; it returns the table of functions.
inline constexpr const char* kImageCodecFunction = "freepath_image_codec";

/// The library, loaded by the first call; from any thread.
/// @throws Error that says what to do, if it is missing or of another version
const ImageCodec& image_codec();

}  // namespace freepath
