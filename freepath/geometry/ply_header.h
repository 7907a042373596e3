#pragma once
/// @file The header of a PLY file. Internal to this folder.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace freepath {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  ///< Type of the count that a list begins with.
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  std::size_t size = 0;  ///< Length of the header [bytes]; the data begin there.
  int lines = 0;
};

/// @throws Error with the line
PlyHeader parse_ply_header(std::string_view content, const std::string& name);

/// [bytes]
std::size_t size_of(PlyType type);

}  // namespace freepath
