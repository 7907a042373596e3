#include "tests/io/dense_files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "freepath/base/error.h"
#include "tests/gzip.h"

namespace freepath::testing_volumes {
namespace {

constexpr double kTurn = 0.3;  // [rad]

/// Bytes of one number.
template <class T>
std::string number_bytes(T value, std::endian order) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// The data of an array with the head that VTK puts before them.
std::string vti_data(const VtiStorage& storage, const std::string& bytes, bool encode) {
  const std::endian order = storage.big_endian ? std::endian::big : std::endian::little;
  const auto word = [&](std::size_t value) {
    return storage.wide ? number_bytes(static_cast<uint64_t>(value), order)
                        : number_bytes(static_cast<uint32_t>(value), order);
  };
  if (!storage.packed) {
    const std::string all = word(bytes.size()) + bytes;
    return encode ? base64(all) : all;
  }
  constexpr std::size_t kBlock = 1000;
  const std::size_t blocks = (bytes.size() + kBlock - 1) / kBlock;
  std::string head = word(blocks) + word(kBlock) + word(bytes.size() % kBlock), body;
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::string packed = zlib_packed(bytes.substr(i * kBlock, kBlock));
    head += word(packed.size());
    body += packed;
  }
  return encode ? base64(head) + base64(body) : head + body;
}

}  // namespace

SampleGrid sample_positions(double shift, bool turned) {
  SampleGrid grid;
  const double c = turned ? std::cos(kTurn) : 1, s = turned ? std::sin(kTurn) : 0;
  const Vec3d edges[] = {Vec3d(c, s, 0) * 0.5, Vec3d(-s, c, 0) * 0.25, Vec3d(0, 0, 2)};
  Vec3d position(1, 2, 3);
  for (int axis = 0; axis < 3; ++axis) {
    position += edges[axis] * shift;
    for (int k = 0; k < 3; ++k) grid.index_to_world[axis][k] = edges[axis][k];
  }
  for (int k = 0; k < 3; ++k) grid.index_to_world[3][k] = position[k];
  return grid;
}

double affine_density(const Vec3d& p) { return 50 + 2 * p.x + 3 * p.y + 5 * p.z; }

std::vector<double> affine_values(const SampleGrid& grid) {
  std::vector<double> values;
  for (int z = 0; z < grid.counts.z; ++z) {
    for (int y = 0; y < grid.counts.y; ++y) {
      for (int x = 0; x < grid.counts.x; ++x) {
        values.push_back(affine_density(Vec3d(x, y, z) * grid.index_to_world));
      }
    }
  }
  return values;
}

template <class T>
std::string stored(const std::vector<double>& values, std::endian order) {
  std::string bytes;
  for (const double value : values) bytes += number_bytes(static_cast<T>(value), order);
  return bytes;
}
template std::string stored<float>(const std::vector<double>&, std::endian);
template std::string stored<double>(const std::vector<double>&, std::endian);
template std::string stored<int16_t>(const std::vector<double>&, std::endian);
template std::string stored<uint8_t>(const std::vector<double>&, std::endian);

std::string as_text(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}\n", value);
  return text;
}

std::string base64(const std::string& bytes) {
  constexpr const char* kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8U | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0U);
    }
    const std::size_t present = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= present ? kLetters[bits >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

std::string zlib_packed(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  packed.resize(size);
  return packed;
}

std::string row_text(const Matrix4d& matrix, int row, const char* between) {
  return fmt::format("{}{}{}{}{}", matrix[row][0], between, matrix[row][1], between,
                     matrix[row][2]);
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream stream(path, std::ios::binary);
  stream << text;
  if (!stream.flush()) throw Error("can't write " + path.string());
}

void expect_affine(const LoadedField& loaded, const SampleGrid& grid, double tolerance) {
  const Field& field = loaded.field;
  const Matrix4d world_to_index = field.index_to_world.inverse();
  // Samples, and places between them, of which the largest are at the outermost samples.
  for (double x = 0; x <= grid.counts.x - 1; x += 0.75) {
    for (double y = 0; y <= grid.counts.y - 1; y += 1) {
      for (double z = 0; z <= grid.counts.z - 1; z += 1.25) {
        const Vec3d position = Vec3d(x, y, z) * grid.index_to_world;
        const double expected = affine_density(position);
        ASSERT_NEAR(field.voxels.interpolate(position * world_to_index), expected,
                    tolerance * expected)
            << position;
      }
    }
  }
  EXPECT_EQ(field.voxels.active_max() - field.voxels.active_min() + Vec3i(1), grid.counts);
}

std::string load_message(const std::filesystem::path& path) {
  try {
    load_field(path);
    return {};
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).rfind(path.string(), 0), 0U) << error.what();
    return error.what();
  }
}

SampleGrid vti_samples(const VtiStorage& storage) {
  return sample_positions(storage.cells ? 0.5 : 0);
}

std::string vti_file(const VtiStorage& storage) {
  const SampleGrid grid = vti_samples(storage);
  const std::vector<double> values = affine_values(grid);
  const std::endian order = storage.big_endian ? std::endian::big : std::endian::little;
  const std::string bytes =
      storage.doubles ? stored<double>(values, order) : stored<float>(values, order);
  // The first node is number 4 along x, so that the origin lies four steps before it.
  constexpr int kFirst = 4;
  const Vec3i last = grid.counts - Vec3i(storage.cells ? 0 : 1);
  const std::string extent =
      fmt::format("{} {} 0 {} 0 {}", kFirst, kFirst + last.x, last.y, last.z);
  const Matrix4d nodes = sample_positions().index_to_world;
  const Vec3d origin = Vec3d(-kFirst, 0, 0) * nodes;
  const double c = std::cos(kTurn), s = std::sin(kTurn);
  const std::string group = storage.cells ? "CellData" : "PointData";
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"{}\" "
      "header_type=\"{}\"{}>\n<ImageData WholeExtent=\"{}\" Origin=\"{} {} {}\" "
      "Spacing=\"0.5 0.25 2\" Direction=\"{} {} 0 {} {} 0 0 0 1\">\n<Piece Extent=\"{}\">\n<{}>\n",
      storage.big_endian ? "BigEndian" : "LittleEndian", storage.wide ? "UInt64" : "UInt32",
      storage.packed ? " compressor=\"vtkZLibDataCompressor\"" : "", extent, origin.x, origin.y,
      origin.z, c, -s, s, c, extent, group);
  text += fmt::format("<DataArray type=\"{}\" Name=\"density\" format=\"{}\"",
                      storage.doubles ? "Float64" : "Float32", storage.format);
  const std::string end = fmt::format("</{}>\n</Piece>\n</ImageData>\n", group);
  if (storage.format == "appended") {
    // Something stands before it.
    text += fmt::format(" offset=\"4\"/>\n{}<AppendedData encoding=\"{}\">\n _", end,
                        storage.base64 ? "base64" : "raw");
    return text + "AAAA" + vti_data(storage, bytes, storage.base64) +
           "\n</AppendedData>\n</VTKFile>\n";
  }
  text += ">\n";
  text += storage.format == "ascii" ? as_text(values) : vti_data(storage, bytes, true);
  return text + "\n</DataArray>\n" + end + "</VTKFile>\n";
}

SampleGrid legacy_vtk_samples(bool cells) { return sample_positions(cells ? 0.5 : 0, false); }

std::string legacy_vtk_file(bool text, bool cells) {
  const SampleGrid grid = legacy_vtk_samples(cells);
  const std::vector<double> values = affine_values(grid);
  const Vec3i nodes = grid.counts + Vec3i(cells ? 1 : 0);
  const std::string numbers = text ? as_text(values) : stored<double>(values, std::endian::big);
  const std::string time =
      text ? "7\n" : number_bytes(double{7}, std::endian::big) + std::string("\n");
  return fmt::format(
             "# vtk DataFile Version 4.2\na title\n{}\nDATASET STRUCTURED_POINTS\n"
             "FIELD FieldData 1\nTIME 1 1 double\n",
             text ? "ASCII" : "BINARY") +
         time +
         fmt::format(
             "DIMENSIONS {} {} {}\nSPACING 0.5 0.25 2\nORIGIN 1 2 3\n{} {}\n"
             "SCALARS density double\nLOOKUP_TABLE default\n",
             nodes.x, nodes.y, nodes.z, cells ? "CELL_DATA" : "POINT_DATA", values.size()) +
         numbers + "\nMETADATA\nINFORMATION 0\n\nFIELD FieldData 1\nagain 1 " +
         std::to_string(values.size()) + " double\n" + numbers + "\n";
}

std::string nrrd_file(const std::string& encoding, bool big_endian) {
  const SampleGrid grid = sample_positions();
  const std::vector<double> values = affine_values(grid);
  const Matrix4d& m = grid.index_to_world;
  std::string text = fmt::format(
      "NRRD0005\n# a comment\ntype: double\ndimension: 3\nspace dimension: 3\nsizes: {} {} {}\n"
      "space directions: ({}) ({}) ({})\nspace origin: ({})\nspace units: \"mm\" \"mm\" \"mm\"\n"
      "endian: {}\nencoding: {}\nkey:=value\n\n",
      grid.counts.x, grid.counts.y, grid.counts.z, row_text(m, 0, ","), row_text(m, 1, ","),
      row_text(m, 2, ","), row_text(m, 3, ","), big_endian ? "big" : "little", encoding);
  const std::string bytes =
      stored<double>(values, big_endian ? std::endian::big : std::endian::little);
  if (encoding == "ascii") return text + as_text(values);
  return text + (encoding == "raw" ? bytes : testing::gzip(bytes));
}

std::string metaimage_file(bool packed, bool big_endian) {
  const SampleGrid grid = sample_positions();
  const double c = std::cos(kTurn), s = std::sin(kTurn);
  const std::string bytes =
      stored<float>(affine_values(grid), big_endian ? std::endian::big : std::endian::little);
  return fmt::format(
             "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = {}\n"
             "CompressedData = {}\nTransformMatrix = {} {} 0 {} {} 0 0 0 1\nOffset = 1 2 3\n"
             "ElementSpacing = 0.5 0.25 2\nDimSize = {} {} {}\nElementType = MET_FLOAT\n"
             "ElementDataFile = LOCAL\n",
             big_endian ? "True" : "False", packed ? "True" : "False", c, s, -s, c, grid.counts.x,
             grid.counts.y, grid.counts.z) +
         (packed ? zlib_packed(bytes) : bytes);
}

std::string nifti_file(int version, bool quaternion, bool big_endian) {
  const std::endian order = big_endian ? std::endian::big : std::endian::little;
  const SampleGrid grid = sample_positions();
  const bool second = version == 2;
  std::string header(second ? 544 : 352, '\0');
  const auto put = [&](std::size_t offset, const std::string& bytes) {
    header.replace(offset, bytes.size(), bytes);
  };
  const auto put_real = [&](std::size_t first_offset, std::size_t second_offset, std::size_t i,
                            double value) {
    if (second) {
      put(second_offset + 8 * i, number_bytes(value, order));
    } else {
      put(first_offset + 4 * i, number_bytes(static_cast<float>(value), order));
    }
  };
  const auto put_code = [&](std::size_t first_offset, std::size_t second_offset, int code) {
    if (second) {
      put(second_offset, number_bytes(static_cast<int32_t>(code), order));
    } else {
      put(first_offset, number_bytes(static_cast<int16_t>(code), order));
    }
  };
  put(0, number_bytes(static_cast<int32_t>(second ? 540 : 348), order));
  put(second ? 4 : 344, second ? std::string("n+2\0\r\n\x1a\n", 8) : std::string("n+1\0", 4));
  const int sizes[] = {3, grid.counts.x, grid.counts.y, grid.counts.z, 1, 1, 1, 1};
  for (std::size_t i = 0; i < 8; ++i) {
    if (second) {
      put(16 + 8 * i, number_bytes(static_cast<int64_t>(sizes[i]), order));
    } else {
      put(40 + 2 * i, number_bytes(static_cast<int16_t>(sizes[i]), order));
    }
  }
  put(second ? 12 : 70, number_bytes(int16_t{16}, order));
  put(second ? 14 : 72, number_bytes(int16_t{32}, order));
  const double steps[] = {1, 0.5, 0.25, 2};
  for (std::size_t i = 0; i < 4; ++i) put_real(76, 104, i, steps[i]);
  if (second) {
    put(168, number_bytes(int64_t{544}, order));
    put(500, number_bytes(int32_t{2}, order));
  } else {
    put(108, number_bytes(352.0F, order));
    header[123] = 2;
  }
  put_real(112, 176, 0, 2);    // scl_slope
  put_real(116, 184, 0, 0.5);  // scl_inter
  const Matrix4d& m = grid.index_to_world;
  if (quaternion) {
    put_code(252, 344, 1);
    put_real(256, 352, 2, std::sin(kTurn / 2));  // about z
    for (std::size_t i = 0; i < 3; ++i) put_real(268, 376, i, m[3][static_cast<int>(i)]);
  } else {
    put_code(254, 348, 1);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 4; ++i) {
        put_real(280, 400, 4 * k + i, m[static_cast<int>(i)][static_cast<int>(k)]);
      }
    }
  }
  std::vector<double> values = affine_values(grid);
  for (double& value : values) value = (value - 0.5) / 2;
  return header + stored<float>(values, order);
}

}  // namespace freepath::testing_volumes
