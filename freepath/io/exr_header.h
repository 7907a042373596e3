#pragma once
/// @file The header of an EXR file, checked before OpenEXR takes memory for what it declares.

#include "freepath/base/input_file.h"

namespace freepath::io {

/// Checks that every attribute in the headers of an EXR file has its type's size and can be in the
/// file. OpenEXR trusts sizes of up to 2 GB and takes memory for them. Files of other formats pass.
/// @throws Error that names the file and the attribute
void check_exr_header(const InputFile& file);

}  // namespace freepath::io
