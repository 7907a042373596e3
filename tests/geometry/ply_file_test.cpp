#include "freepath/geometry/ply_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "freepath/base/error.h"
#include "tests/gzip.h"

namespace freepath::testing {

namespace {

const char* const kHeader =
    "comment made by hand\n"
    "element vertex 5\n"
    "property float x\nproperty double y\nproperty float z\n"
    "property uchar red\n"
    "property float nx\nproperty float ny\nproperty float nz\n"
    "property float s\nproperty float t\n"
    "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
    "element face 2\n"
    "property list uchar int vertex_indices\nproperty short flags\n"
    "property list ushort double extra\n"
    "end_header\n";

/// Writes numbers in any of the formats.
class Writer {
 public:
  explicit Writer(const std::string& format, const std::string& header = kHeader)
      : format_(format), text_("ply\nformat " + format + " 1.0\n" + header) {}
  template <class T>
  void add(T value) {
    if (format_ == "ascii") {
      text_ += std::to_string(value) + (++words_ % 4 == 0 ? "\n" : " ");
      return;
    }
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    const bool is_little = format_ == "binary_little_endian";
    if (is_little != (std::endian::native == std::endian::little)) {
      std::reverse(bytes.begin(), bytes.end());
    }
    text_.append(bytes.data(), bytes.size());
  }
  const std::string& text() const { return text_; }

 private:
  std::string format_;
  std::string text_;
  int words_ = 0;
};

std::string sample_file(const std::string& format) {
  Writer writer(format);
  for (int i = 0; i < 5; ++i) {
    writer.add(0.5F + static_cast<float>(i));
    writer.add(-2.25 * i);
    writer.add(1e-3F);
    writer.add(static_cast<uint8_t>(200));
    writer.add(0.0F);
    writer.add(0.0F);
    writer.add(1.0F);
    writer.add(0.25F * static_cast<float>(i));
    writer.add(0.75F);
  }
  writer.add(int32_t{0});
  writer.add(int32_t{1});
  const auto end_face = [&] {
    writer.add(int16_t{-3});
    writer.add(uint16_t{2});
    writer.add(1.5);
    writer.add(2.5);
  };
  writer.add(uint8_t{3});
  for (const int32_t index : {0, 1, 2}) writer.add(index);
  end_face();
  writer.add(uint8_t{4});
  for (const int32_t index : {1, 2, 3, 4}) writer.add(index);
  end_face();
  return writer.text();
}

class PlyFile : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Formats, PlyFile,
                         ::testing::Values("ascii", "binary_little_endian", "binary_big_endian"));

void expect_sample(const PlyMesh& mesh) {
  ASSERT_EQ(mesh.positions.size(), 5U);
  ASSERT_EQ(mesh.normals.size(), 5U);
  ASSERT_EQ(mesh.uvs.size(), 5U);
  for (int i = 0; i < 5; ++i) {
    EXPECT_DOUBLE_EQ(mesh.positions[i].x, 0.5 + i);
    EXPECT_DOUBLE_EQ(mesh.positions[i].y, -2.25 * i);
    EXPECT_FLOAT_EQ(static_cast<float>(mesh.positions[i].z), 1e-3F);
    EXPECT_EQ(mesh.normals[i], Vec3f(0, 0, 1));
    EXPECT_EQ(mesh.uvs[i], Vec2f(0.25F * static_cast<float>(i), 0.75F));
  }
  EXPECT_EQ(mesh.triangles, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(mesh.quads, (std::vector<int>{1, 2, 4, 3}));
  const std::vector<ShapeGeometry> shapes = mesh.shapes();
  ASSERT_EQ(shapes.size(), 2U);
  EXPECT_EQ(std::get<TriangleMesh>(shapes[0]).indices, mesh.triangles);
  EXPECT_EQ(std::get<BilinearMesh>(shapes[1]).indices, mesh.quads);
}

TEST_P(PlyFile, IsReadInEveryFormat) { expect_sample(parse_ply(sample_file(GetParam()), "a.ply")); }

TEST_P(PlyFile, IsReadFromAFile) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / (std::string("freepath_") + GetParam() + ".ply");
  std::ofstream(path, std::ios::binary) << sample_file(GetParam());
  expect_sample(read_ply(path.string()));
  std::filesystem::remove(path);
}

// As exporters of large scenes write them, "mesh.ply.gz"; one member or several.
TEST_P(PlyFile, IsReadPackedByGzip) {
  const std::string whole = sample_file(GetParam());
  expect_sample(parse_ply(gzip(whole), "a.ply.gz"));
  expect_sample(parse_ply(gzip(whole.substr(0, 300)) + gzip(whole.substr(300)), "a.ply"));
  const std::string packed = gzip(whole);
  for (std::size_t size = 2; size < packed.size(); ++size) {
    EXPECT_THROW(parse_ply(packed.substr(0, size), "a.ply.gz"), Error) << size << " bytes";
  }
}

/// A grid of so many vertices at each edge, which takes many blocks of unpacking.
std::string grid_file(const std::string& format, int edge) {
  Writer writer(format, fmt::format("element vertex {}\nproperty float x\nproperty float y\n"
                                    "property float z\nelement face {}\n"
                                    "property list uchar int vertex_indices\nend_header\n",
                                    edge * edge, (edge - 1) * (edge - 1)));
  for (int i = 0; i < edge * edge; ++i) {
    writer.add(0.1F * static_cast<float>(i % edge));
    writer.add(0.1F * static_cast<float>(i / edge));
    writer.add(std::sin(0.37F * static_cast<float>(i)));
  }
  for (int row = 0; row + 1 < edge; ++row) {
    for (int column = 0; column + 1 < edge; ++column) {
      const int first = row * edge + column;
      writer.add(uint8_t{4});
      for (const int index : {first, first + 1, first + edge + 1, first + edge}) writer.add(index);
    }
  }
  return writer.text();
}

TEST_P(PlyFile, PackedIsTheSameAsUnpacked) {
  const std::string whole = grid_file(GetParam(), 120);
  EXPECT_GT(whole.size(), 300000U);
  const PlyMesh expected = parse_ply(whole, "a.ply");
  const PlyMesh found = parse_ply(gzip(whole), "a.ply.gz");
  EXPECT_EQ(found.positions, expected.positions);
  EXPECT_EQ(found.quads, expected.quads);
}

TEST_P(PlyFile, ThatIsCutOffIsRefusedAnywhere) {
  const std::string whole = sample_file(GetParam());
  // The last word of a text may lose digits, and nobody sees it.
  for (std::size_t size = 0; size + 12 < whole.size(); size += 7) {
    EXPECT_THROW(parse_ply(whole.substr(0, size), "a.ply"), Error) << size << " bytes";
  }
}

std::string message_of(const std::string& content) {
  try {
    parse_ply(content, "a.ply");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(PlyFile, ErrorsSayWhatAndWhere) {
  const std::string vertices = "element vertex 3\nproperty float x\nproperty float y\n";
  const std::string rest =
      "property float z\nelement face 1\nproperty list uchar int "
      "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
  const std::string begin = "ply\nformat ascii 1.0\n";
  EXPECT_EQ(message_of(begin + vertices + rest + "3 0 1 2\n"), "no error");
  EXPECT_EQ(message_of(begin + vertices + rest + "3 0 1 3\n"),
            "a.ply: triangle 0 refers to vertex 3, but there are only vertices 0 to 2; write the "
            "file anew");
  EXPECT_NE(message_of(begin + vertices + rest + "3 0 -1 2\n").find("face 0 refers to vertex -1"),
            std::string::npos);
  EXPECT_NE(message_of(begin + vertices + rest + "5 0 1 2 1 0\n").find("face 0 has 5 corners"),
            std::string::npos);
  EXPECT_NE(message_of(begin + vertices + rest + "3 0 one 2\n").find("'one' in face 0"),
            std::string::npos);
  EXPECT_NE(message_of("solid cube").find("no PLY file"), std::string::npos);
  EXPECT_EQ(message_of("ply\nformat ascii 1.0\nelement vertex many\nend_header\n"),
            "a.ply:3: the count 'many' of 'vertex' is no number; write the file anew");
  EXPECT_NE(message_of("ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\n")
                .find("a.ply:4: the type 'quad' is unknown"),
            std::string::npos);
  EXPECT_NE(message_of("ply\nformat text 1.0\n").find("the format 'text'"), std::string::npos);
  EXPECT_NE(message_of(begin + "element vertex 99999999999\nproperty float x\nproperty float y\n"
                               "property float z\nend_header\n")
                .find("more than the file holds"),
            std::string::npos);
  EXPECT_THROW(read_ply("/nowhere/a.ply"), Error);
}

TEST(PlyErrors, PackedFilesCostNoMoreThanTheyDeclare) {
  const std::string header =
      "property float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string begin = "ply\nformat ascii 1.0\nelement vertex ";
  const std::string mesh = begin + "3\n" + header + "0 0 0  1 0 0  0 1 0  3 0 1 2\n";
  // What comes after the mesh is not unpacked: a fault in it is not noticed.
  std::string more = gzip(mesh + std::string(std::size_t{4} << 20, ' ') + "end");
  more[more.size() - 4] = static_cast<char>(more[more.size() - 4] + 1);
  more.resize(more.size() - 100);
  EXPECT_EQ(parse_ply(more, "a.ply.gz").triangles, (std::vector<int>{0, 1, 2}));
  // A count that no file of that size can hold, however well it is packed.
  const std::string many = gzip(begin + "1000000\n" + header + "0 0 0");
  EXPECT_LT(many.size(), 900U);
  EXPECT_NE(message_of(many).find("more than the file holds"), std::string::npos);
  EXPECT_NE(message_of(gzip("ply\n" + std::string(std::size_t{2} << 20, '\n')))
                .find("there is no 'end_header'"),
            std::string::npos);
}

}  // namespace

}  // namespace freepath::testing
