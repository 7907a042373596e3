#pragma once
/// @file Images written to files that are open already.

#include <string>

#include "freepath/io/atomic_file.h"
#include "freepath/io/image.h"

namespace freepath {

/// Writes an EXR file as the function of that name for paths does.
void write_exr(AtomicFile& file, const Image& image, const ExrFormat& format = {});

/// Writes a PNG file as the function of that name for paths does.
void write_png(AtomicFile& file, const Image& image, const PictureLook& look = {});

/// Writes a PFM or QOI file as the function of that name for paths does.
void write_plain_image(AtomicFile& file, const Image& image, const PictureLook& look = {});

/// Writes an image in the format of the file's extension: all channels to an EXR file, else the
/// colour.
/// @param look of formats of 8 bits
/// @param format of an EXR file
/// @throws Error that names the file
void write_image(AtomicFile& file, const Image& image, const PictureLook& look,
                 const ExrFormat& format = {});

/// Whether the extension is that of an EXR file, which holds all channels.
bool is_exr(const std::string& path);

}  // namespace freepath
