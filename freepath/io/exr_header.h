#pragma once
/// @file The header of an EXR file, checked before OpenEXR takes memory for what it declares.

#include "freepath/base/input_file.h"

namespace freepath::io {

/// Checks that every attribute in the headers of an EXR file has its type's size and can be in the
/// file, and that so many pixels, and what is packed together of them, can come out of it. OpenEXR
/// trusts all of that and takes memory for it as it opens the file. Files of other formats pass.
/// @throws Error that names the file and the attribute or size
void check_exr_header(const InputFile& file);

}  // namespace freepath::io
