#pragma once
/// @file Writing scalar fields to OpenVDB files.

#include <filesystem>
#include <span>

#include "freepath/media/field.h"

namespace freepath {

struct VdbWriteOptions {
  bool half = false;  ///< Store values in half precision: half the size, 11 significant bits.
};

/// Checks, before the work is done, that a file could stand there: its folder exists, and it is
/// none itself.
/// @throws Error that names the file
void check_vdb_place(const std::filesystem::path& path);

/// Writes fields as float fog volumes of one .vdb file, compressed by blosc. Voxels of value 0 are
/// inactive; a brick of one value becomes a tile. The same fields give the same bytes.
///
/// The file is written under another name in the same folder and then renamed: under its own name
/// there is never a part of it, and an existing file is replaced only by a whole one.
/// @throws Error if there is no field, a transform is not invertible, or the file can't be written
void write_vdb(const std::filesystem::path& path, std::span<const Field* const> fields,
               const VdbWriteOptions& options = {});

}  // namespace freepath
