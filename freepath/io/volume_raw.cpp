#include "freepath/io/volume_raw.h"

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/printable.h"
#include "freepath/io/volume_dense.h"

namespace freepath::io {
namespace {

NumberType raw_number_type(const VolumeFile& file, const std::string& name) {
  static const std::map<std::string, NumberType> kTypes{
      {"int8", NumberType::kInt8},     {"uint8", NumberType::kUint8},
      {"int16", NumberType::kInt16},   {"uint16", NumberType::kUint16},
      {"int32", NumberType::kInt32},   {"uint32", NumberType::kUint32},
      {"int64", NumberType::kInt64},   {"uint64", NumberType::kUint64},
      {"float32", NumberType::kFloat}, {"float64", NumberType::kDouble}};
  const auto found = kTypes.find(name);
  if (found != kTypes.end()) return found->second;
  std::string names;
  for (const auto& [known, type] : kTypes) names += (names.empty() ? "" : ", ") + known;
  fail("{}: '{}' is no type of raw values; choose among {}", file.name(), printable(name), names);
}

}  // namespace

VolumeReaderPointer open_raw(const VolumeFile& file, const RawLayout& layout) {
  const NumberType type = raw_number_type(file, layout.type);
  DenseGrid grid;
  grid.info.name = "density";
  grid.info.grid_class = "samples";
  const std::array<double, 3> sizes{static_cast<double>(layout.counts.x),
                                    static_cast<double>(layout.counts.y),
                                    static_cast<double>(layout.counts.z)};
  grid.counts = checked_counts(file, "a size with", sizes);
  set_voxel_type(type, "", 1, grid);
  for (int axis = 0; axis < 3; ++axis) {
    grid.info.index_to_world[axis][axis] = layout.spacing[axis];
    grid.info.index_to_world[3][axis] = layout.origin[axis];
  }
  check_dense_size(file, grid.counts, size_of(type), DensePacking::kNone);
  const uint64_t bytes = dense_bytes(grid.counts, size_of(type));
  // Nothing else tells that size and type are those of the file.
  if (layout.offset > file.size() || file.size() - layout.offset != bytes) {
    fail(
        "{}: the file has {} bytes, where {} x {} x {} values of type {} behind {} bytes make {}; "
        "correct the size, type or offset",
        file.name(), file.size(), layout.counts.x, layout.counts.y, layout.counts.z, layout.type,
        layout.offset, bytes + layout.offset);
  }
  grid.info.stored_bytes = bytes;
  grid.open = [&file, offset = layout.offset,
               numbers = StoredNumbers{type, layout.order}](const GridInfo& /*head*/) {
    return number_planes(file_bytes(file, offset), numbers);
  };
  return make_dense_reader(file, std::move(grid));
}

std::filesystem::path raw_header_beside(const std::filesystem::path& path) {
  if (path.extension() != ".raw") return {};
  for (const char* const extension : {".nhdr", ".mhd"}) {
    std::filesystem::path longer = path.string() + extension;
    std::filesystem::path other = path;
    other.replace_extension(extension);
    std::error_code ignored;
    if (std::filesystem::is_regular_file(longer, ignored)) return longer;
    if (std::filesystem::is_regular_file(other, ignored)) return other;
  }
  return {};
}

}  // namespace freepath::io
