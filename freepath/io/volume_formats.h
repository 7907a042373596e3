#pragma once
/// @file The readers behind freepath/io/volume.h, one for each format.

#include <vector>

#include "freepath/io/volume.h"
#include "freepath/io/volume_file.h"

namespace freepath::io {

std::vector<GridInfo> list_vdb_grids(const VolumeFile& file);
std::vector<LoadedField> load_vdb_fields(const VolumeFile& file, const LoadOptions& options);

std::vector<GridInfo> list_nvdb_grids(const VolumeFile& file);
std::vector<LoadedField> load_nvdb_fields(const VolumeFile& file, const LoadOptions& options);

}  // namespace freepath::io
