#pragma once
/// @file Whether a NetCDF file of a classic format is whole, which its library doesn't look for: it
/// reads zeros behind the end of a file.

#include "freepath/io/volume_file.h"

namespace freepath::io {

/// Reads the header of a file that begins with "CDF", and nothing of other files.
/// @throws Error if the header is damaged, or the file ends before the values that it declares
void check_netcdf_whole(const VolumeFile& file);

}  // namespace freepath::io
