#pragma once
/// @file Writing scalar fields to OpenVDB files.

#include <filesystem>
#include <span>

#include "freepath/io/aside_file.h"
#include "freepath/media/field.h"

namespace freepath {

struct VdbWriteOptions {
  bool half = false;  ///< Store values in half precision: half the size, 11 significant bits.
};

/// Writes fields as float fog volumes of one .vdb file, compressed by blosc. Voxels of value 0 are
/// inactive; a brick of one value becomes a tile. The same fields give the same bytes.
///
/// The file is written aside and then renamed: under its own name there is never a part of it, and
/// an existing file is replaced only by a whole one.
/// @throws Error if there is no field, a transform is not invertible, or the file can't be written
void write_vdb(const std::filesystem::path& path, std::span<const Field* const> fields,
               const VdbWriteOptions& options = {});
/// The same to a file that is open already.
void write_vdb(AsideFile& file, std::span<const Field* const> fields,
               const VdbWriteOptions& options = {});

}  // namespace freepath
