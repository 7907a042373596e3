#pragma once
/// @file Files of formats with a value for each voxel, for tests: what stands in them, their bytes,
/// and what must be read. Their bytes are made here from the formats' descriptions, by no library.

#include <bit>
#include <filesystem>
#include <string>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/io/volume.h"

namespace freepath::testing_volumes {

/// Where samples lie.
struct SampleGrid {
  Vec3i counts = Vec3i(10, 9, 11);
  Matrix4d index_to_world;
};

/// A grid of samples whose steps differ along all axes, turned about z if that is wanted.
/// @param shift of the samples, in steps: 0.5 for those in cells
SampleGrid sample_positions(double shift = 0, bool turned = true);

/// The function that tests sample: affine, so that the trilinear interpolant is the same between
/// samples, and different along all axes.
double affine_density(const Vec3d& position);

/// Its values at the samples, x fastest.
std::vector<double> affine_values(const SampleGrid& grid);

/// Numbers as they are stored.
template <class T>
std::string stored(const std::vector<double>& values, std::endian order = std::endian::little);

/// Numbers as text.
std::string as_text(const std::vector<double>& values);

std::string base64(const std::string& bytes);
/// A stream of zlib's.
std::string zlib_packed(const std::string& bytes);

/// A row of a matrix, its columns between a mark: "1 0 0".
std::string row_text(const Matrix4d& matrix, int row, const char* between = " ");

void write_text(const std::filesystem::path& path, const std::string& text);

/// Fails the test if a field is not the affine function at the samples and between them.
void expect_affine(const LoadedField& loaded, const SampleGrid& grid, double tolerance = 1e-6);

/// Loads a file that may be damaged, which must give a field or an Error that begins with the
/// file's name.
/// @return the message; empty if there was none
std::string load_message(const std::filesystem::path& path);

/// How the array of a .vti file is stored.
struct VtiStorage {
  std::string format = "appended";  ///< "ascii", "binary" or "appended".
  bool base64 = false;              ///< Appended data are text.
  bool packed = false;              ///< By zlib.
  bool wide = false;                ///< 64-bit numbers before the data.
  bool big_endian = false;
  bool cells = false;
  bool doubles = false;
};

/// A .vti file of the affine function.
std::string vti_file(const VtiStorage& storage = {});
/// The grid that must come out of it.
SampleGrid vti_samples(const VtiStorage& storage = {});

/// A legacy .vtk file of the affine function, as scalars and again as the field "again".
std::string legacy_vtk_file(bool text, bool cells);
SampleGrid legacy_vtk_samples(bool cells);

/// A NRRD file of the affine function in doubles.
std::string nrrd_file(const std::string& encoding, bool big_endian = false);

/// A MetaImage file of one part.
std::string metaimage_file(bool packed, bool big_endian = false);

/// A NIfTI file of floats.
/// @param version 1 or 2
/// @param quaternion whether the transform is a qform, else an sform
std::string nifti_file(int version, bool quaternion, bool big_endian = false);

}  // namespace freepath::testing_volumes
