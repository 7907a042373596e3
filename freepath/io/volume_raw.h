#pragma once
/// @file Values without a header, whose layout is told.

#include <bit>
#include <cstdint>
#include <string>

#include "freepath/base/vector.h"

namespace freepath {

/// How the values of a file without a header lie in it: x fastest, then y, then z.
struct RawLayout {
  Vec3i counts{0};                          ///< Voxels along each axis.
  std::string type = "float32";             ///< "int8", "uint8", ... "float32", "float64".
  std::endian order = std::endian::little;  ///< Order of the bytes in a number.
  uint64_t offset = 0;                      ///< Bytes before the first value.
  Vec3d spacing{1}, origin{0};              ///< Steps between samples, and place of the first.
};

}  // namespace freepath
