#pragma once
/// @file The readers behind freepath/io/volume.h, one for each format.

#include <functional>
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

/// An open volume file of either format.
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

/// @throws Error if the directory of grids is damaged
std::unique_ptr<VolumeReader> open_vdb(const VolumeFile& file);
std::unique_ptr<VolumeReader> open_nvdb(const VolumeFile& file);

}  // namespace freepath::io
