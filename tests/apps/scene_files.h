#pragma once
/// @file Small files for the program to work on.

#include <functional>
#include <string>

#include "freepath/base/vector.h"

namespace freepath::testing {

/// The density of a voxel.
using Density = std::function<float(const Vec3i&)>;

/// A ball of density, 16 voxels wide, thickest in its middle: 2·(1 - r²/64).
float ball(const Vec3i& voxel);

/// Index space to a world in which voxels are 1/8 wide.
inline Matrix4d eighths() { return Matrix4d().setScale(Vec3d(0.125)); }

/// Writes a grid "density" of 16³ voxels around the origin to a .vdb file.
void write_cube(const std::string& file, const Density& density = ball,
                const Matrix4d& index_to_world = eighths());

/// Index space to a world that overlaps that of eighths(): larger voxels than a cube's, turned,
/// mirrored and moved.
inline Matrix4d turned() {
  return Matrix4d().setScale(Vec3d(-0.15, 0.1, 0.12)) * Matrix4d().rotate(Vec3d(0.4, -0.7, 1)) *
         Matrix4d().setTranslation(Vec3d(0.6, 0.3, -0.2));
}

/// Writes an image of 16x8 pixels of one value, with another one in a single pixel.
void write_environment(const std::string& file, float value, float odd_value);

/// Writes a file of this text.
void write_text(const std::string& file, const std::string& text);

/// Shortens a file to a part of its length.
void truncate_file(const std::string& file, double part);

}  // namespace freepath::testing
