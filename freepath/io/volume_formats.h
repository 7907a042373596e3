#pragma once
/// @file The readers behind freepath/io/volume.h, one for each format.

#include <filesystem>
#include <memory>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/io/volume.h"
#include "freepath/io/volume_assembly.h"
#include "freepath/io/volume_file.h"

namespace freepath::io {

/// A grid that was read: its assembly has no bricks unless values were to be kept.
struct AssembledGrid {
  std::unique_ptr<GridAssembly> assembly;
  GridScan scan;
};

/// An open volume file of any format.
class VolumeReader {
 public:
  virtual ~VolumeReader() = default;
  /// What the directory tells of each grid, without reading voxels.
  virtual std::vector<GridInfo> heads() const = 0;
  /// Whether there is a reader for the type of a grid, even if the grid can't be loaded.
  virtual bool is_readable(const GridInfo& head) const = 0;
  /// Reads a grid. May be called by one thread at a time.
  virtual AssembledGrid read(const GridInfo& head, const LoadOptions& options,
                             bool keep_values) const = 0;
  /// What is left to do about the fields of a grid: those in a frustum are resampled.
  virtual void finish(const GridInfo& /*head*/, std::vector<LoadedField>& /*fields*/) const {}
};

using VolumeReaderPointer = std::unique_ptr<VolumeReader>;

// Readers of each format; the file must outlive them. All throw Error if the header, or directory
// of grids, is damaged or says what can't be read.

VolumeReaderPointer open_vdb(const VolumeFile& file);
VolumeReaderPointer open_nvdb(const VolumeFile& file);
VolumeReaderPointer open_vti(const VolumeFile& file);
VolumeReaderPointer open_vtk_legacy(const VolumeFile& file);
VolumeReaderPointer open_nrrd(const VolumeFile& file);
VolumeReaderPointer open_metaimage(const VolumeFile& file);
/// @param packed the whole file by gzip
VolumeReaderPointer open_nifti(const VolumeFile& file, bool packed);
VolumeReaderPointer open_raw(const VolumeFile& file, const RawLayout& layout);
/// @param options the effective radius alone counts
VolumeReaderPointer open_netcdf(const VolumeFile& file, const LoadOptions& options);

// What files are whose first bytes are no mark of a fixed length.

/// Whether a file begins as VTK's XML does.
bool is_vti(const VolumeFile& file);
/// Whether a file begins with a field of MetaImage's headers.
bool is_metaimage(const VolumeFile& file);
/// Whether a file, which is not packed, has the marks of NIfTI.
bool is_nifti(const VolumeFile& file);
/// The header that stands beside a file whose name ends in .raw: FILE.raw.nhdr, FILE.nhdr,
/// FILE.raw.mhd or FILE.mhd; empty where there is none.
std::filesystem::path raw_header_beside(const std::filesystem::path& path);

}  // namespace freepath::io
