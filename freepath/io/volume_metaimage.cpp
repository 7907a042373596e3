// Reads MetaImage files: a header (.mhd) with its values in another file, or both in one (.mha).

#include <algorithm>
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

std::optional<NumberType> meta_number_type(const std::string& name) {
  static const std::map<std::string, NumberType> kTypes{
      {"MET_CHAR", NumberType::kInt8},       {"MET_UCHAR", NumberType::kUint8},
      {"MET_SHORT", NumberType::kInt16},     {"MET_USHORT", NumberType::kUint16},
      {"MET_INT", NumberType::kInt32},       {"MET_UINT", NumberType::kUint32},
      {"MET_LONG_LONG", NumberType::kInt64}, {"MET_ULONG_LONG", NumberType::kUint64},
      {"MET_FLOAT", NumberType::kFloat},     {"MET_DOUBLE", NumberType::kDouble}};
  const auto found = kTypes.find(name);
  if (found == kTypes.end()) return std::nullopt;
  return found->second;
}

/// "Key = value" of a line; an empty key if it is none.
std::pair<std::string, std::string> meta_field(std::string_view line) {
  const std::size_t equals = line.find('=');
  if (equals == line.npos) return {};
  return {std::string(trimmed(line.substr(0, equals))),
          std::string(trimmed(line.substr(equals + 1)))};
}

/// The fields of a header, which ends with the name of the values' file.
class MetaHeader : public HeaderFields {
 public:
  explicit MetaHeader(const VolumeFile& file) : HeaderFields(file) {
    TextCursor cursor(file, 0);
    while (fields_.count("ElementDataFile") == 0) {
      if (cursor.at_end()) fail("{}: its header has no ElementDataFile; add it", file.name());
      const std::string line = cursor.line();
      if (trimmed(line).empty()) continue;
      auto [key, value] = meta_field(line);
      if (key.empty()) {
        file.fail_damaged(fmt::format("'{}' is no field of a header", excerpt(line)));
      }
      fields_.insert_or_assign(std::move(key), std::move(value));
    }
    end_ = cursor.offset();
  }

  bool flag(std::initializer_list<const char*> names) const {
    const std::string value = lower_case(find(names).value_or("false"));
    if (value == "true" || value == "1") return true;
    if (value == "false" || value == "0") return false;
    fail("{}: {} is neither True nor False, but '{}'; correct it", file_.name(), *names.begin(),
         excerpt(value));
  }

  std::vector<double> numbers(std::initializer_list<const char*> names, std::size_t count,
                              const std::string& otherwise) const {
    return header_numbers(file_, *names.begin(), find(names).value_or(otherwise), count);
  }
};

/// Rows of TransformMatrix are the directions of the axes; the first sample's centre is the offset.
Matrix4d meta_transform(const MetaHeader& header) {
  const auto spacing = header.numbers({"ElementSpacing", "ElementSize"}, 3, "1 1 1");
  const auto offset = header.numbers({"Offset", "Origin", "Position"}, 3, "0 0 0");
  const auto axes =
      header.numbers({"TransformMatrix", "Rotation", "Orientation"}, 9, "1 0 0 0 1 0 0 0 1");
  Matrix4d matrix;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    for (int k = 0; k < 3; ++k) {
      matrix[axis][k] = spacing[i] * axes[3 * i + static_cast<std::size_t>(k)];
    }
    matrix[3][axis] = offset[i];
  }
  return matrix;
}

/// The file that holds the values; null if it is the header's.
std::shared_ptr<const VolumeFile> meta_data_file(const MetaHeader& header) {
  const std::string name = header.get({"ElementDataFile"});
  if (name == "LOCAL") return nullptr;
  if (name.starts_with("LIST") || name.find('%') != name.npos) {
    fail("{}: its values stand in several files; write them as one (ITK: itk::ImageFileWriter)",
         header.file().name());
  }
  return beside(header.file(), name);
}

int meta_components(const MetaHeader& header) {
  const double channels = header.numbers({"ElementNumberOfChannels"}, 1, "1")[0];
  if (channels != 1 && channels != 3) {
    fail("{}: its voxels have {} numbers; 1 or 3 can be densities", header.file().name(), channels);
  }
  return static_cast<int>(channels);
}

/// Where the values begin, in the file that holds them; HeaderSize -1: at its end.
uint64_t meta_begin(const MetaHeader& header, const VolumeFile& data, uint64_t begin, bool packed,
                    uint64_t bytes) {
  const double size = header.numbers({"HeaderSize"}, 1, "0")[0];
  constexpr double kMost = 1e15;
  if (size < -1 || size > kMost || size != std::floor(size) || (size < 0 && packed)) {
    fail("{}: HeaderSize is {}; correct it", header.file().name(), size);
  }
  if (size >= 0) return begin + static_cast<uint64_t>(size);
  if (bytes > data.size()) data.fail_damaged("too few values for a HeaderSize of -1");
  return data.size() - bytes;
}

}  // namespace

bool is_metaimage(const VolumeFile& file) {
  std::string head(std::min<uint64_t>(file.size(), 256), '\0');
  file.read(0, std::as_writable_bytes(std::span(head)));
  const std::string key = meta_field(head.substr(0, head.find('\n'))).first;
  for (const char* const known : {"ObjectType", "ObjectSubType", "NDims", "Comment", "Name", "ID",
                                  "BinaryData", "TransformType", "DimSize"}) {
    if (key == known) return true;
  }
  return false;
}

VolumeReaderPointer open_metaimage(const VolumeFile& file) {
  const MetaHeader header(file);
  if (header.numbers({"NDims"}, 1, header.get({"NDims"}))[0] != 3) {
    fail("{}: NDims is {}; images of 3 dimensions can be read", file.name(),
         excerpt(header.get({"NDims"})));
  }
  DenseGrid grid;
  const auto sizes = header.numbers({"DimSize"}, 3, header.get({"DimSize"}));
  grid.counts = checked_counts(file, "DimSize with", sizes);
  const std::string type_name = header.get({"ElementType"});
  const std::optional<NumberType> type = meta_number_type(type_name);
  const int components = meta_components(header);
  grid.info.name = header.find({"Name"}).value_or("density");
  grid.info.grid_class = "samples";
  set_voxel_type(type, excerpt(type_name), components, grid);
  if (!grid.info.reason.empty()) fail("{}: {}", file.name(), grid.info.reason);
  grid.info.index_to_world = meta_transform(header);
  const bool binary = header.flag({"BinaryData"}), packed = header.flag({"CompressedData"});
  StoredNumbers numbers{*type, std::endian::little};
  if (header.flag({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"})) {
    numbers.order = std::endian::big;
  }
  const auto detached = meta_data_file(header);
  const VolumeFile& data = detached ? *detached : file;
  const std::size_t voxel_bytes = size_of(*type) * static_cast<std::size_t>(components);
  const DensePacking packing = !binary  ? DensePacking::kText
                               : packed ? DensePacking::kDeflate
                                        : DensePacking::kNone;
  check_dense_size(data, grid.counts, voxel_bytes, packing);
  const uint64_t bytes = dense_bytes(grid.counts, voxel_bytes);
  const uint64_t begin = meta_begin(header, data, detached ? 0 : header.end(), packed, bytes);
  data.require(begin, binary && !packed ? bytes : 0);
  grid.info.stored_bytes = binary && !packed ? bytes : data.size() - begin;
  grid.open = [&data, detached, begin, packing, numbers](const GridInfo& /*head*/) {
    return file_planes(data, begin, packing, numbers);
  };
  return make_dense_reader(file, std::move(grid));
}

}  // namespace freepath::io
