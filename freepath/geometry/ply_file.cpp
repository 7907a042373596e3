#include "freepath/geometry/ply_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "freepath/base/error.h"
#include "freepath/base/input_file.h"
#include "freepath/geometry/ply_bytes.h"
#include "freepath/geometry/ply_header.h"

namespace freepath {

namespace {

/// Takes numbers from the data, one after the other.
class Numbers {
 public:
  Numbers(PlyBytes& bytes, PlyFormat format, const std::string& name)
      : bytes_(bytes), format_(format), name_(name) {}

  /// @param element, number what is being read, for a message
  double next(PlyType type, const PlyElement& element, uint64_t number) {
    return format_ == PlyFormat::kAscii ? next_word(element, number)
                                        : next_bytes(type, element, number);
  }

 private:
  double next_word(const PlyElement& element, uint64_t number) {
    std::string_view rest = skip_blanks();
    if (rest.empty()) cut_off(element, number);
    if (rest.front() == '+') rest.remove_prefix(1);
    double value = 0;
    const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    const auto length = static_cast<std::size_t>(stop - rest.data());
    const bool ends = length == rest.size() || std::strchr(" \t\r\n", rest[length]) != nullptr;
    if (error != std::errc() || !ends) {
      const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r\n"));
      fail("{}: '{}' in {} {} is no number; write the file anew", name_, word, element.name,
           number);
    }
    bytes_.skip(static_cast<std::size_t>(stop - bytes_.ahead(0).data()));
    return value;
  }

  /// What comes next but blanks, with the whole of a number; nothing at the end.
  std::string_view skip_blanks() {
    constexpr std::size_t kLongestNumber = 4096;
    for (;;) {
      const std::string_view rest = bytes_.ahead(kLongestNumber);
      const std::size_t begin = std::min(rest.find_first_not_of(" \t\r\n"), rest.size());
      if (begin == 0) return rest;
      bytes_.skip(begin);
    }
  }

  double next_bytes(PlyType type, const PlyElement& element, uint64_t number) {
    const std::size_t size = size_of(type);
    const std::string_view rest = bytes_.ahead(size);
    if (rest.size() < size) cut_off(element, number);
    std::array<char, 8> bytes{};
    std::copy_n(rest.data(), size, bytes.data());
    bytes_.skip(size);
    const bool is_native =
        (format_ == PlyFormat::kLittleEndian) == (std::endian::native == std::endian::little);
    if (!is_native) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    switch (type) {
      case PlyType::kInt8:
        return as<int8_t>(bytes);
      case PlyType::kUint8:
        return as<uint8_t>(bytes);
      case PlyType::kInt16:
        return as<int16_t>(bytes);
      case PlyType::kUint16:
        return as<uint16_t>(bytes);
      case PlyType::kInt32:
        return as<int32_t>(bytes);
      case PlyType::kUint32:
        return as<uint32_t>(bytes);
      case PlyType::kFloat32:
        return as<float>(bytes);
      case PlyType::kFloat64:
        return as<double>(bytes);
    }
    return 0;
  }

  template <class T>
  static double as(const std::array<char, 8>& bytes) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return static_cast<double>(value);
  }

  [[noreturn]] void cut_off(const PlyElement& element, uint64_t number) const {
    fail("{}: the file ends within {} {} of {}; it was cut off, fetch or write it anew", name_,
         element.name, number, element.count);
  }

  PlyBytes& bytes_;
  PlyFormat format_;
  const std::string& name_;
};

/// Where the numbers of a vertex go: positions 0 to 2, normals 3 to 5, uvs 6 and 7; -1 is nowhere.
int slot_of(std::string_view property) {
  static constexpr std::array<std::string_view, 8> kNames = {"x",  "y",  "z", "nx",
                                                             "ny", "nz", "u", "v"};
  if (property == "s" || property == "texture_u" || property == "texture_s") return 6;
  if (property == "t" || property == "texture_v" || property == "texture_t") return 7;
  const auto* const found = std::find(kNames.begin(), kNames.end(), property);
  return found == kNames.end() ? -1 : static_cast<int>(found - kNames.begin());
}

class DataParser {
 public:
  DataParser(std::string_view content, const std::string& name)
      : name_(name),
        bytes_(content, name),
        header_(parse_ply_header(bytes_.ahead(kLongestHeader), name)),
        numbers_(bytes_, header_.format, name) {
    bytes_.skip(header_.size);
  }

  PlyMesh parse() {
    bool has_vertices = false;
    bool has_faces = false;
    for (const PlyElement& element : header_.elements) {
      // Each takes a byte at least; a count beyond would only ask for memory.
      if (!element.properties.empty() && element.count > bytes_.largest_size()) {
        fail("{}: {} of '{}' are more than the file holds; it was cut off, fetch or write it anew",
             name_, element.count, element.name);
      }
      if (element.name == "vertex") {
        has_vertices = true;
        parse_vertices(element);
      } else if (element.name == "face") {
        has_faces = true;
        parse_faces(element);
      } else {
        skip(element);
      }
    }
    bytes_.check_end();
    if (!has_vertices || !has_faces || mesh_.positions.empty() ||
        (mesh_.triangles.empty() && mesh_.quads.empty())) {
      fail("{}: there are no vertices or no faces; a mesh needs both", name_);
    }
    check_indices(mesh_.triangles, 3, "triangle");
    check_indices(mesh_.quads, 4, "quad");
    return std::move(mesh_);
  }

 private:
  void skip(const PlyElement& element) {
    if (element.properties.empty()) return;  // however many they are
    for (uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) skip(property, element, i);
    }
  }
  void skip(const PlyProperty& property, const PlyElement& element, uint64_t number) {
    const uint64_t count = property.is_list ? length_of(property, element, number) : 1;
    for (uint64_t i = 0; i < count; ++i) numbers_.next(property.type, element, number);
  }
  uint64_t length_of(const PlyProperty& list, const PlyElement& element, uint64_t number) {
    const double length = numbers_.next(list.count_type, element, number);
    if (!(length >= 0 && length <= 1e9 && length == std::floor(length))) {
      fail("{}: the list '{}' of {} {} has the length {}; write the file anew", name_, list.name,
           element.name, number, length);
    }
    return static_cast<uint64_t>(length);
  }

  void parse_vertices(const PlyElement& element) {
    std::array<bool, 8> has{};
    std::vector<int> slots;
    for (const PlyProperty& property : element.properties) {
      int slot = property.is_list ? -1 : slot_of(property.name);
      if (slot >= 0 && has[slot]) slot = -1;  // u and texture_u: the first
      if (slot >= 0) has[slot] = true;
      slots.push_back(slot);
    }
    if (!has[0] || !has[1] || !has[2]) {
      fail("{}: the vertices lack x, y or z; a mesh needs all three", name_);
    }
    const bool has_normals = has[3] && has[4] && has[5];
    const bool has_uvs = has[6] && has[7];
    for (uint64_t i = 0; i < element.count; ++i) {
      std::array<double, 8> values{};
      for (std::size_t k = 0; k < slots.size(); ++k) {
        if (slots[k] < 0) {
          skip(element.properties[k], element, i);
        } else {
          values[slots[k]] = numbers_.next(element.properties[k].type, element, i);
        }
      }
      mesh_.positions.emplace_back(values[0], values[1], values[2]);
      if (has_normals) mesh_.normals.emplace_back(Vec3d(values[3], values[4], values[5]));
      if (has_uvs) mesh_.uvs.emplace_back(Imath::V2d(values[6], values[7]));
    }
  }

  void parse_faces(const PlyElement& element) {
    const auto is_indices = [](const PlyProperty& property) {
      return property.is_list &&
             (property.name == "vertex_indices" || property.name == "vertex_index");
    };
    if (std::none_of(element.properties.begin(), element.properties.end(), is_indices)) {
      fail("{}: the faces have no list 'vertex_indices'; a mesh needs one", name_);
    }
    for (uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) {
        if (is_indices(property)) {
          parse_face(property, element, i);
        } else {
          skip(property, element, i);
        }
      }
    }
  }

  void parse_face(const PlyProperty& list, const PlyElement& element, uint64_t number) {
    const uint64_t corners = length_of(list, element, number);
    if (corners != 3 && corners != 4) {
      fail("{}: face {} has {} corners; split it into triangles", name_, number, corners);
    }
    std::array<int, 4> face{};
    for (uint64_t k = 0; k < corners; ++k) {
      const double index = numbers_.next(list.type, element, number);
      if (!(index >= 0 && index <= 0x7FFFFFFF && index == std::floor(index))) {
        fail("{}: face {} refers to vertex {}, which there cannot be; write the file anew", name_,
             number, index);
      }
      face[k] = static_cast<int>(index);
    }
    if (corners == 3) {
      mesh_.triangles.insert(mesh_.triangles.end(), face.begin(), face.begin() + 3);
    } else {
      mesh_.quads.insert(mesh_.quads.end(), {face[0], face[1], face[3], face[2]});
    }
  }

  void check_indices(const std::vector<int>& indices, std::size_t corners, const char* face) const {
    for (std::size_t i = 0; i < indices.size(); ++i) {
      if (static_cast<std::size_t>(indices[i]) < mesh_.positions.size()) continue;
      fail(
          "{}: {} {} refers to vertex {}, but there are only vertices 0 to {}; write the file anew",
          name_, face, i / corners, indices[i], mesh_.positions.size() - 1);
    }
  }

  /// Of a packed file.
  static constexpr std::size_t kLongestHeader = std::size_t{1} << 20;

  const std::string& name_;
  PlyBytes bytes_;
  PlyHeader header_;
  Numbers numbers_;
  PlyMesh mesh_;
};

}  // namespace

std::vector<ShapeGeometry> PlyMesh::shapes() const {
  std::vector<ShapeGeometry> made;
  if (!triangles.empty()) made.emplace_back(TriangleMesh{positions, normals, uvs, triangles});
  if (!quads.empty()) made.emplace_back(BilinearMesh{positions, normals, uvs, quads});
  return made;
}

PlyMesh parse_ply(std::string_view content, const std::string& name) {
  return DataParser(content, name).parse();
}

PlyMesh read_ply(const std::string& file) {
  return parse_ply(read_input_file(file, "a PLY file"), file);
}

}  // namespace freepath
