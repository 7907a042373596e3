#pragma once
/// @file Writing scalar fields to volume files.

#include <filesystem>
#include <span>
#include <string>

#include "freepath/io/atomic_file.h"
#include "freepath/media/field.h"

namespace freepath {

struct VdbWriteOptions {
  /// Store values in 16 bits: reals of half precision, with 11 significant bits, in OpenVDB files,
  /// steps of 2^-16 of the range of each 8³ block in NanoVDB files.
  bool half = false;
};

/// A format that fields are written in.
enum class VolumeFormat { kVdb, kNvdb, kVti };

/// The format of a file's extension, .vdb, .nvdb or .vti.
/// @throws Error that names the file, for another extension
VolumeFormat volume_format(const std::string& path);

/// Writes fields as float fog volumes of one .vdb file, compressed by blosc. Voxels of value 0 are
/// inactive; a brick of one value becomes a tile. The same fields give the same bytes.
///
/// The file is written aside and then renamed: under its own name there is never a part of it, and
/// an existing file is replaced only by a whole one.
/// @throws Error if there is no field, a transform is not invertible, or the file can't be written
void write_vdb(const std::filesystem::path& path, std::span<const Field* const> fields,
               const VdbWriteOptions& options = {});
/// Writes grids to a file that is open already.
void write_vdb(AtomicFile& file, std::span<const Field* const> fields,
               const VdbWriteOptions& options = {});

/// Writes fields as fog volumes of one NanoVDB file, packed by zip. The same fields give the same
/// bytes.
/// @throws Error as write_vdb
void write_nvdb(AtomicFile& file, std::span<const Field* const> fields,
                const VdbWriteOptions& options = {});

/// Writes fields as point data of one VTK image (.vti), floats behind the markup: a value for every
/// voxel of the box that holds all active ones.
/// @throws Error as write_vdb, and if the fields stand in different grids or the edges of their
/// voxels are not perpendicular, which the format can't tell
void write_vti(AtomicFile& file, std::span<const Field* const> fields);

/// Writes fields in the format of the file's extension.
/// @throws Error as the function of that format, and if a VTK image is to hold halves
void write_volume(AtomicFile& file, std::span<const Field* const> fields,
                  const VdbWriteOptions& options = {});

}  // namespace freepath
