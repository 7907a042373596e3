#pragma once
/// @file Small files for the program to work on.

#include <functional>
#include <string>

#include "freepath/base/vector.h"

namespace freepath::testing {

/// A ball of density, 16 voxels wide, thickest in its middle: 2·(1 - r²/64).
float ball(const Vec3i& voxel);

/// Writes a grid "density" of 16³ voxels of size 1/8, around the origin, to a .vdb file.
void write_cube(const std::string& file, const std::function<float(const Vec3i&)>& density = ball);

/// Writes the same with other placements in the world.
void write_cube(const std::string& file, const std::function<float(const Vec3i&)>& density,
                const Matrix4d& index_to_world);

/// Writes an image of 16x8 pixels of one value, with another one in a single pixel.
void write_environment(const std::string& file, float value, float odd_value);

/// Writes a file of this text.
void write_text(const std::string& file, const std::string& text);

/// Shortens a file to a part of its length.
void truncate_file(const std::string& file, double part);

}  // namespace freepath::testing
