#pragma once
/// @file Fields as grids of OpenVDB, on their way into files.

#include <openvdb/openvdb.h>

#include "freepath/media/field.h"

namespace freepath::io {

/// A fog volume with the field's name, transform and voxels. Those of value 0 are inactive; a brick
/// of one value is a tile. OpenVDB must have been initialized.
openvdb::FloatGrid::Ptr openvdb_grid_of(const Field& field);

}  // namespace freepath::io
