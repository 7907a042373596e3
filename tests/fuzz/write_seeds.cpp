// Writes what the fuzzers begin with, into folders of the one that is given: small valid files of
// every kind that the readers know, and inputs that change those of volumes (volume_fuzz.cpp).

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/io/image.h"
#include "freepath/io/image_plain.h"
#include "tests/io/dense_files.h"
#include "tests/io/netcdf_files.h"
#include "tests/io/volume_files.h"
#include "tests/io/volume_oddities.h"

namespace freepath {
namespace {

namespace fs = std::filesystem;
using namespace testing_volumes;  // NOLINT(google-build-using-namespace)

/// Few voxels in two leaves, and a small tile.
TestGrid small_grid() {
  TestGrid grid;
  grid.voxels = {{Vec3i(0), 1.0}, {Vec3i(3, 2, 1), 2.0}, {Vec3i(-5, 4, 9), 0.5}};
  grid.tiles = {{Vec3i(8, 0, 0), 8, 0.25}};
  return grid;
}

void write_vdb_seeds(const fs::path& folder) {
  const TestGrid grid = small_grid();
  write_vdb_file(folder / "none", {grid}, VdbValues::kFloat, Codec::kNone);
  TestGrid tiles = grid;
  tiles.tiles.push_back({Vec3i(128, 0, 0), 128, 0.75});
  write_vdb_file(folder / "zip", {tiles}, VdbValues::kHalf, Codec::kZip);
  write_vdb_file(folder / "blosc", {grid, grid}, VdbValues::kDouble, Codec::kBlosc);
  write_vdb_vectors(folder / "vectors", {grid, grid, grid}, VectorValues::kFloat, Codec::kNone);
  write_vdb_whole(folder / "int32", WholeValues::kInt32);
  write_vdb_whole(folder / "bool", WholeValues::kBool);
  write_vdb_whole(folder / "mask", WholeValues::kMask);
  write_vdb_inactive(folder / "inactive", 0.5);
  write_vdb_shared(folder / "shared");
  write_vdb_stream(folder / "stream");
  write_vdb_old(folder / "old", 220, true);
  write_vdb_empty(folder / "empty");
  write_vdb_points(folder / "points");
}

void write_nvdb_seeds(const fs::path& folder) {
  const TestGrid grid = small_grid();
  write_nvdb_file(folder / "none", {grid}, NvdbValues::kFloat, Codec::kNone);
  write_nvdb_file(folder / "fp4", {grid}, NvdbValues::kFp4, Codec::kNone);
  write_nvdb_file(folder / "fpn", {grid}, NvdbValues::kFpN, Codec::kNone);
  write_nvdb_file(folder / "zip", {grid}, NvdbValues::kDouble, Codec::kZip);
  write_nvdb_file(folder / "blosc", {grid}, NvdbValues::kFp8, Codec::kBlosc);
  write_nvdb_vectors(folder / "vectors", {grid, grid, grid});
  write_nvdb_whole(folder / "mask", WholeValues::kMask);
  write_nvdb_whole(folder / "int64", WholeValues::kInt64);
  write_nvdb_memory(folder / "memory");
  write_nvdb_empty(folder / "empty");
}

/// Formats with a value for each voxel, each way to store them once.
void write_dense_seeds(const fs::path& folder) {
  write_text(folder / "vti", vti_file({.cells = true}));
  write_text(folder / "vti_text", vti_file({.format = "ascii"}));
  write_text(folder / "vti_packed", vti_file({.format = "binary", .packed = true, .wide = true}));
  write_text(folder / "vti_base64", vti_file({.base64 = true, .big_endian = true}));
  write_text(folder / "vtk", legacy_vtk_file(false, true));
  write_text(folder / "vtk_text", legacy_vtk_file(true, false));
  write_text(folder / "nrrd", nrrd_file("raw"));
  write_text(folder / "nrrd_packed", nrrd_file("gzip"));
  write_text(folder / "nrrd_text", nrrd_file("ascii"));
  write_text(folder / "mha", metaimage_file(false));
  write_text(folder / "mha_packed", metaimage_file(true));
  write_text(folder / "nii", nifti_file(1, true));
  write_text(folder / "nii2", nifti_file(2, false, true));
}

/// The classic formats, and NetCDF-4 in HDF5.
void write_netcdf_seeds(const fs::path& folder) {
  const std::vector<CloudVariable> variables = cloud();
  write_netcdf(folder / "classic", variables, 0);
  write_netcdf(folder / "offset", variables, NC_64BIT_OFFSET);
  write_netcdf(folder / "data", variables, NC_64BIT_DATA);
  write_netcdf(folder / "netcdf4", variables, NC_NETCDF4);
  std::vector<CloudVariable> packed = variables;
  for (CloudVariable& variable : packed) {
    if (variable.dimensions.size() == 4) variable.type = NC_SHORT;
    variable.numbers = {{"scale_factor", 1}, {"_FillValue", 0}};
  }
  write_netcdf(folder / "packed", packed, 0);
}

/// An input for each of the files in a folder, without a change, and one whose change has no bytes,
/// for the fuzzer to see how changes are written.
void write_changes(const fs::path& bases, const fs::path& folder) {
  for (char base = 0; base < std::distance(fs::directory_iterator(bases), {}); ++base) {
    const std::string name(1, static_cast<char>('a' + base));
    write_text(folder / name, std::string(1, base));
    write_text(folder / (name + "_changed"), std::string(1, base) + std::string("\x40\0\0", 3));
  }
}

std::string packed(const std::string& bytes) {
  const fs::path path = fs::temp_directory_path() / "freepath_seed.gz";
  const gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
  gzclose(file);
  const Bytes read = read_bytes(path);
  fs::remove(path);
  return {read.begin(), read.end()};
}

void write_ply_seeds(const fs::path& folder) {
  const std::string body =
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string text = "ply\nformat ascii 1.0\ncomment seed\n" + body +
                           "0 0 0 1\n1 0 0 2\n1 1 0 3\n0 1 0.5 4\n3 0 1 2\n4 0 1 2 3\n";
  write_text(folder / "ascii", text);
  write_text(folder / "packed", packed(text));
  write_text(folder / "normals",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
             "property double z\nproperty float nx\nproperty float ny\nproperty float nz\n"
             "property float u\nproperty float v\nelement edge 1\nproperty list uint short way\n"
             "element face 1\nproperty list uint8 uint32 vertex_index\nend_header\n"
             "0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n1 1 0 0 0 1 1 1\n2 7 8\n3 0 1 2\n");
  for (const bool little : {true, false}) {
    std::string bytes =
        "ply\nformat binary_" + std::string(little ? "little" : "big") + "_endian 1.0\n" + body;
    const auto add = [&](auto value) {
      std::array<char, sizeof(value)> stored{};
      std::memcpy(stored.data(), &value, sizeof(value));
      if (!little) std::reverse(stored.begin(), stored.end());
      bytes.append(stored.data(), stored.size());
    };
    for (int i = 0; i < 4; ++i) {
      for (int axis = 0; axis < 3; ++axis) add(static_cast<float>(i >> axis & 1));
      add(uint8_t{9});
    }
    for (const int corners : {3, 4}) {
      add(static_cast<uint8_t>(corners));
      for (int i = 0; i < corners; ++i) add(int32_t{i});
    }
    write_text(folder / (little ? "little" : "big"), bytes);
  }
}

/// Radiance's format: pixels of three bytes and an exponent, the second kind in runs.
void write_hdr_seeds(const fs::path& folder) {
  const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1\n\n";
  std::string flat = head + "-Y 2 +X 3\n";
  for (int i = 0; i < 6; ++i) flat += std::string{char(40 * i), char(99), char(7), char(128 + i)};
  write_text(folder / "flat.hdr", flat);
  std::string runs = head + "-Y 1 +X 9\n" + std::string("\x02\x02\0\x09", 4);
  for (int channel = 0; channel < 4; ++channel) {
    runs += std::string("\x86\x50", 2) + std::string("\x03\x01\x02\x80", 4);
  }
  write_text(folder / "runs.hdr", runs);
}

void write_image_seeds(const fs::path& folder) {
  Image image{5, 4, {"R", "G", "B", "A"}};
  for (int i = 0; i < 80; ++i) image.values.push_back(0.1F * static_cast<float>(i % 13));
  image.metadata = {{"note", std::string("seed")}, {"number", int64_t{7}}};
  write_exr(folder / "float.exr", image);
  write_exr(folder / "half.exr", image, {.precision = ExrPrecision::kHalf});
  write_png(folder / "picture.png", image);
  write_plain_image(folder / "picture.pfm", image);
  write_plain_image(folder / "picture.qoi", image);
  write_hdr_seeds(folder);
}

void write_seeds(const fs::path& folder) {
  for (const char* kind : {"vdb", "vdb_bases", "nvdb", "nvdb_bases", "dense", "dense_bases",
                           "netcdf", "netcdf_bases", "ply", "image"}) {
    fs::remove_all(folder / kind);
    fs::create_directories(folder / kind);
  }
  write_vdb_seeds(folder / "vdb_bases");
  write_changes(folder / "vdb_bases", folder / "vdb");
  write_nvdb_seeds(folder / "nvdb_bases");
  write_changes(folder / "nvdb_bases", folder / "nvdb");
  write_dense_seeds(folder / "dense_bases");
  write_changes(folder / "dense_bases", folder / "dense");
  write_netcdf_seeds(folder / "netcdf_bases");
  write_changes(folder / "netcdf_bases", folder / "netcdf");
  write_ply_seeds(folder / "ply");
  write_image_seeds(folder / "image");
}

}  // namespace
}  // namespace freepath

int main(int argc, char** argv) {
  try {
    if (argc == 2) freepath::write_seeds(argv[1]);
    return argc == 2 ? 0 : 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "write_seeds: %s\n", error.what());
    return 1;
  }
}
