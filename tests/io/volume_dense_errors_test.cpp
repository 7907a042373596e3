// Wrong headers of formats with a value for each voxel: what is wrong, and where, is named.

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "tests/gzip.h"
#include "tests/io/dense_files.h"
#include "tests/io/volume_files.h"

namespace freepath {
namespace {

using namespace testing_volumes;  // NOLINT(google-build-using-namespace)

/// What stands in place of a text of a file, and what the message must hold.
struct Replacement {
  std::string from, to;
  std::vector<std::string> parts;
};

void expect_messages(const std::string& name, const std::string& bytes,
                     const std::vector<Replacement>& replacements) {
  const TemporaryFolder folder;
  for (const Replacement& r : replacements) {
    SCOPED_TRACE(r.from + " -> " + r.to);
    const std::size_t offset = bytes.find(r.from);
    ASSERT_NE(offset, std::string::npos);
    std::string changed = bytes;
    changed.replace(offset, r.from.size(), r.to);
    write_text(folder / name, changed);
    const std::string message = load_message(folder / name);
    for (const std::string& part : r.parts) {
      EXPECT_NE(message.find(part), std::string::npos) << "no " << part << " in: " << message;
    }
  }
}

TEST(DenseVolumeErrors, WrongAttributesOfVtiAreNamed) {
  expect_messages(
      "a.vti", vti_file({.format = "binary"}),
      {{"type=\"ImageData\"", "type=\"RectilinearGrid\"", {"RectilinearGrid", "ResampleToImage"}},
       {"LittleEndian", "MiddleEndian", {"byte_order", "MiddleEndian"}},
       {"UInt32", "UInt16", {"header_type", "UInt16"}},
       {"header_type=\"UInt32\"",
        "compressor=\"vtkLZ4DataCompressor\"",
        {"vtkLZ4DataCompressor", "vtkZLibDataCompressor"}},
       {"Spacing=\"0.5 0.25 2\"", "Spacing=\"0.5 0.25\"", {"Spacing", "2 numbers"}},
       {"Spacing=\"0.5 0.25 2\"", "Spacing=\"0.5 nan 2\"", {"Spacing", "nan", "finite"}},
       {"Spacing=\"0.5 0.25 2\"", "Spacing=\"0.5 0 2\"", {"not invertible"}},
       {"Direction=\"", "Direction=\"x ", {"Direction", "'x'"}},
       {"Piece Extent=\"4 13", "Piece Extent=\"4 14", {"WholeExtent"}},
       {"Piece Extent=\"4 13", "Piece Extent=\"4 3", {"Extent", "whole number"}},
       {"Piece Extent=\"4 13", "Piece Extent=\"4 12", {"bytes", "extents"}},
       {"Piece Extent", "Piece Extend", {"<Piece> has no Extent"}},
       {"<Piece", "<Part", {"XML"}},
       {"Float32", "Float16", {"Float16", "can be densities"}},
       {"Float32", "Float64", {"bytes"}},
       {"format=\"binary\"", "format=\"hex\"", {"hex"}},
       {"format=\"binary\"", R"(format="appended" offset="0")", {"appended data"}},
       {"Name=\"density\"", R"(Name="density" NumberOfComponents="2")", {"float x 2"}},
       {"</PointData>", "", {"XML"}}});
}

TEST(DenseVolumeErrors, WrongStatementsOfOldVtkAreNamed) {
  expect_messages(
      "a.vtk", legacy_vtk_file(true, false),
      {{"ASCII", "TEXT", {"TEXT", "BINARY"}},
       {"STRUCTURED_POINTS", "UNSTRUCTURED_GRID", {"UNSTRUCTURED_GRID", "ResampleToImage"}},
       {"DIMENSIONS 10", "DIMENSIONS -10", {"DIMENSIONS", "-10"}},
       {"DIMENSIONS 10", "DIMENSIONS 10.5", {"DIMENSIONS", "10.5"}},
       {"DIMENSIONS 10", "DIMENSIONS 12", {"POINT_DATA", "1188"}},
       {"DIMENSIONS 10", "DIMENSIONS 1e300", {"DIMENSIONS"}},
       {"DIMENSIONS", "DIMENSION", {"DIMENSION"}},
       {"SPACING 0.5", "SPACING inf", {"SPACING", "inf"}},
       {"ORIGIN 1", "ORIGIN one", {"ORIGIN", "one"}},
       {"SCALARS density double", "SCALARS density string", {"string"}},
       {"SCALARS density double", "SCALARS density double 0", {"0 numbers"}},
       {"LOOKUP_TABLE", "LOOKUP", {"LOOKUP_TABLE"}},
       {"SCALARS", "TENSORS", {"TENSORS"}},
       {"default\n", "default\nx", {"no number"}}});
}

TEST(DenseVolumeErrors, WrongFieldsOfNrrdAreNamed) {
  expect_messages("a.nrrd", nrrd_file("raw"),
                  {{"type: double", "type: block", {"block", "can be densities"}},
                   {"type: double", "kind: double", {"no field 'type'"}},
                   {"dimension: 3", "dimension: 2", {"2 dimensions"}},
                   {"sizes: 10", "sizes: 0", {"sizes", "0"}},
                   {"sizes: 10", "sizes: 1e9", {"sizes"}},
                   {"sizes: 10", "sizes: 16777216", {"bytes"}},
                   {"sizes: 10", "sizes: 11", {"declares 11 x 9 x 11 voxels"}},
                   {"sizes: 10 9 11", "sizes: 10 9", {"sizes", "2 numbers"}},
                   {"space origin: (", "space origin: (x,", {"'x'", "space origin"}},
                   {"space directions: (", "space directions: none (", {"4 vectors"}},
                   {"encoding: raw", "encoding: bzip2", {"bzip2"}},
                   {"encoding: raw", "encoding: gzip", {"gzip stream"}},
                   {"encoding: raw", "encoding: raw\nbyte skip: -2", {"byte skip", "-2"}},
                   {"encoding: raw", "encoding: raw\nencoding: raw", {"twice"}},
                   {"encoding: raw", "encoding: raw\ndata file: none.raw", {"none.raw"}},
                   {"encoding: raw", "encoding: raw\ndata file: LIST", {"several files"}},
                   {"endian: little", "endian: middle", {"middle"}},
                   {"endian: little", "note: none", {"no field 'endian'"}}});
}

TEST(DenseVolumeErrors, WrongFieldsOfMetaImageAreNamed) {
  expect_messages("a.mha", metaimage_file(false),
                  {{"NDims = 3", "NDims = 2", {"NDims", "2"}},
                   {"NDims = 3", "NDims = x", {"NDims", "'x'"}},
                   {"DimSize = 10 9 11", "DimSize = 10 9", {"DimSize", "2 numbers"}},
                   {"DimSize = 10", "DimSize = -1", {"DimSize", "-1"}},
                   {"DimSize = 10", "DimSize = 100", {"declares 100 x 9 x 11 voxels"}},
                   {"DimSize", "DimSizes", {"no field 'DimSize'"}},
                   {"MET_FLOAT", "MET_STRING", {"MET_STRING"}},
                   {"LOCAL", "LIST", {"several files"}},
                   {"LOCAL", "none.raw", {"none.raw"}},
                   {"ElementDataFile", "ElementData", {"is no field"}},
                   {"BinaryData = True", "BinaryData = yes", {"BinaryData", "yes"}},
                   {"CompressedData = False", "CompressedData = True", {"gzip stream"}},
                   {"CompressedData = False", "HeaderSize = -2", {"HeaderSize", "-2"}},
                   {"CompressedData = False", "ElementNumberOfChannels = 2", {"2 numbers"}},
                   {"ElementSpacing = 0.5", "ElementSpacing = nan", {"nan"}},
                   {"ElementSpacing = 0.5", "ElementSpacing = 0", {"not invertible"}}});
}

TEST(DenseVolumeErrors, WrongNumbersOfNiftiAreNamed) {
  const TemporaryFolder folder;
  const std::string good = nifti_file(1, true);
  struct Change {
    std::size_t offset;
    std::string bytes;
    std::string part;
  };
  const auto floats = [](float value) { return stored<float>({value}); };
  const auto shorts = [](double value) { return stored<int16_t>({value}); };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Change& change :
       std::vector<Change>{{40, shorts(2), "2 dimensions"},
                           {40, shorts(8), "8 dimensions"},
                           {42, shorts(0), "dim"},
                           {42, shorts(-5), "dim"},
                           {42, shorts(1000), "declares 1000 x 9 x 11 voxels"},
                           {50, shorts(3), ""},
                           {70, shorts(128), "code 128"},
                           {70, shorts(64), "bitpix"},
                           {72, shorts(16), "bitpix"},
                           {80, floats(nan), "pixdim"},
                           {80, floats(0), "not invertible"},
                           {108, floats(12), "vox_offset"},
                           {108, floats(nan), "vox_offset"},
                           {108, floats(1e9F), "ends at byte"},
                           {112, floats(nan), "scl_slope"},
                           {256, floats(3), "no rotation"},
                           {268, floats(nan), "qoffset"},
                           {344, "ni1", ".img"}}) {
    SCOPED_TRACE(change.offset);
    std::string bytes = good;
    bytes.replace(change.offset, change.bytes.size(), change.bytes);
    write_text(folder / "a.nii", bytes);
    const std::string message = load_message(folder / "a.nii");
    EXPECT_NE(message.find(change.part), std::string::npos) << message;
    EXPECT_EQ(message.empty(), change.part.empty()) << message;
  }
  write_text(folder / "a.gz", testing::gzip("something else that is packed, and longer than "
                                            "a header" +
                                            std::string(600, '.')));
  EXPECT_NE(load_message(folder / "a.gz").find("gunzip"), std::string::npos);
}

}  // namespace
}  // namespace freepath
