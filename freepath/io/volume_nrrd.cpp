// Reads NRRD files (.nrrd), and those whose values stand in another file (.nhdr).

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/printable.h"
#include "freepath/io/volume_dense.h"
#include "freepath/io/volume_text.h"

namespace freepath::io {
namespace {

std::optional<NumberType> nrrd_number_type(const std::string& name) {
  static const std::map<std::string, NumberType> kTypes{
      {"signed char", NumberType::kInt8},
      {"int8", NumberType::kInt8},
      {"int8_t", NumberType::kInt8},
      {"uchar", NumberType::kUint8},
      {"unsigned char", NumberType::kUint8},
      {"uint8", NumberType::kUint8},
      {"uint8_t", NumberType::kUint8},
      {"short", NumberType::kInt16},
      {"short int", NumberType::kInt16},
      {"signed short", NumberType::kInt16},
      {"signed short int", NumberType::kInt16},
      {"int16", NumberType::kInt16},
      {"int16_t", NumberType::kInt16},
      {"ushort", NumberType::kUint16},
      {"unsigned short", NumberType::kUint16},
      {"unsigned short int", NumberType::kUint16},
      {"uint16", NumberType::kUint16},
      {"uint16_t", NumberType::kUint16},
      {"int", NumberType::kInt32},
      {"signed int", NumberType::kInt32},
      {"int32", NumberType::kInt32},
      {"int32_t", NumberType::kInt32},
      {"uint", NumberType::kUint32},
      {"unsigned int", NumberType::kUint32},
      {"uint32", NumberType::kUint32},
      {"uint32_t", NumberType::kUint32},
      {"longlong", NumberType::kInt64},
      {"long long", NumberType::kInt64},
      {"long long int", NumberType::kInt64},
      {"signed long long", NumberType::kInt64},
      {"signed long long int", NumberType::kInt64},
      {"int64", NumberType::kInt64},
      {"int64_t", NumberType::kInt64},
      {"ulonglong", NumberType::kUint64},
      {"unsigned long long", NumberType::kUint64},
      {"unsigned long long int", NumberType::kUint64},
      {"uint64", NumberType::kUint64},
      {"uint64_t", NumberType::kUint64},
      {"float", NumberType::kFloat},
      {"double", NumberType::kDouble}};
  const auto found = kTypes.find(name);
  if (found == kTypes.end()) return std::nullopt;
  return found->second;
}

/// The fields of a header, by their names in lower case.
class NrrdHeader : public HeaderFields {
 public:
  explicit NrrdHeader(const VolumeFile& file) : HeaderFields(file) {
    TextCursor cursor(file, 0);
    cursor.line();  // the magic
    while (!cursor.at_end()) {
      const std::string line = cursor.line();
      if (line.empty()) break;
      if (line.starts_with('#') || line.find(":=") != line.npos) continue;
      const std::size_t colon = line.find(": ");
      if (colon == line.npos) {
        file.fail_damaged(fmt::format("'{}' is no field of a header", excerpt(line)));
      }
      const std::string name = lower_case(trimmed(std::string_view(line).substr(0, colon)));
      const std::string value(trimmed(std::string_view(line).substr(colon + 2)));
      if (!fields_.emplace(name, value).second) {
        fail("{}: its header has the field '{}' twice; leave one out", file.name(), excerpt(name));
      }
    }
    end_ = cursor.offset();
  }

  /// A whole number, 0 where it isn't given.
  double whole(std::initializer_list<const char*> names, double least) const {
    const auto text = find(names);
    if (!text) return 0;
    const double value = header_numbers(file_, *names.begin(), *text, 1)[0];
    constexpr double kMost = 1e15;
    if (!(value >= least && value <= kMost) || value != std::floor(value)) {
      fail("{}: {} of '{}' in its header is out of range; correct it", file_.name(), value,
           *names.begin());
    }
    return value;
  }
};

/// The axes of space, behind one of colours if there is one.
struct NrrdAxes {
  std::size_t first = 0;  ///< The axis x.
  int components = 1;
  Vec3i counts{1};
};

NrrdAxes nrrd_axes(const NrrdHeader& header) {
  const VolumeFile& file = header.file();
  const double dimension = header_numbers(file, "dimension", header.get({"dimension"}), 1)[0];
  if (dimension != 3 && dimension != 4) {
    fail(
        "{}: it has {} dimensions; 3 can be read, or 4 of which the first holds 1 or 3 numbers "
        "of a voxel",
        file.name(), dimension);
  }
  NrrdAxes axes;
  axes.first = dimension == 4 ? 1 : 0;
  const auto sizes =
      header_numbers(file, "sizes", header.get({"sizes"}), static_cast<std::size_t>(dimension));
  axes.counts = checked_counts(file, "sizes with", std::span(sizes).subspan(axes.first));
  if (axes.first == 0) return axes;
  if (sizes[0] != 1 && sizes[0] != 3) {
    fail("{}: its first dimension has {} numbers; 1 or 3 can be the densities of a voxel",
         file.name(), sizes[0]);
  }
  axes.components = static_cast<int>(sizes[0]);
  return axes;
}

/// "(1,2,3)" as a vector.
Vec3d nrrd_vector(const VolumeFile& file, std::string_view what, std::string_view text) {
  text = trimmed(text);
  if (!text.starts_with('(') || !text.ends_with(')')) {
    fail("{}: '{}' of {} in its header is no vector of three numbers, (x,y,z); correct it",
         file.name(), excerpt(text), what);
  }
  const auto numbers = header_numbers(file, what, text.substr(1, text.size() - 2), 3);
  return {numbers[0], numbers[1], numbers[2]};
}

/// Vectors of a field, one for each axis; those of other axes are "none".
std::vector<std::string> nrrd_vectors(std::string_view text) {
  std::vector<std::string> vectors;
  while (!(text = trimmed(text)).empty()) {
    const std::size_t end = text.starts_with('(') ? text.find(')') : text.find_first_of(" \t");
    const std::size_t size = end == text.npos ? text.size() : end + (text[0] == '(' ? 1 : 0);
    vectors.emplace_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  return vectors;
}

/// Places of samples by vectors in space.
Matrix4d nrrd_space(const NrrdHeader& header, const NrrdAxes& axes, const std::string& text) {
  const VolumeFile& file = header.file();
  const std::vector<std::string> vectors = nrrd_vectors(text);
  if (vectors.size() != axes.first + 3) {
    fail("{}: 'space directions' in its header has {} vectors, where {} belong; correct it",
         file.name(), vectors.size(), axes.first + 3);
  }
  Matrix4d matrix;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Vec3d edge = nrrd_vector(file, "'space directions'", vectors[axes.first + axis]);
    for (int k = 0; k < 3; ++k) matrix[static_cast<int>(axis)][k] = edge[k];
  }
  if (const auto origin = header.find({"space origin"})) {
    const Vec3d position = nrrd_vector(file, "'space origin'", *origin);
    for (int k = 0; k < 3; ++k) matrix[3][k] = position[k];
  }
  return matrix;
}

/// A number for each axis of space, of a field that has some for all axes; an axis that isn't of
/// space may have NaN.
std::optional<Vec3d> nrrd_numbers(const NrrdHeader& header, const NrrdAxes& axes,
                                  std::initializer_list<const char*> names) {
  const auto text = header.find(names);
  if (!text) return std::nullopt;
  std::vector<std::string> words = split_words(*text);
  if (words.size() > axes.first) words.erase(words.begin(), words.begin() + axes.first);
  std::string joined;
  for (const std::string& word : words) joined += word + " ";
  const auto numbers = header_numbers(header.file(), *names.begin(), joined, 3);
  return Vec3d(numbers[0], numbers[1], numbers[2]);
}

/// Places of samples by steps, and by where the axes begin and end: at the outermost samples if
/// they are centred on nodes, half a step beyond if in cells.
Matrix4d nrrd_steps(const NrrdHeader& header, const NrrdAxes& axes) {
  const auto spacings = nrrd_numbers(header, axes, {"spacings"});
  const auto low = nrrd_numbers(header, axes, {"axis mins", "axismins"});
  const auto high = nrrd_numbers(header, axes, {"axis maxs", "axismaxs"});
  std::vector<std::string> centers =
      split_words(lower_case(header.find({"centers", "centerings"}).value_or("")));
  centers.resize(axes.first + 3, "cell");
  Matrix4d matrix;
  for (int axis = 0; axis < 3; ++axis) {
    const bool node = centers[axes.first + static_cast<std::size_t>(axis)] == "node";
    const double steps = axes.counts[axis] - (node ? 1 : 0);
    double step = 1;
    if (spacings) {
      step = (*spacings)[axis];
    } else if (low && high && steps > 0) {
      step = ((*high)[axis] - (*low)[axis]) / steps;
    }
    matrix[axis][axis] = step;
    if (low) matrix[3][axis] = (*low)[axis] + (node ? 0 : step / 2);
  }
  return matrix;
}

/// "m", "km" or "mm" where all axes have that unit.
std::string nrrd_length_unit(const NrrdHeader& header, const NrrdAxes& axes) {
  const bool of_space = header.find({"space directions"}).has_value();
  const auto text = of_space ? header.find({"space units"}) : header.find({"units"});
  if (!text) return {};
  std::vector<std::string> units = split_words(*text, "\"");
  if (!of_space && units.size() > 3) units.erase(units.begin(), units.begin() + axes.first);
  const bool alike = units.size() == 3 && units[0] == units[1] && units[0] == units[2];
  return alike ? units[0] : "";
}

/// The file that holds the values.
std::shared_ptr<const VolumeFile> nrrd_data_file(const NrrdHeader& header) {
  const auto name = header.find({"data file", "datafile"});
  if (!name) return nullptr;
  if (name->starts_with("LIST") || name->find('%') != name->npos) {
    fail("{}: its values stand in several files; write them as one (teem: unu save)",
         header.file().name());
  }
  return beside(header.file(), *name);
}

/// Where the values begin, lines and bytes being skipped as the header says.
/// @param bytes of all values
uint64_t nrrd_begin(const NrrdHeader& header, const VolumeFile& data, uint64_t begin, bool raw,
                    uint64_t bytes) {
  const double lines = header.whole({"line skip", "lineskip"}, 0);
  const double skipped = header.whole({"byte skip", "byteskip"}, -1);
  if (skipped < 0) {
    if (!raw || bytes > data.size()) data.fail_damaged("a byte skip of -1 before too few values");
    return data.size() - bytes;
  }
  TextCursor cursor(data, begin);
  for (double line = 0; line < lines && !cursor.at_end(); ++line) cursor.line();
  if (raw) cursor.skip(static_cast<uint64_t>(skipped));
  return cursor.offset();
}

}  // namespace

VolumeReaderPointer open_nrrd(const VolumeFile& file) {
  const NrrdHeader header(file);
  const NrrdAxes axes = nrrd_axes(header);
  const std::string type_name = lower_case(header.get({"type"}));
  const std::optional<NumberType> type = nrrd_number_type(type_name);
  const std::string encoding = lower_case(header.get({"encoding"}));
  const bool raw = encoding == "raw", packed = encoding == "gzip" || encoding == "gz";
  if (!raw && !packed && encoding != "ascii" && encoding != "text" && encoding != "txt") {
    fail("{}: its encoding '{}' is not known; write it raw, gzip or ascii", file.name(),
         excerpt(encoding));
  }
  DenseGrid grid;
  grid.counts = axes.counts;
  grid.info.name = header.find({"content"}).value_or("density");
  grid.info.grid_class = "samples";
  set_voxel_type(type, excerpt(type_name), axes.components, grid);
  if (!grid.info.reason.empty()) fail("{}: {}", file.name(), grid.info.reason);
  const auto directions = header.find({"space directions"});
  grid.info.index_to_world =
      directions ? nrrd_space(header, axes, *directions) : nrrd_steps(header, axes);
  grid.info.length_unit = nrrd_length_unit(header, axes);
  StoredNumbers numbers{*type, std::endian::little};
  if ((raw || packed) && size_of(*type) > 1) {
    const std::string order = lower_case(header.get({"endian"}));
    if (order != "little" && order != "big") {
      fail("{}: its endian '{}' is neither little nor big; correct it", file.name(),
           excerpt(order));
    }
    if (order == "big") numbers.order = std::endian::big;
  }
  const auto detached = nrrd_data_file(header);
  const VolumeFile& data = detached ? *detached : file;
  const std::size_t voxel_bytes = size_of(*type) * static_cast<std::size_t>(axes.components);
  const DensePacking packing = raw      ? DensePacking::kNone
                               : packed ? DensePacking::kDeflate
                                        : DensePacking::kText;
  check_dense_size(data, grid.counts, voxel_bytes, packing);
  const uint64_t bytes = dense_bytes(grid.counts, voxel_bytes);
  const uint64_t begin = nrrd_begin(header, data, detached ? 0 : header.end(), raw, bytes);
  if (raw) data.require(begin, bytes);
  grid.info.stored_bytes = raw ? bytes : data.size() - begin;
  grid.open = [&data, detached, begin, packing, numbers](const GridInfo& /*head*/) {
    return file_planes(data, begin, packing, numbers);
  };
  return make_dense_reader(file, std::move(grid));
}

}  // namespace freepath::io
